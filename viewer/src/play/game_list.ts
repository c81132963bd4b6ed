import { byId, copyOf, markCurrent, part, tell } from "../page/elements.js";
import { titleOf } from "../page/titles.js";
import type { Pictures } from "./pictures.js";

const FILTERED_FROM = 8; // games: a shorter list is seen whole

/** The games of the server: a small picture and a title each, and a filter. */
export class GameList {
  /** Called with the name of the game that the user has chosen. */
  onChoose: (name: string) => void = () => {};

  readonly #list = byId("game-list", HTMLUListElement);
  readonly #filter = byId("filter", HTMLInputElement);
  readonly #pictures: Pictures;
  readonly #items = new Map<string, { element: HTMLElement; button: HTMLButtonElement; words: string }>();

  constructor(pictures: Pictures) {
    this.#pictures = pictures;
    this.#filter.oninput = () => this.#narrow();
  }

  /** Offers games, in the order of their titles. */
  offer(names: readonly string[]): void {
    const titled = names.map((name) => ({ name, title: titleOf(name) })).sort((a, b) => a.title.localeCompare(b.title, "en"));
    this.#items.clear();
    this.#list.replaceChildren(...titled.map(({ name, title }) => this.#item(name, title)));
    this.#filter.hidden = names.length < FILTERED_FROM;
    this.#filter.placeholder = `Filter ${names.length} games`;
    this.#narrow();
  }

  /** Marks the game that is loaded, and brings it into view. */
  mark(name: string): void {
    for (const [each, { element, button }] of this.#items) {
      markCurrent(button, each === name);
      if (each === name && element.offsetParent) {
        this.#list.scrollTop = element.offsetTop - this.#list.offsetTop - this.#list.clientHeight / 3;
      }
    }
  }

  #item(name: string, title: string): HTMLElement {
    const element = copyOf("game");
    const button = element.querySelector("button")!;
    tell(part(element, "title", HTMLElement), title);
    button.onclick = () => this.onChoose(name);
    this.#pictures.add(name, part(element, "picture", HTMLCanvasElement));
    this.#items.set(name, { element, button, words: `${name} ${title}`.toLowerCase() });
    return element;
  }

  /** Hides the games that lack a word of the filter. */
  #narrow(): void {
    const parts = this.#filter.value.toLowerCase().split(/\s+/);
    let found = 0;
    for (const { element, words } of this.#items.values()) {
      element.hidden = !parts.every((word) => words.includes(word));
      found += Number(!element.hidden);
    }
    tell(byId("games-status", HTMLElement), found ? "" : "No game of this server has these words.");
  }
}
