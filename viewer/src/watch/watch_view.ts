import { RefusedError, type Group, type Session } from "racebeam";
import { byId, copyOf, make, markCurrent, part, tell } from "../page/elements.js";
import { reasonOf, type Server } from "../page/server.js";
import { titleOf } from "../page/titles.js";
import { Feed } from "./feed.js";

const LIST_EVERY = 1000; // milliseconds
const THUMBNAILS_EVERY = 200;

interface Tile {
  element: HTMLElement;
  button: HTMLButtonElement;
  feed: Feed;
  /** Its name, and its game. */
  title: string;
}

/** The view of sessions that their clients have shared: a wall of small pictures, and a large one. */
export class WatchView {
  /** Called with a sentence about the connection; an empty one if all is well. */
  onStatus: (sentence: string) => void = () => {};

  readonly #server: Server;
  readonly #tiles = new Map<string, Tile>();
  #session: Session | undefined;
  #large: Feed | undefined;
  #active = false;
  #listTime = 0; // of the last list, by requestAnimationFrame
  #drawTime = 0; // of the last thumbnails

  constructor(server: Server) {
    this.#server = server;
  }

  /** The view is shown or hidden. Hidden, it asks the server for nothing. */
  set active(active: boolean) {
    const begins = active && !this.#active;
    this.#active = active;
    if (begins) {
      void this.#run();
    }
  }

  /** Follows the shared sessions while the view is shown, in session after session. */
  async #run(): Promise<void> {
    while (this.#active) {
      try {
        this.#session ??= (await this.#server.reopen(() => this.onStatus("The server does not answer. Trying again."))).session;
        this.onStatus("");
        await this.#follow(this.#session);
      } catch (error) {
        this.#forget();
        if (error instanceof RefusedError) {
          this.onStatus(`The server refuses: ${reasonOf(error)}.`);
          return; // a server that has no sessions to share
        }
        this.#session = undefined;
        this.onStatus("The connection is lost. Trying again.");
      }
    }
  }

  async #follow(session: Session): Promise<void> {
    while (this.#active) {
      const now = await new Promise<number>(requestAnimationFrame);
      if (now - this.#listTime >= LIST_EVERY) {
        this.#listTime = now;
        this.#list(session, (await session.shared()).filter(({ name }) => !this.#server.owns(String(name))));
      }
      const thumbnails = now - this.#drawTime >= THUMBNAILS_EVERY;
      this.#drawTime = thumbnails ? now : this.#drawTime;
      const feeds = [...(this.#large ? [this.#large] : []), ...(thumbnails ? [...this.#tiles.values()].map(({ feed }) => feed) : [])];
      await Promise.all(feeds.map((feed) => this.#poll(feed)));
    }
  }

  async #poll(feed: Feed): Promise<void> {
    try {
      const group = await feed.poll();
      if (group && feed === this.#large) {
        this.#describe(group);
      }
    } catch (error) {
      if (!(error instanceof RefusedError)) {
        throw error;
      }
      this.#remove(feed.name); // it is shared no more
    }
  }

  /** Shows a tile for each session that is shared now. */
  #list(session: Session, shared: readonly Group[]): void {
    const names = new Set(shared.map((group) => String(group.name)));
    [...this.#tiles.keys()].filter((name) => !names.has(name)).forEach((name) => this.#remove(name));
    for (const group of shared) {
      const tile = this.#tiles.get(String(group.name)) ?? this.#add(session, String(group.name));
      tile.title = `${group.name}: ${titleOf(String(group.game))}`;
      tell(part(tile.button, "facts", HTMLElement), facts(group));
      if (this.#large?.name === group.name) {
        tell(byId("watched-title", HTMLElement), tile.title);
      }
    }
    byId("watch-none", HTMLElement).hidden = shared.length > 0;
    const [first] = this.#tiles.values();
    if (!this.#large && first) {
      this.#enlarge(session, first.feed.name);
    }
  }

  #add(session: Session, name: string): Tile {
    const element = copyOf("tile");
    const button = element.querySelector("button")!;
    tell(part(button, "name", HTMLElement), name);
    const tile = { element, button, feed: new Feed(session, name, part(button, "screen", HTMLCanvasElement)), title: name };
    button.onclick = () => {
      this.#enlarge(session, name);
      byId("watched", HTMLElement).scrollIntoView({ block: "nearest" });
    };
    byId("wall", HTMLElement).append(element);
    this.#tiles.set(name, tile);
    return tile;
  }

  #remove(name: string): void {
    this.#tiles.get(name)?.element.remove();
    this.#tiles.delete(name);
    if (this.#large?.name === name) {
      this.#large = undefined;
      byId("watched", HTMLElement).hidden = true;
    }
  }

  #forget(): void {
    [...this.#tiles.keys()].forEach((name) => this.#remove(name));
  }

  #enlarge(session: Session, name: string): void {
    this.#large = new Feed(session, name, byId("watched-screen", HTMLCanvasElement));
    byId("watched", HTMLElement).hidden = false;
    tell(byId("watched-title", HTMLElement), this.#tiles.get(name)?.title ?? name);
    byId("watched-screen", HTMLCanvasElement).setAttribute("aria-label", `Screen of ${name}`);
    this.#tiles.forEach(({ button }, each) => markCurrent(button, each === name));
  }

  #describe(group: Group): void {
    const shown = ["score", "lives", "reward", "action", "frame"].filter((key) => key in group);
    byId("watched-facts", HTMLElement).replaceChildren(...shown.map((key) =>
      make("div", {}, make("dt", { textContent: key }), make("dd", { textContent: String(group[key]) }))));
  }
}

/** What is known of a shared session, for people. */
function facts({ game, score, episode, fps }: Group): string {
  return `${titleOf(String(game))} · score ${score} · episode ${episode} · ${Math.round(Number(fps))} frames/s`;
}
