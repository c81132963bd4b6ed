import { make } from "../page/elements.js";

const SIDE = 84;
const DEPTH = 4; // screens of the stack
const APART = 4; // frames between two screens

/** The screens of 84 x 84 grey pixels that an agent would see, the oldest first. */
export class AgentView {
  readonly #canvases: HTMLCanvasElement[];
  #frames: Uint8Array[] = []; // the newest first

  constructor(element: HTMLElement) {
    this.#canvases = Array.from({ length: DEPTH }, (_, place) => {
      const age = APART * (DEPTH - 1 - place);
      const canvas = make("canvas", { width: SIDE, height: SIDE });
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", age ? `${age} frames ago` : "now");
      return canvas;
    });
    element.append(...this.#canvases);
  }

  add(frame: Uint8Array): void {
    this.#frames = [frame, ...this.#frames].slice(0, APART * (DEPTH - 1) + 1);
  }

  draw(): void {
    this.#canvases.forEach((canvas, place) => {
      const context = canvas.getContext("2d");
      const frame = this.#frames[APART * (DEPTH - 1 - place)];
      if (context && frame) {
        const image = context.createImageData(SIDE, SIDE);
        const pixels = new Uint32Array(image.data.buffer);
        frame.forEach((grey, at) => (pixels[at] = 0xff000000 | (grey * 0x010101)));
        context.putImageData(image, 0, 0);
      }
    });
  }
}
