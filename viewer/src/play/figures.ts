import { tell } from "../page/elements.js";
import type { Speaker } from "../sound/speaker.js";
import type { Player } from "./player.js";

const EVERY = 500; // milliseconds

/** The line for developers: how fast the page is. */
export class Figures {
  readonly #element: HTMLElement;
  #since = 0;
  #ticks = 0;
  #pictures = 0;

  constructor(element: HTMLElement) {
    this.#element = element;
  }

  /** The display draws; `drawn`: a picture has come. */
  tick(now: number, player: Player, speaker: Speaker, drawn: boolean): void {
    ++this.#ticks;
    this.#pictures += Number(drawn);
    if (now - this.#since < EVERY) {
      return;
    }
    const seconds = (now - this.#since) / 1000;
    const display = this.#ticks / seconds;
    const latency = player.latency.figures;
    tell(this.#element, [
      `display ${Math.round(display)} Hz`,
      `${Math.round(this.#pictures / seconds)} pictures/s`,
      latency ? `key to picture ${latency.median.toFixed(1)} ms (${(latency.median * display / 1000).toFixed(1)} frames), at most `
        + `${latency.worst.toFixed(1)} ms` : "key to picture: press one",
      `sound ${speaker.state}, ${speaker.gaps} gaps`,
    ].join(" · "));
    this.#since = now;
    this.#ticks = 0;
    this.#pictures = 0;
  }
}
