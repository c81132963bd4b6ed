import { DOWN, FIRE, LEFT, RIGHT, UP } from "./actions.js";

const DEAD = 0.22; // of the pad's radius: the thumb rests
const SECTORS = [RIGHT, RIGHT | DOWN, DOWN, DOWN | LEFT, LEFT, LEFT | UP, UP, UP | RIGHT] as const; // clockwise, from the right

/** The directions of a thumb at (x, y), in radii from the pad's middle. */
export function directionAt(x: number, y: number): number {
  if (Math.hypot(x, y) < DEAD) {
    return 0;
  }
  const eighth = Math.round(Math.atan2(y, x) / (Math.PI / 4));
  return SECTORS[(eighth + 8) % 8] ?? 0;
}

/** A pad for directions and a button to fire, for fingers. */
export class Touch {
  #directions = 0;
  #fire = 0;

  constructor(pad: HTMLElement, button: HTMLElement, pressed: (time: number) => void) {
    hold(pad, (event) => {
      const { left, top, width, height } = pad.getBoundingClientRect();
      const before = this.#directions;
      this.#directions = event ? directionAt(2 * (event.clientX - left) / width - 1, 2 * (event.clientY - top) / height - 1) : 0;
      if (before !== this.#directions) {
        pressed(event?.timeStamp ?? performance.now());
      }
    });
    hold(button, (event) => {
      if (this.#fire !== (event ? FIRE : 0)) {
        this.#fire = event ? FIRE : 0;
        pressed(event?.timeStamp ?? performance.now());
      }
    });
  }

  pressed(): number {
    return this.#directions | this.#fire;
  }
}

/** Calls `held` with each event of a finger on the element, and with none when the finger leaves. */
export function hold(element: HTMLElement, held: (event?: PointerEvent) => void): void {
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    held(event);
  });
  element.addEventListener("pointermove", (event) => element.hasPointerCapture(event.pointerId) && held(event));
  for (const end of ["pointerup", "pointercancel"] as const) {
    element.addEventListener(end, () => held());
  }
}
