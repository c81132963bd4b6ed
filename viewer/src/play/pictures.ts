import { RefusedError, type Session } from "racebeam";
import type { Server } from "../page/server.js";
import { Screen } from "../picture/screen.js";

const ACTS = ["FIRE*20", "NOOP*100"]; // frames that lead to the picture: past most title screens

interface Wish {
  name: string;
  canvas: HTMLCanvasElement;
}

/**
 * Small pictures of games. The server draws each once, when it comes into view, one after the other. They take a session of their
 * own, which ends with the last of them.
 */
export class Pictures {
  readonly #server: Server;
  readonly #wishes: Wish[] = [];
  readonly #games = new WeakMap<Element, string>();
  readonly #observer = new IntersectionObserver((entries) => this.#seen(entries), { rootMargin: "100px" });
  #draws = false;

  constructor(server: Server) {
    this.#server = server;
  }

  /** Draws a game's picture on a canvas once it is in view. */
  add(name: string, canvas: HTMLCanvasElement): void {
    this.#games.set(canvas, name);
    this.#observer.observe(canvas);
  }

  #seen(entries: readonly IntersectionObserverEntry[]): void {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) {
        this.#observer.unobserve(target);
        this.#wishes.push({ name: this.#games.get(target)!, canvas: target as HTMLCanvasElement });
      }
    }
    if (!this.#draws) {
      void this.#draw().catch(() => this.#wishes.splice(0)); // the list does without pictures
    }
  }

  async #draw(): Promise<void> {
    if (!this.#wishes.length) {
      return;
    }
    this.#draws = true;
    const { session } = await this.#server.open();
    try {
      for (let wish = this.#wishes.shift(); wish; wish = this.#wishes.shift()) {
        await this.#fulfil(session, wish);
      }
    } finally {
      this.#draws = false;
      await session.disconnect();
    }
  }

  async #fulfil(session: Session, { name, canvas }: Wish): Promise<void> {
    try {
      const { format, height } = await session.load(name, { seed: 1, sticky: 0 });
      await this.#server.claim(session, "pictures");
      await session.act(...ACTS);
      const { screen } = await session.look("screen:rle");
      const picture = new Screen(canvas);
      picture.become(await session.palette(), String(format), height);
      picture.draw(screen);
    } catch (error) {
      if (!(error instanceof RefusedError)) {
        throw error;
      }
    }
  }
}
