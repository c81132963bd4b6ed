import { byId, make, offer, tell } from "../page/elements.js";
import { gameFile, outcome, type Findings } from "./draft.js";
import { addressOf, byteOf, MemorySearch, type Comparison } from "./search.js";

const MOST_LISTED = 12;
const ROLES = [["", "-"], ["score0", "score, low digits"], ["score1", "score, next digits"], ["score2", "score, high digits"],
  ["lives", "lives"], ["over", "over at this value"]] as const;
const NOTHING = "No byte has a part in the rule yet. Say in the list which byte is which.";

/** A byte's part in the rule, and its value when the user said so. */
interface Part {
  role: string;
  value: number;
}

/** The part of the page that searches memory, and saves what was found as a draft of a game file. */
export class SearchPanel {
  /** Called with the bytes that fit, whenever they change. */
  changed: (candidates: readonly number[]) => void = () => {};
  /** What of a game file the search does not find. */
  about: () => Pick<Findings, "title" | "md5" | "minimal"> = () => ({ title: "", md5: "", minimal: [0] });

  readonly #search = new MemorySearch();
  readonly #parts = new Map<number, Part>();
  readonly #values = new Map<number, HTMLElement>(); // the cells of the bytes that are listed
  #ram = new Uint8Array(128);
  #first: Uint8Array | undefined; // RAM when the game began

  constructor() {
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-compare]")) {
      button.onclick = () => this.#narrow(button.dataset.compare as Comparison);
    }
    byId("search-value", HTMLFormElement).onsubmit = (event) => {
      event.preventDefault();
      const value = byteOf(byId("value", HTMLInputElement).value);
      tell(byId("value-problem", HTMLElement), value === undefined ? "A byte is a number from 0 to 255, or $00 to $FF." : "");
      if (value !== undefined) {
        this.#narrow("equal", value);
      }
    };
    byId("search-undo", HTMLButtonElement).onclick = () => {
      this.#search.undo();
      this.#list();
    };
    byId("search-new", HTMLButtonElement).onclick = () => this.#anew();
    byId("coding", HTMLSelectElement).onchange = () => this.#preview();
    byId("draft", HTMLButtonElement).onclick = () => this.#save();
  }

  /** A game begins: forgets what was found in the one before. */
  begin(): void {
    this.#first = undefined;
    this.#parts.clear();
    this.show(this.#ram);
    this.#list();
  }

  /** Begins another search. The bytes that have a part in the rule keep it. */
  #anew(): void {
    this.#search.begin(this.#ram);
    this.#list();
  }

  /** Takes RAM as it is now, and shows the values of the bytes that are listed. */
  show(ram: Uint8Array): void {
    this.#ram = new Uint8Array(ram);
    if (!this.#first) {
      this.#first = this.#ram;
      this.#search.begin(this.#ram);
    }
    this.#values.forEach((cell, index) => tell(cell, this.#value(index)));
    this.#preview();
  }

  /** The text of the game file. */
  draft(): string {
    return gameFile({ ...this.about(), ...this.#findings() });
  }

  #findings(): Pick<Findings, "score" | "coding" | "lives" | "livesAtStart" | "over"> {
    const index = (role: string) => [...this.#parts].find(([, part]) => part.role === role)?.[0];
    const score = ["score0", "score1", "score2"].map(index).filter((each) => each !== undefined);
    const [lives, over] = [index("lives"), index("over")];
    return {
      score,
      coding: byId("coding", HTMLSelectElement).value === "binary" ? "binary" : "bcd",
      ...(lives === undefined ? {} : { lives, livesAtStart: this.#first?.[lives] ?? 0 }),
      ...(over === undefined ? {} : { over: { index: over, value: this.#parts.get(over)!.value } }),
    };
  }

  #narrow(comparison: Comparison, value?: number): void {
    this.#search.narrow(comparison, this.#ram, value);
    this.#list();
  }

  #list(): void {
    const { candidates, depth } = this.#search;
    const listed = [...new Set([...this.#parts.keys(), ...this.#neighbours(), ...(depth ? candidates : [])])].slice(0, MOST_LISTED);
    const none = "No byte did all of that. Undo takes the last step back.";
    const some = `${candidates.length} of 128 bytes fit${candidates.length > MOST_LISTED ? `; the list has ${MOST_LISTED} of them` : ""}.`;
    tell(byId("found", HTMLElement), !depth ? "" : candidates.length ? some : none);
    this.#values.clear();
    byId("listed", HTMLTableElement).hidden = listed.length === 0;
    byId("candidates", HTMLTableSectionElement).replaceChildren(...listed.map((index) => this.#row(index)));
    this.#preview();
    this.changed(depth ? candidates : []);
  }

  /** The bytes beside those of the score, where its other digits may be. */
  #neighbours(): number[] {
    const score = [...this.#parts].filter(([, { role }]) => role.startsWith("score"));
    return score.flatMap(([index]) => [index - 1, index + 1]).filter((index) => index >= 0 && index < this.#ram.length);
  }

  #row(index: number): HTMLTableRowElement {
    const role = make("select", { onchange: () => this.#assign(index, role.value) });
    role.setAttribute("aria-label", `Part of the rule of ${addressOf(index)}`);
    offer(role, ROLES, this.#parts.get(index)?.role ?? "");
    const value = make("td", { textContent: this.#value(index) });
    this.#values.set(index, value);
    return make("tr", {}, make("td", { textContent: addressOf(index) }), value, make("td", {}, role));
  }

  #value(index: number): string {
    const value = this.#ram[index] ?? 0;
    return `$${value.toString(16).toUpperCase().padStart(2, "0")} = ${value}`;
  }

  #assign(index: number, role: string): void {
    if (role) {
      this.#parts.set(index, { role, value: this.#ram[index] ?? 0 });
    } else {
      this.#parts.delete(index);
    }
    tell(byId("draft-problem", HTMLElement), "");
    this.#list();
    byId("candidates", HTMLTableSectionElement).querySelector<HTMLElement>(`[aria-label$=" ${addressOf(index)}"]`)?.focus();
  }

  /** Says what the draft's rule gives at this moment. */
  #preview(): void {
    const { score, lives, over } = outcome(this.#findings(), this.#ram);
    const parts = [
      ...(score === undefined ? [] : [`score ${score}`]),
      ...(lives === undefined ? [] : [`lives ${lives}`]),
      ...(over === undefined ? [] : [over ? "the game is over" : "the game goes on"]),
    ];
    tell(byId("preview", HTMLElement), parts.length ? `The draft's rule gives now: ${parts.join(", ")}.` : NOTHING);
  }

  #save(): void {
    const problem = byId("draft-problem", HTMLElement);
    tell(problem, this.#parts.size ? "" : `There is nothing to save. ${NOTHING}`);
    if (this.#parts.size) {
      const address = URL.createObjectURL(new Blob([this.draft()], { type: "application/toml" }));
      make("a", { href: address, download: `${this.about().title || "game"}.toml` }).click();
      setTimeout(() => URL.revokeObjectURL(address), 1000);
    }
  }
}
