/** A stack of screens that the client makes, as the server does for the field grey84x84xN. */
export class ScreenStack {
  #depth;
  #screens = [];

  constructor(depth) {
    this.#depth = depth;
  }

  clear() {
    this.#screens = [];
  }

  push(screen) {
    this.#screens = [...this.#screens, screen].slice(-this.#depth);
    const stack = new Uint8Array(this.#depth * screen.length);
    this.#screens.forEach((each, at) => stack.set(each, (this.#depth - this.#screens.length + at) * screen.length));
    return stack;
  }
}
