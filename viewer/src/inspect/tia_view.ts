import { make, tell } from "../page/elements.js";

/** The registers of the TIA, as a list of names and values. */
export class TiaView {
  readonly #list: HTMLElement;
  #values: HTMLElement[] = [];

  constructor(list: HTMLElement) {
    this.#list = list;
  }

  /** The names of the values, in their order. */
  begin(names: readonly string[]): void {
    this.#values = names.map(() => make("dd"));
    this.#list.replaceChildren(...names.map((name, index) => make("div", {}, make("dt", { textContent: name }), this.#values[index]!)));
  }

  /** Shows the values, and marks what has changed since the last call. */
  show(tia: Uint8Array): void {
    this.#values.forEach((value, index) => {
      const text = (tia[index] ?? 0).toString(16).toUpperCase().padStart(2, "0");
      value.classList.toggle("changed", value.textContent !== "" && value.textContent !== text);
      tell(value, text);
    });
  }
}
