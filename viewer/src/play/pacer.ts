const SLACK = 0.1; // of a frame: a tick may come this early
const MOST_LATE = 4; // frames: what is later is forgotten, as when the tab slept

/** Says at each tick of the display how many frames are due, whatever the display's rate. */
export class Pacer {
  #rate: number;
  #last: number | undefined;
  #credit = 0; // frames

  /** `rate`: frames a second. */
  constructor(rate: number) {
    this.#rate = rate;
  }

  /** Begins anew: the next tick has no frame. */
  restart(rate = this.#rate): void {
    this.#rate = rate;
    this.#last = undefined;
    this.#credit = 0;
  }

  /** The frames that are due at `now`, in milliseconds. */
  due(now: number): number {
    this.#credit += ((now - (this.#last ?? now)) * this.#rate) / 1000;
    this.#last = now;
    if (this.#credit > Math.max(MOST_LATE, this.#rate / 10)) {
      this.#credit = 1;
    }
    const frames = Math.max(0, Math.floor(this.#credit + SLACK));
    this.#credit -= frames;
    return frames;
  }
}
