// The part of the page that runs in the thread of the sound. Messages: { inputRate } first, then samples as bytes.

import { Resampler } from "./resampler.js";

declare const sampleRate: number;
declare function registerProcessor(name: string, processor: unknown): void;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}

const REPORT_EVERY = 100; // calls

class Player extends AudioWorkletProcessor {
  #resampler: Resampler | undefined;
  #calls = 0;

  constructor() {
    super();
    this.port.onmessage = ({ data }: MessageEvent<{ inputRate: number } | Uint8Array>) => {
      if (data instanceof Uint8Array) {
        this.#resampler?.push(data);
      } else {
        this.#resampler = new Resampler(data.inputRate, sampleRate);
      }
    };
  }

  process(_: Float32Array[][], [output]: Float32Array[][]): boolean {
    const channel = output?.[0];
    if (channel && this.#resampler) {
      this.#resampler.pull(channel);
      if (++this.#calls % REPORT_EVERY === 0) {
        this.port.postMessage({ gaps: this.#resampler.gaps, waiting: this.#resampler.waiting });
      }
    }
    return true;
  }
}

registerProcessor("racebeam-player", Player);
