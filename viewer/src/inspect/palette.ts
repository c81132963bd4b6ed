import { make } from "../page/elements.js";

const COLUMNS = 16;
const COLOURS = 128; // even values; an odd one is the grey of the value before it

/** The values of pixels on a screen, the most frequent first. */
export function valuesOf(screen: Uint8Array): number[] {
  const counts = new Uint32Array(256);
  for (const value of screen) {
    ++counts[value]!;
  }
  return Array.from(counts.keys()).filter((value) => counts[value]).sort((a, b) => counts[b]! - counts[a]!);
}

/** The palette of the game, and the colours that the screen has. */
export class PaletteView {
  readonly #canvas: HTMLCanvasElement;
  readonly #list: HTMLElement;
  #colours: Uint32Array = new Uint32Array(256);
  #shown = "";

  constructor(canvas: HTMLCanvasElement, list: HTMLElement) {
    this.#canvas = canvas;
    this.#list = list;
  }

  become(colours: Uint32Array): void {
    this.#colours = colours;
    this.#shown = "";
    fill(this.#canvas, COLUMNS, Array.from({ length: COLOURS }, (_, at) => colours[2 * at] ?? 0));
  }

  show(screen: Uint8Array): void {
    const values = valuesOf(screen);
    if (this.#shown !== values.join()) {
      this.#shown = values.join();
      this.#list.replaceChildren(...values.map((value) => {
        const swatch = make("canvas", { width: 1, height: 1 });
        fill(swatch, 1, [this.#colours[value] ?? 0]);
        return make("li", {}, swatch, `$${value.toString(16).toUpperCase().padStart(2, "0")}`);
      }));
    }
  }
}

/** Fills a canvas with pixels of these colours, row by row. */
function fill(canvas: HTMLCanvasElement, width: number, colours: readonly number[]): void {
  const context = canvas.getContext("2d");
  const image = context?.createImageData(width, colours.length / width);
  if (context && image) {
    new Uint32Array(image.data.buffer).set(colours);
    context.putImageData(image, 0, 0);
  }
}
