import { byId, tell } from "../page/elements.js";
import { reasonOf, type Server } from "../page/server.js";
import { Pacer } from "../play/pacer.js";
import { Speaker } from "../sound/speaker.js";
import { Deck } from "./deck.js";
import { linkTo, readLink } from "./link.js";
import { readLog, type Episode } from "./log.js";
import { drawMarks } from "./marks.js";

const MOST_DECKS = 2;

/** The view in which recorded episodes are shown, one or two side by side. */
export class ReplayView {
  readonly #server: Server;
  readonly #drop = byId("drop", HTMLElement);
  readonly #timeline = byId("timeline", HTMLInputElement);
  readonly #speed = byId("speed", HTMLSelectElement);
  readonly #pacer = new Pacer(60);
  readonly #speaker = new Speaker();
  #decks: Deck[] = [];
  #frame = 0;
  #runs = false;
  #active = false;

  constructor(server: Server) {
    this.#server = server;
    this.#listen();
  }

  /** The view is shown or hidden. Hidden, it stops. */
  set active(active: boolean) {
    this.#active = active;
    this.#run(false);
    if (active) {
      requestAnimationFrame((now) => this.#tick(now));
      this.#drawMarks();
    }
  }

  /** Shows the episode of a link, if the address has one. */
  async follow(hash: string): Promise<void> {
    await this.#attempt("log-problem", async () => {
      const linked = await readLink(hash);
      if (linked) {
        this.#frame = linked.frame;
        await this.#add(linked.episode);
      }
    });
  }

  /** Shows an episode, beside the one before if there is one. */
  async open(episode: Episode): Promise<void> {
    await this.#attempt("log-problem", () => this.#add(episode));
  }

  async #add(episode: Episode): Promise<void> {
    if (this.#decks.length === MOST_DECKS) {
      throw new Error(`${MOST_DECKS} episodes are open; close one first`);
    }
    const deck = new Deck(this.#server, episode);
    this.#decks.push(deck);
    deck.onClose = () => this.#close(deck);
    deck.onSound = (samples) => this.#runs && deck === this.#decks[0] && this.#speed.value === "1" && this.#speaker.play(samples);
    byId("decks", HTMLElement).append(deck.element);
    try {
      await deck.open();
    } catch (error) {
      this.#close(deck);
      throw error;
    }
    this.#speaker.rate = deck.soundRate;
    byId("transport", HTMLElement).hidden = false;
    this.#offerFilm(deck.records);
    this.#changed();
  }

  #close(deck: Deck): void {
    this.#decks = this.#decks.filter((each) => each !== deck);
    void deck.close();
    this.#frame = this.#decks.length ? this.#frame : 0;
    byId("transport", HTMLElement).hidden = this.#decks.length === 0;
    this.#changed();
  }

  #listen(): void {
    const click = (id: string, action: () => void) => byId(id, HTMLButtonElement).addEventListener("click", action);
    const files = byId("log", HTMLInputElement);
    files.onchange = () => void this.#read(files.files);
    for (const type of ["dragenter", "dragover", "dragleave", "drop"] as const) {
      this.#drop.addEventListener(type, (event) => {
        event.preventDefault();
        this.#drop.classList.toggle("over", type === "dragenter" || type === "dragover");
      });
    }
    this.#drop.addEventListener("drop", ({ dataTransfer }) => void this.#read(dataTransfer?.files));
    this.#timeline.oninput = () => this.#goTo(this.#timeline.valueAsNumber);
    click("run", () => this.#run(!this.#runs));
    click("run-back", () => this.#goTo(this.#frame - 1));
    click("run-step", () => this.#goTo(this.#frame + 1));
    click("reward-before", () => this.#goTo(this.#rewards().findLast((frame) => frame < this.#frame) ?? 0));
    click("reward-after", () => this.#goTo(this.#rewards().find((frame) => frame > this.#frame) ?? this.#frames));
    click("film", () => void this.#attempt("transport-problem", () => this.#film()));
    click("link", () => void this.#attempt("transport-problem", () => this.#link()));
    this.#speed.onchange = () => this.#run(this.#runs);
    addEventListener("resize", () => this.#drawMarks());
  }

  async #read(files: FileList | null | undefined): Promise<void> {
    for (const file of files ?? []) {
      await this.#attempt("log-problem", async () => this.#add(await readLog(new Uint8Array(await file.arrayBuffer()), file.name)), `${file.name}: `);
    }
    byId("log", HTMLInputElement).value = "";
  }

  /** Does something, and shows why it failed, in an element, after the name of the file that it is about. */
  async #attempt(place: string, action: () => Promise<void>, name = ""): Promise<void> {
    const problem = byId(place, HTMLElement);
    tell(problem, "");
    try {
      await action();
    } catch (error) {
      tell(problem, `${name}${reasonOf(error)}.`);
    }
  }

  get #frames(): number {
    return this.#decks.reduce((most, deck) => Math.max(most, deck.frames), 0);
  }

  /** The frames with rewards of all episodes, in order. */
  #rewards(): number[] {
    return this.#decks.flatMap((deck) => deck.rewards.map(({ frame }) => frame)).sort((a, b) => a - b);
  }

  /** The episodes have changed. */
  #changed(): void {
    this.#drop.classList.toggle("small", this.#decks.length > 0);
    this.#timeline.max = String(this.#frames);
    this.#goTo(this.#frame);
    this.#drawMarks();
  }

  #goTo(frame: number): void {
    this.#frame = Math.max(0, Math.min(this.#frames || frame, frame));
    this.#timeline.value = String(this.#frame);
    const place = `frame ${this.#frame} of ${this.#frames}`;
    this.#timeline.setAttribute("aria-valuetext", place);
    tell(byId("place", HTMLElement), place);
    this.#decks.forEach((deck) => deck.show(this.#frame));
  }

  #run(runs: boolean): void {
    if (runs && this.#frame >= this.#frames) {
      this.#goTo(0);
    }
    this.#runs = runs;
    tell(byId("run", HTMLButtonElement), runs ? "Pause" : "Play");
    this.#pacer.restart((this.#decks[0]?.frameRate ?? 60) * Number(this.#speed.value));
    if (runs) {
      void this.#speaker.start();
    }
  }

  #tick(now: number): void {
    if (!this.#active) {
      return;
    }
    requestAnimationFrame((next) => this.#tick(next));
    const due = this.#pacer.due(now);
    if (this.#runs && due > 0) {
      this.#goTo(this.#frame + due);
      if (this.#frame >= this.#frames) {
        this.#run(false);
      }
    }
  }

  #drawMarks(): void {
    drawMarks(byId("marks", HTMLCanvasElement), this.#decks.map((deck) => deck.rewards), Math.max(1, this.#frames));
  }

  #offerFilm(possible: boolean): void {
    byId("film", HTMLButtonElement).disabled = byId("film-kind", HTMLSelectElement).disabled = !possible;
    tell(byId("link-status", HTMLElement), possible ? "" : "This server makes no films: it was started without --record-dir.");
  }

  /** Makes a film of the first episode. */
  async #film(): Promise<void> {
    const button = byId("film", HTMLButtonElement);
    const note = byId("link-status", HTMLElement);
    button.disabled = true;
    tell(note, "The server makes the film.");
    let made = "";
    try {
      made = await this.#decks[0]?.film(byId("film-kind", HTMLSelectElement).value) ?? "";
    } finally {
      button.disabled = false;
      tell(note, made && `In the server's folder of recordings: ${made}.`);
    }
  }

  async #link(): Promise<void> {
    const [deck] = this.#decks;
    if (deck) {
      history.replaceState(null, "", `#${await linkTo(deck.episode, this.#frame)}`);
      const copied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
      tell(byId("link-status", HTMLElement), copied ? "The link is in the clipboard." : "The link is in the address bar.");
    }
  }
}
