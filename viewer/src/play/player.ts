import type { Group, Session } from "racebeam";
import { actWord, joinRuns } from "../input/actions.js";
import { LatencyMeter } from "./latency.js";
import { History } from "./history.js";
import { Pacer } from "./pacer.js";
import { frameRate } from "../picture/shape.js";

const SPACING = 30; // acts between two states
const MOST_STATES = 240;
const STATES_LEFT = 8; // of those that a session may hold
const MOST_AHEAD = 8; // requests without a reply: a server that is slower slows the game
const REWIND_SPEED = 2; // frames a frame
const SENT_AHEAD = 500; // acts that lead to the moment at which a lost session stood

const FIELDS = ["reward", "terminated", "truncated", "lives", "screen:delta", "audio:raw", "ram:raw"];

/** What is known of the game that is loaded. */
export interface Game {
  /** What it was loaded as: its name, or the MD5 of an image that the user added. */
  key: string;
  name: string;
  md5: string;
  format: string;
  height: number;
  mode: number;
  difficulty: number;
  seed: number;
  rule: boolean;
  /** What is to be said of the image, if anything: "other" or "doubtful". */
  image: string;
}

/** What to load. Without a mode, that of the game. */
export interface Choice {
  game: string;
  mode?: number;
  difficulty?: number;
  seed?: number;
}

/** A moment of the game as it is shown. */
export interface Shown {
  moment: number;
  act: string;
  reward: number;
  score: number;
  lives: number;
  over: boolean;
  screen: Uint8Array;
  ram: Uint8Array;
  audio: Uint8Array;
  agent?: Uint8Array;
  tia?: Uint8Array;
}

export type Motion = "playing" | "paused" | "rewinding";

/** Plays a game in a session: a request a frame, at the pace of the display's ticks. */
export class Player {
  readonly latency = new LatencyMeter();
  /** Called with each moment as its reply arrives. */
  onShow: (shown: Shown) => void = () => {};
  /** Called when the session has ended, or refuses what should succeed. */
  onFail: (error: unknown) => void = () => {};
  motion: Motion = "paused";

  readonly #session: Session;
  readonly #history: History;
  readonly #pacer = new Pacer(60);
  #game: Game | undefined;
  #extra: string[] = [];
  #newest: { shown: Shown; pressed: number | undefined } | undefined;
  #over = false;
  #busy = false; // a game is being loaded
  #ahead = 0;
  #epoch = 0; // replies of an earlier one are about moments that were taken back

  /** `states`: how many the session may hold. */
  constructor(session: Session, states: number) {
    this.#session = session;
    this.#history = new History(SPACING, Math.max(2, Math.min(MOST_STATES, states - STATES_LEFT)));
  }

  get game(): Game | undefined {
    return this.#game;
  }

  get over(): boolean {
    return this.#over;
  }

  /** Requests without a reply. */
  get ahead(): number {
    return this.#ahead;
  }

  get now(): number {
    return this.#history.now;
  }

  /** The positions of the difficulty switches: bit 0 is the left one, bit 1 the right one, and 1 is A. */
  get difficulty(): number {
    return this.#history.difficulty;
  }

  /** The acts since the episode began. With the game, they are the episode. */
  get acts(): readonly string[] {
    return this.#history.acts;
  }

  score(moment: number): number {
    return this.#history.score(moment);
  }

  /** Loads a game, plays `acts`, and shows where that leads. */
  async load(choice: Choice, acts: readonly string[] = []): Promise<Game> {
    const { game, seed = newSeed(), ...settings } = choice;
    this.#busy = true;
    try {
      this.#game = gameOf(game, await this.#session.load(game, { sticky: 0, sound: 1, frame_skip: 1, action_set: "console", seed, ...settings }));
      this.#pacer.restart(frameRate(this.#game.format));
      await this.#begin(acts);
      return this.#game;
    } finally {
      this.#busy = false;
    }
  }

  /** Begins an episode with another seed. The difficulty switches stay where they are. */
  async reset(): Promise<void> {
    if (this.#game && !this.#busy) {
      this.#busy = true;
      try {
        this.#game.seed = newSeed();
        this.#game.difficulty = this.difficulty;
        await this.#session.set({ difficulty: this.difficulty });
        await this.#session.reset(this.#game.seed);
        await this.#begin([]);
      } finally {
        this.#busy = false;
      }
    }
  }

  /** Observes more fields, such as grey84x84x1:delta. A game that pauses is shown with them at once. */
  async observe(extra: string[]): Promise<void> {
    this.#extra = extra;
    if (this.#game) {
      await this.#session.observe(...FIELDS, ...extra);
      if (this.motion === "paused" && !this.#busy) {
        await this.#look();
      }
    }
  }

