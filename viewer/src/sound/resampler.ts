const FADE = 256; // samples of the output in which the sound comes or goes
const MOST_BENT = 0.005; // how much faster or slower the sound may be played, which no ear hears
const FULLY_BENT_AT = 0.25; // of the ideal number of samples that wait, too many or too few
const SMOOTHING = 0.01; // of a call, when the mean of samples that wait is taken

/**
 * A ring buffer between a machine, which makes samples a frame at a time, and the sound card, which takes them by its own clock. It
 * plays slightly faster or slower, so that it neither overflows nor runs empty. If it does run empty, the sound fades out, and
 * begins again when the buffer has filled, without a crackle.
 */
export class Resampler {
  readonly #ring: Float32Array;
  readonly #step: number; // samples of the input for each of the output
  readonly #target: number; // samples that wait, ideally
  #written = 0; // since the beginning
  #read = 0; // since the beginning, with a fraction
  #level: number; // the mean of samples that wait
  #gain = 0;
  #plays = false;
  #gaps = 0;

  /** Rates are samples a second. `delay`: seconds of sound that wait in the buffer, ideally. */
  constructor(inputRate: number, outputRate: number, delay = 0.06) {
    this.#step = inputRate / outputRate;
    this.#target = Math.round(inputRate * delay);
    this.#level = this.#target;
    this.#ring = new Float32Array(4 * this.#target);
  }

  /** Samples that wait. */
  get waiting(): number {
    return this.#written - this.#read;
  }

  /** How often the buffer ran empty. */
  get gaps(): number {
    return this.#gaps;
  }

  /** Adds unsigned bytes, of which 128 is silence. */
  push(samples: Uint8Array): void {
    for (const sample of samples) {
      this.#ring[this.#written++ % this.#ring.length] = (sample - 128) / 128;
    }
    if (this.waiting > this.#ring.length) {
      this.#read = this.#written - this.#target; // too much: skip to the newest
    }
  }

  /** Fills `output`. */
  pull(output: Float32Array): void {
    this.#level += (this.waiting - this.#level) * SMOOTHING;
    const excess = (this.#level - this.#target) / (this.#target * FULLY_BENT_AT);
    const bent = Math.max(-1, Math.min(1, excess)) * MOST_BENT;
    for (let at = 0; at < output.length; ++at) {
      this.#turn();
      this.#gain = Math.max(0, Math.min(1, this.#gain + (this.#plays ? 1 : -1) / FADE));
      output[at] = this.#gain * this.#sample();
      if (this.#gain > 0 && this.waiting > 2) {
        this.#read += this.#step * (1 + bent);
      }
    }
  }

  /** Decides whether the sound plays. */
  #turn(): void {
    if (!this.#plays && this.waiting >= this.#target) {
      this.#plays = true;
    } else if (this.#plays && this.waiting < FADE * this.#step + 2) {
      this.#plays = false;
      ++this.#gaps;
    }
  }

  /** Between the two samples at the place that is read. */
  #sample(): number {
    const place = Math.floor(this.#read);
    const here = this.#ring[place % this.#ring.length] ?? 0;
    const next = this.#ring[(place + 1) % this.#ring.length] ?? 0;
    return here + (next - here) * (this.#read - place);
  }
}
