import type { Group, Session } from "racebeam";
import { Screen } from "../picture/screen.js";

const WIDTH = 160;
const PAL_HEIGHT = 240; // pictures from this height on are those of PAL

/** The newest pictures of a shared session on a canvas. While the server answers, further wishes are left out. */
export class Feed {
  readonly name: string;
  readonly #session: Session;
  readonly #screen: Screen;
  #frame: number | undefined;
  #height = 0;
  #asking = false;

  constructor(session: Session, name: string, canvas: HTMLCanvasElement) {
    this.#session = session;
    this.name = name;
    this.#screen = new Screen(canvas);
  }

  /** Shows the newest picture. Returns what the server says of it, or undefined if nothing is new. */
  async poll(): Promise<Group | undefined> {
    if (this.#asking) {
      return undefined;
    }
    this.#asking = true;
    try {
      const group = await this.#session.watch(this.name, this.#frame === undefined ? {} : { since: this.#frame }, "screen:rle");
      if (!group.screen) {
        return undefined;
      }
      await this.#shape(group.screen.length / WIDTH);
      this.#screen.draw(group.screen);
      this.#frame = group.frame;
      return group;
    } finally {
      this.#asking = false;
    }
  }

  /** Takes the colours and the shape of the game's pictures, when they are known or have changed. */
  async #shape(height: number): Promise<void> {
    if (height !== this.#height) {
      this.#height = height;
      const bytes: Uint8Array = (await this.#session.watch(this.name, {}, "palette:raw")).palette;
      const colours = Uint32Array.from({ length: 256 }, (_, value) =>
        (0xff000000 | (bytes[3 * value + 2]! << 16) | (bytes[3 * value + 1]! << 8) | bytes[3 * value]!) >>> 0);
      this.#screen.become(colours, height < PAL_HEIGHT ? "ntsc" : "pal", height);
    }
  }
}