  /** The display draws a picture: sends what is due. */
  tick(now: number, playerA: number, playerB: number): void {
    const due = this.#pacer.due(now);
    if (this.#busy) {
      return;
    }
    if (this.motion === "rewinding") {
      if (this.#ahead === 0 && due > 0) {
        this.goTo(this.now - due * REWIND_SPEED);
      }
      return;
    }
    for (let frame = 0; frame < due && this.motion === "playing" && !this.#over && this.#ahead < MOST_AHEAD; ++frame) {
      this.act(actWord(playerA, playerB));
    }
  }

  /** Plays one frame, unless the episode is over. */
  act(word: string): void {
    if (!this.#over && !this.#busy) {
      const pressed = this.latency.take();
      const { moment, reply } = this.#send(word);
      void this.#show(reply, moment, pressed);
    }
  }

  /** Goes back to an earlier moment. */
  goTo(moment: number): void {
    const way = this.#history.back(moment);
    if (!way) {
      return;
    }
    const { state, acts } = way;
    ++this.#epoch;
    this.#over = false;
    const restored = this.#session.restore(state);
    restored.catch(() => {}); // if it fails, the acts do, too
    void this.#show(acts.length ? this.#session.act(...joinRuns(acts)) : restored, this.now);
  }

  /** The newest moment that has not been drawn yet. */
  take(now: number): Shown | undefined {
    const newest = this.#newest;
    this.#newest = undefined;
    if (newest?.pressed !== undefined) {
      this.latency.drawn(newest.pressed, now);
    }
    return newest?.shown;
  }

  /** Begins the history of an episode whose first moment the session shows, and plays `acts`. */
  async #begin(acts: readonly string[]): Promise<void> {
    ++this.#epoch;
    this.#history.begin(this.#game?.difficulty);
    this.#over = false;
    await this.#session.observe("reward", "terminated", "truncated", "lives");
    for (let at = 0; at < acts.length; at += SENT_AHEAD) {
      await Promise.all(acts.slice(at, at + SENT_AHEAD).map((act) => this.#send(act).reply));
    }
    await this.#session.observe(...FIELDS, ...this.#extra);
    await this.#look();
  }

  /** Shows the present moment. A look has no deltas: it leaves those of acts as they are. */
  async #look(): Promise<void> {
    const extra = this.#extra.map((field) => field.replace(":delta", ""));
    await this.#show(this.#session.look("terminated", "truncated", "lives", "screen", "audio:raw", "ram:raw", ...extra), this.now);
  }

  /** Sends an act, and a request to save the moment before it if it is time. */
  #send(word: string): { moment: number; reply: Promise<Group> } {
    const state = this.#history.saves();
    if (state) {
      this.#session.save(state, { generator: 1 }).catch(this.onFail);
    }
    const moment = this.#history.add(word);
    const reply = this.#session.act(word).then((group) => {
      this.#history.reward(moment, group.reward);
      return group;
    });
    return { moment, reply };
  }

  /** Shows the moment that a reply describes, unless it has been taken back meanwhile. */
  async #show(reply: Promise<Group>, moment: number, pressed?: number): Promise<void> {
    const epoch = this.#epoch;
    ++this.#ahead;
    try {
      const group = await reply;
      if (epoch === this.#epoch) {
        this.#take(group, moment, pressed);
      }
    } catch (error) {
      this.onFail(error);
    } finally {
      --this.#ahead;
    }
  }

  #take(group: Group, moment: number, pressed: number | undefined): void {
    const over = group.terminated === 1 || group.truncated === 1;
    if (over) {
      this.#history.cut(moment); // acts that were sent ahead have run no frame
      ++this.#epoch;
      this.#over = true;
    }
    const { reward = 0, lives, screen, ram, audio, grey84x84x1: agent, tia } = group;
    const act = this.#history.acts[moment - 1] ?? "0";
    const shown: Shown = { moment, act, reward, score: this.score(moment), lives, over, screen, ram, audio, ...(agent ? { agent } : {}), ...(tia ? { tia } : {}) };
    this.#newest = { shown, pressed: this.#newest?.pressed ?? pressed };
    this.onShow(shown);
  }
}

function newSeed(): number {
  return 1 + Math.floor(Math.random() * 0xfffffffe);
}

function gameOf(key: string, loaded: Group): Game {
  const { game, md5, format, height, mode, difficulty, seed, rule, image = "" } = loaded;
  return { key, name: String(game), md5: String(md5), format, height, mode, difficulty, seed, rule: rule === 1, image };
}
