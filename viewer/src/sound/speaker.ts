/** Plays the samples of a game. A browser permits sound only after the user has done something on the page: see start(). */
export class Speaker {
  #context: AudioContext | undefined;
  #node: AudioWorkletNode | undefined;
  #inputRate = 30720;
  #starting = false;
  #on = true;
  #gaps = 0;

  get on(): boolean {
    return this.#on;
  }

  /** How often the sound has run out. */
  get gaps(): number {
    return this.#gaps;
  }

  get state(): string {
    return this.#on ? this.#context?.state ?? "not started" : "off";
  }

  /** Must be called while the browser handles what the user did. Further calls do nothing. */
  async start(): Promise<void> {
    if (this.#starting) {
      await this.#context?.resume();
      return;
    }
    this.#starting = true;
    const context = new AudioContext({ latencyHint: "interactive" });
    this.#context = context;
    await context.audioWorklet.addModule("sound.js");
    this.#node = new AudioWorkletNode(context, "racebeam-player", { numberOfInputs: 0, outputChannelCount: [1] });
    this.#node.port.onmessage = ({ data }: MessageEvent<{ gaps: number }>) => {
      this.#gaps = data.gaps;
    };
    this.#node.connect(context.destination);
    this.rate = this.#inputRate;
    await context.resume();
  }

  /** The samples a second of the game. What waits is forgotten. */
  set rate(rate: number) {
    this.#inputRate = rate;
    this.#node?.port.postMessage({ inputRate: rate });
  }

  set on(on: boolean) {
    this.#on = on;
    void (on ? this.#context?.resume() : this.#context?.suspend());
  }

  play(samples: Uint8Array): void {
    if (this.#on) {
      this.#node?.port.postMessage(samples);
    }
  }
}
