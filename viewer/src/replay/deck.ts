import { describeAct } from "../input/actions.js";
import { copyOf, part, tell } from "../page/elements.js";
import { reasonOf, type Server } from "../page/server.js";
import { Screen } from "../picture/screen.js";
import { frameRate, soundRate } from "../picture/shape.js";
import type { Episode } from "./log.js";
import { Track, type Outcome } from "./track.js";

/** One episode on the page, in a session of its own. */
export class Deck {
  readonly element = copyOf("deck");
  readonly episode: Episode;
  /** Whether the server records films. */
  records = false;
  /** Called when the user closes the deck. */
  onClose: () => void = () => {};
  /** Called with the sound of a frame that follows the one shown before. */
  onSound: (samples: Uint8Array) => void = () => {};

  readonly #server: Server;
  readonly #screen = new Screen(part(this.element, "screen", HTMLCanvasElement));
  #track: Track | undefined;
  #outcome: Outcome | undefined;
  #end: (() => Promise<void>) | undefined;
  #lost = false; // the session has ended, and this is told
  #current = -1; // step
  #target = 0; // frame
  #showing = false;

  constructor(server: Server, episode: Episode) {
    this.#server = server;
    this.episode = episode;
    tell(part(this.element, "title", HTMLElement), episode.title);
    part(this.element, "close", HTMLButtonElement).onclick = () => this.onClose();
  }

  /** Frames of the episode; 0 until it has been played through. */
  get frames(): number {
    return this.#outcome && this.#track ? this.#track.length * this.#track.framesAStep : 0;
  }

  get frameRate(): number {
    return frameRate(String(this.#track?.loaded.format));
  }

  get soundRate(): number {
    return soundRate(String(this.#track?.loaded.format));
  }

  /** The frames after which there was a reward, with it. */
  get rewards(): { frame: number; reward: number }[] {
    const { rewards = [] } = this.#outcome ?? {};
    return rewards.map(({ step, reward }) => ({ frame: step * (this.#track?.framesAStep ?? 1), reward }));
  }

  /** Opens the session, and plays the episode through. */
  async open(): Promise<void> {
    const progress = part(this.element, "progress", HTMLProgressElement);
    progress.hidden = false;
    const { session, limits } = await this.#server.open();
    this.#lost = false;
    this.#end = () => session.disconnect();
    void session.ended.then(() => this.#lose());
    this.records = limits.recording === 1;
    this.#track = new Track(session, this.episode, limits.max_states);
    this.#outcome = await this.#track.prepare((done) => (progress.value = done));
    await this.#server.claim(session, "replay");
    this.#screen.become(await session.palette(), String(this.#track.loaded.format), this.#track.loaded.height);
    progress.hidden = true;
    part(this.element, "facts", HTMLElement).classList.toggle("problem", !!this.#outcome.differences?.length);
    this.#current = -1;
    this.show(this.#target);
  }

  async close(): Promise<void> {
    this.element.remove();
    await this.#end?.();
  }

  /** Makes a film of the episode in the server's folder: gif, webm, mp4, or png for a folder of pictures. Returns its name. */
  async film(kind: string): Promise<string> {
    const track = this.#track!;
    const progress = part(this.element, "progress", HTMLProgressElement);
    const { session } = await this.#server.open();
    progress.hidden = false;
    try {
      const time = new Date().toISOString().replace(/\D/g, "").slice(0, 14);
      const made = await track.film(session, kind, `${this.episode.game}-${time}`, (done) => (progress.value = done));
      return `${made.recorded}: ${made.frames} frames${made.complete === 1 ? "" : ", cut short"}`;
    } finally {
      progress.hidden = true;
      await session.disconnect();
    }
  }

  /** Shows a frame. While the server works, only the newest wish counts. */
  show(frame: number): void {
    this.#target = frame;
    if (!this.#showing && this.#outcome) {
      void this.#follow();
    }
  }

  /** Shows frames until the target is shown. Meanwhile the element is busy, for readers of screens and for tests. */
  async #follow(): Promise<void> {
    const track = this.#track!;
    this.#busy(true);
    try {
      for (let step = this.#step(); step !== this.#current; step = this.#step()) {
        const group = await track.show(step);
        if (step === this.#current + 1) {
          this.onSound(group.audio);
        }
        this.#current = step;
        this.#screen.draw(group.screen);
        tell(part(this.element, "facts", HTMLElement), this.#facts(step, group.lives));
      }
    } catch (error) {
      if (!this.#lost) {
        this.#fail(reasonOf(error));
      }
    } finally {
      this.#busy(false);
    }
  }

  #busy(showing: boolean): void {
    this.#showing = showing;
    this.element.setAttribute("aria-busy", String(showing));
  }

  /** The step that shows the target frame. */
  #step(): number {
    const track = this.#track!;
    return Math.max(0, Math.min(track.length, Math.floor(this.#target / track.framesAStep)));
  }

  /** The session has ended: unless the deck was closed, plays the episode again as soon as the server answers. */
  async #lose(): Promise<void> {
    if (this.element.isConnected) {
      this.#lost = true;
      this.#fail("The connection is lost. Trying again.");
      const { session } = await this.#server.reopen(() => {});
      await session.disconnect();
    }
    if (this.element.isConnected) {
      await this.open().catch((error) => this.#fail(reasonOf(error)));
    }
  }

  #fail(sentence: string): void {
    const facts = part(this.element, "facts", HTMLElement);
    tell(facts, sentence);
    facts.classList.add("problem");
  }

  #facts(step: number, lives: number): string {
    const track = this.#track!;
    const act = track.steps[step - 1];
    const differences = this.#outcome?.differences;
    return [
      `score ${track.score(step)} of ${track.score(track.length)}`,
      `lives ${lives}`,
      act === undefined ? "start" : describeAct(act),
      ...(differences ? [differences.length ? `does not play as logged: ${differences.join(", ")}` : "plays as logged"] : []),
    ].join(" · ");
  }
}
