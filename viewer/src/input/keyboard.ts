import { DOWN, FIRE, LEFT, RESET, RIGHT, SELECT, UP } from "./actions.js";

/** Keys by KeyboardEvent.code, so that they lie where they lie on every layout. */
const KEYS: readonly ReadonlyMap<string, number>[] = [
  new Map([["ArrowUp", UP], ["ArrowDown", DOWN], ["ArrowLeft", LEFT], ["ArrowRight", RIGHT], ["Space", FIRE], ["ControlRight", FIRE],
    ["KeyR", RESET], ["KeyE", SELECT]]),
  new Map([["KeyW", UP], ["KeyS", DOWN], ["KeyA", LEFT], ["KeyD", RIGHT], ["KeyG", FIRE]]),
];

/** The keys of both players, while an element has the focus. */
export class Keyboard {
  readonly #held = new Set<string>();

  /** `pressed`: is called when a key of a player goes down or up, with the event's time. */
  constructor(element: HTMLElement, pressed: (time: number) => void) {
    const turn = (event: KeyboardEvent, down: boolean) => {
      if (event.ctrlKey && event.code !== "ControlRight" || event.altKey || event.metaKey || !KEYS.some((keys) => keys.has(event.code))) {
        return;
      }
      event.preventDefault();
      if (this.#held.has(event.code) !== down) {
        down ? this.#held.add(event.code) : this.#held.delete(event.code);
        pressed(event.timeStamp);
      }
    };
    element.addEventListener("keydown", (event) => turn(event, true));
    element.addEventListener("keyup", (event) => turn(event, false));
    element.addEventListener("blur", () => this.#held.clear());
  }

  /** What a player presses: 0 is player A, 1 player B. */
  pressed(player: number): number {
    let bits = 0;
    for (const [code, bit] of KEYS[player] ?? []) {
      bits |= this.#held.has(code) ? bit : 0;
    }
    return bits;
  }
}
