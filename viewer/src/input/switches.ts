import { RESET, SELECT } from "./actions.js";
import { hold } from "./touch.js";

const SHORTEST = 100; // milliseconds for which a press lasts at least: several frames

/** The switches RESET and SELECT of the console, as buttons that fingers, a mouse or keys hold. */
export class Switches {
  #pressed = 0;

  /** `used`: is called when a switch goes down. */
  constructor(reset: HTMLElement, select: HTMLElement, used: () => void) {
    for (const [button, bit] of [[reset, RESET], [select, SELECT]] as const) {
      let since = 0;
      const press = (time: number) => {
        since = time;
        this.#pressed |= bit;
        used();
      };
      const release = () => setTimeout(() => (this.#pressed &= ~bit), since + SHORTEST - performance.now());
      hold(button, (event) => (event?.type === "pointerdown" ? press(event.timeStamp) : event ? undefined : release()));
      button.addEventListener("mousedown", (event) => event.preventDefault()); // the game keeps the focus
      button.addEventListener("click", ({ detail, timeStamp }) => detail === 0 && (press(timeStamp), release())); // by a key
    }
  }

  pressed(): number {
    return this.#pressed;
  }
}
