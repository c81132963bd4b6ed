import { byId, make, offer, tell } from "../page/elements.js";
import { gameFile, type Findings } from "./draft.js";
import { addressOf, byteOf, MemorySearch, type Comparison } from "./search.js";

const MOST_LISTED = 12;
const ROLES = [["", "-"], ["score0", "score, lowest digits"], ["score1", "score, next"], ["score2", "score, highest"], ["lives", "lives"],
  ["over", "game over at this value"]] as const;

/** The part of the page that searches memory, and saves what was found as a draft of a game file. */
export class SearchPanel {
  /** Called with the bytes that fit, whenever they change. */
  changed: (candidates: readonly number[]) => void = () => {};
  /** What of a game file the search does not find. */
  about: () => Pick<Findings, "title" | "md5" | "minimal"> = () => ({ title: "", md5: "", minimal: [0] });

  readonly #search = new MemorySearch();
  readonly #roles = new Map<number, string>();
  #ram = new Uint8Array(128);
  #first: Uint8Array | undefined; // RAM when the search began

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
    byId("search-new", HTMLButtonElement).onclick = () => this.begin();
    byId("draft", HTMLButtonElement).onclick = () => this.#save();
  }

  /** Begins a search with the next RAM that is shown. */
  begin(): void {
    this.#first = undefined;
    this.#roles.clear();
    this.show(this.#ram);
    this.#list();
  }

  show(ram: Uint8Array): void {
    this.#ram = new Uint8Array(ram);
    if (!this.#first) {
      this.#first = this.#ram;
      this.#search.begin(this.#ram);
    }
  }

  /** The text of the game file. */
  draft(): string {
    const index = (role: string) => [...this.#roles].find(([, each]) => each === role)?.[0];
    const score = ["score0", "score1", "score2"].map(index).filter((each) => each !== undefined);
    const [lives, over] = [index("lives"), index("over")];
    return gameFile({
      ...this.about(),
      score,
      coding: byId("coding", HTMLSelectElement).value === "binary" ? "binary" : "bcd",
      ...(lives === undefined ? {} : { lives, livesAtStart: this.#first?.[lives] ?? 0 }),
      ...(over === undefined ? {} : { over: { index: over, value: this.#ram[over] ?? 0 } }),
    });
  }

  #narrow(comparison: Comparison, value?: number): void {
    this.#search.narrow(comparison, this.#ram, value);
    this.#list();
  }

  #list(): void {
    const { candidates, depth } = this.#search;
    const listed = [...new Set([...this.#roles.keys(), ...(depth ? candidates : [])])].slice(0, MOST_LISTED);
    tell(byId("found", HTMLElement), depth ? `${candidates.length} of 128 bytes fit.` : "");
    byId("candidates", HTMLTableSectionElement).replaceChildren(...listed.map((index) => this.#row(index)));
    this.changed(depth ? candidates : []);
  }

  #row(index: number): HTMLTableRowElement {
    const role = make("select", { onchange: () => this.#roles.set(index, role.value) });
    role.setAttribute("aria-label", `Part of the rule of ${addressOf(index)}`);
    offer(role, ROLES, this.#roles.get(index) ?? "");
    const value = this.#ram[index] ?? 0;
    const shown = `$${value.toString(16).toUpperCase().padStart(2, "0")} = ${value}`;
    return make("tr", {}, make("td", { textContent: addressOf(index) }), make("td", { textContent: shown }), make("td", {}, role));
  }

  #save(): void {
    const address = URL.createObjectURL(new Blob([this.draft()], { type: "application/toml" }));
    make("a", { href: address, download: `${this.about().title || "game"}.toml` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }
}
