import { make, tell } from "../page/elements.js";
import { addressOf } from "./search.js";

const COLUMNS = 16;
const ROWS = 8;

/** The 128 bytes of RAM as a table. */
export class RamGrid {
  readonly #cells: HTMLTableCellElement[] = [];
  readonly #names: HTMLElement;
  #before: Uint8Array = new Uint8Array(0);

  /** `names`: where names of bytes are listed. */
  constructor(table: HTMLTableElement, names: HTMLElement) {
    this.#names = names;
    const digits = Array.from({ length: COLUMNS }, (_, column) => make("th", { scope: "col", textContent: column.toString(16).toUpperCase() }));
    table.append(make("caption", { className: "visually-hidden", textContent: "Bytes of RAM in hexadecimal" }),
      make("thead", {}, make("tr", {}, make("td"), ...digits)));
    const body = table.createTBody();
    for (let row = 0; row < ROWS; ++row) {
      const line = body.insertRow();
      line.append(make("th", { scope: "row", textContent: addressOf(row * COLUMNS) }));
      for (let column = 0; column < COLUMNS; ++column) {
        this.#cells.push(line.insertCell());
      }
    }
  }

  /** Shows RAM, and marks what has changed since the last call. */
  show(ram: Uint8Array): void {
    this.#cells.forEach((cell, index) => {
      const changed = this.#before.length > 0 && ram[index] !== this.#before[index];
      cell.classList.toggle("changed", changed);
      if (changed || !this.#before.length) {
        tell(cell, (ram[index] ?? 0).toString(16).toUpperCase().padStart(2, "0"));
      }
    });
    this.#before = ram;
  }

  /** Names the bytes that the game's rule reads, by their indices. */
  name(names: ReadonlyMap<number, string>): void {
    this.#cells.forEach((cell, index) => {
      cell.classList.toggle("named", names.has(index));
      cell.title = names.get(index) ?? "";
    });
    const listed = [...names].map(([index, name]) => `${addressOf(index)} ${name}`);
    tell(this.#names, listed.length ? `The game's rule reads: ${listed.join(", ")}.` : "");
  }

  /** Marks the bytes that a search has left over. */
  mark(candidates: readonly number[]): void {
    const marked = new Set(candidates.length < this.#cells.length ? candidates : []);
    this.#cells.forEach((cell, index) => cell.classList.toggle("candidate", marked.has(index)));
  }
}
