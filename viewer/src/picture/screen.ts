import { pictureAspect } from "./shape.js";

const WIDTH = 160;

/** A canvas that shows screens: bytes that a palette turns into colours. */
export class Screen {
  readonly canvas: HTMLCanvasElement;
  #context: CanvasRenderingContext2D;
  #image: ImageData;
  #pixels: Uint32Array;
  #colours: Uint32Array = new Uint32Array(256).fill(0xff000000);

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    const context = canvas.getContext("2d", { alpha: false });
    if (!context) {
      throw new Error("the browser has no canvas of two dimensions");
    }
    this.#context = context;
    this.#image = context.createImageData(WIDTH, 210);
    this.#pixels = new Uint32Array(this.#image.data.buffer);
  }

  /** Takes the colours of a game, 0xAABBGGRR for each value of a pixel, and the shape of its pictures. */
  become(colours: Uint32Array, format: string, height: number): void {
    this.#colours = colours;
    this.canvas.width = WIDTH;
    this.canvas.height = height;
    this.canvas.style.setProperty("--aspect", String(pictureAspect(format, height)));
    this.#image = this.#context.createImageData(WIDTH, height);
    this.#pixels = new Uint32Array(this.#image.data.buffer);
  }

  draw(screen: Uint8Array): void {
    const { length } = this.#pixels;
    for (let at = 0; at < length; ++at) {
      this.#pixels[at] = this.#colours[screen[at]!]!;
    }
    this.#context.putImageData(this.#image, 0, 0);
  }
}
