import { describeAct } from "../input/actions.js";
import { byId, tell } from "../page/elements.js";
import type { Shown } from "../play/player.js";
import { AgentView } from "./agent_view.js";
import { PaletteView } from "./palette.js";
import { plot } from "./plot.js";
import { RamGrid } from "./ram_grid.js";
import { SearchPanel } from "./search_panel.js";
import { TiaView } from "./tia_view.js";

const KEPT = 1800; // moments of the plots
const PLOT_EVERY = 66; // milliseconds

/** What the panels below the game show of the session. */
export class Inspector {
  readonly search = new SearchPanel();
  readonly #element = byId("inspector", HTMLElement);
  readonly #ram = new RamGrid(byId("ram", HTMLTableElement), byId("ram-names", HTMLElement));
  readonly #tia = new TiaView(byId("tia", HTMLElement));
  readonly #agent = new AgentView(byId("agent", HTMLElement));
  readonly #palette = new PaletteView(byId("palette", HTMLCanvasElement), byId("used", HTMLElement));
  readonly #plots = {
    score: byId("score-plot", HTMLCanvasElement),
    reward: byId("reward-plot", HTMLCanvasElement),
    lives: byId("lives-plot", HTMLCanvasElement),
  };
  #last: Shown | undefined;
  #plotting = false;
  #moments: Pick<Shown, "moment" | "score" | "reward" | "lives">[] = [];

  constructor() {
    this.search.changed = (candidates) => this.#ram.mark(candidates);
  }

  get open(): boolean {
    return !this.#element.hidden;
  }

  set open(open: boolean) {
    this.#element.hidden = !open;
  }

  /** A game was loaded, or an episode begins. */
  begin(colours: Uint32Array, names: { ram: ReadonlyMap<number, string>; tia: readonly string[] }): void {
    this.#ram.name(names.ram);
    this.#tia.begin(names.tia);
    this.#moments = [];
    this.#palette.become(colours);
    this.search.begin();
  }

  /** Notes a moment, whether or not it is drawn. */
  add(shown: Shown): void {
    const { moment, score, reward, lives } = shown;
    while (this.#moments.length && this.#moments.at(-1)!.moment >= moment) {
      this.#moments.pop(); // they were taken back
    }
    this.#moments.push({ moment, score, reward, lives });
    this.#moments.splice(0, this.#moments.length - KEPT);
    if (shown.agent) {
      this.#agent.add(shown.agent);
    }
  }

  draw(shown: Shown): void {
    this.search.show(shown.ram);
    if (!this.open) {
      return;
    }
    this.#ram.show(shown.ram);
    if (shown.tia) {
      this.#tia.show(shown.tia);
    }
    this.#agent.draw();
    this.#palette.show(shown.screen);
    tell(byId("action", HTMLElement), describeAct(shown.act));
    this.#last = shown;
    if (!this.#plotting) {
      this.#plotting = true;
      setTimeout(() => this.#plot(), PLOT_EVERY);
    }
  }

  /** Plots the newest moment: of several in a short time, only the last. */
  #plot(): void {
    this.#plotting = false;
    const shown = this.#last!;
    plot(byId("wave", HTMLCanvasElement), Array.from(shown.audio), [0, 255]);
    for (const kind of ["score", "reward", "lives"] as const) {
      plot(this.#plots[kind], this.#moments.map((each) => each[kind]), [0, 1]);
      tell(byId(`${kind}-now`, HTMLOutputElement), String(shown[kind]));
    }
  }
}
