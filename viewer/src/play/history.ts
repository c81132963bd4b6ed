import { difficultyAfter } from "../input/actions.js";

/** A way to an earlier moment: a state to restore, and the acts to play from it. */
interface Way {
  state: string;
  acts: string[];
}

/**
 * The acts of an episode, and the states that the session has on its way. Any moment of the last `spacing * (slots - 1)` acts is
 * a state and some acts away. A moment is the number of acts played before it.
 */
export class History {
  readonly #spacing: number;
  readonly #slots: number;
  readonly #acts: string[] = [];
  readonly #scores: number[] = [0]; // at each moment
  readonly #difficulties: [number, number][] = [[0, 0]]; // moments at which they changed, and what they became
  #states = 0; // that were saved on the way to the present moment
  #lost = 0; // states at the beginning whose slots later ones have taken

  constructor(spacing: number, slots: number) {
    this.#spacing = spacing;
    this.#slots = slots;
  }

  /** The present moment. */
  get now(): number {
    return this.#acts.length;
  }

  /** The earliest moment that can be reached. */
  get earliest(): number {
    return this.#lost * this.#spacing;
  }

  get acts(): readonly string[] {
    return this.#acts;
  }

  /** An episode begins, with the difficulty switches in these positions. */
  begin(difficulty = 0): void {
    this.#acts.length = 0;
    this.#scores.length = 1;
    this.#difficulties.splice(0, Infinity, [0, difficulty]);
    this.#states = 0;
    this.#lost = 0;
  }

  /** The name under which the present moment must be saved now, if it must. */
  saves(): string | undefined {
    if (this.now !== this.#states * this.#spacing) {
      return undefined;
    }
    const name = this.#name(this.#states++);
    this.#lost = Math.max(this.#lost, this.#states - this.#slots);
    return name;
  }

  /** Adds an act. Returns the moment after it. */
  add(act: string): number {
    const [before, moment] = [this.difficulty, this.#acts.push(act)];
    const after = difficultyAfter(before, act);
    if (after !== before) {
      this.#difficulties.push([moment, after]);
    }
    return moment;
  }

  /** The positions of the difficulty switches at the present moment. */
  get difficulty(): number {
    return this.#difficulties.at(-1)![1];
  }

  /** Notes the reward of the act before a moment. Moments that were cut off are left out. */
  reward(moment: number, reward: number): void {
    if (moment <= this.now) {
      this.#scores[moment] = this.score(moment - 1) + reward;
    }
  }

  score(moment: number): number {
    return this.#scores[moment] ?? 0;
  }

  /** Forgets what came after a moment. */
  cut(moment: number): void {
    this.#acts.length = Math.min(this.#acts.length, moment);
    this.#scores.length = Math.min(this.#scores.length, moment + 1);
    while (this.#difficulties.at(-1)![0] > moment) {
      this.#difficulties.pop();
    }
    this.#states = Math.min(this.#states, Math.floor(moment / this.#spacing) + 1);
  }

  /** The way to a moment, or to the earliest one. What came after it is forgotten. Undefined before the first act. */
  back(moment: number): Way | undefined {
    if (!this.#states) {
      return undefined;
    }
    const target = Math.min(Math.max(moment, this.earliest), this.now);
    this.cut(target);
    const state = this.#states - 1;
    return { state: this.#name(state), acts: this.#acts.slice(state * this.#spacing) };
  }

  #name(state: number): string {
    return `moment${state % this.#slots}`;
  }
}
