const KEPT = 64; // measurements

/** The time from a key to the first picture that it can have changed. */
export class LatencyMeter {
  #pressed: number | undefined;
  readonly #times: number[] = [];

  /** A key has changed at `time`. The first change since the last request counts. */
  press(time: number): void {
    this.#pressed ??= time;
  }

  /** A request with what is pressed leaves. Returns when the key changed that it is the first to carry, if one did. */
  take(): number | undefined {
    const time = this.#pressed;
    this.#pressed = undefined;
    return time;
  }

  /** The picture of the reply to that request has been drawn. */
  drawn(pressed: number, now: number): void {
    this.#times.push(now - pressed);
    this.#times.splice(0, this.#times.length - KEPT);
  }

  /** The median and the longest of the measured times that are kept, in milliseconds. */
  get figures(): { median: number; worst: number } | undefined {
    const times = [...this.#times].sort((a, b) => a - b);
    const median = times[times.length >> 1];
    return median === undefined ? undefined : { median, worst: times.at(-1)! };
  }
}
