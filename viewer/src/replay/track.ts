import type { Group, Session } from "racebeam";
import { joinRuns } from "../input/actions.js";
import { isOwn } from "../page/titles.js";
import { HASH_EVERY, hexOf, type Episode } from "./log.js";

const MOST_STATES = 240;
const SENT_AHEAD = 500; // requests
const FILMED_AHEAD = 50; // requests: a film takes longer
const FIELDS = ["reward", "terminated", "truncated", "lives", "screen:delta", "audio:raw", "ram:raw"];

/** What an episode came to when it was played again. */
export interface Outcome {
  /** What is not as in the log, such as "the score"; undefined if the log says nothing of its end. */
  differences: readonly string[] | undefined;
  /** Steps at which there was a reward, with it. */
  rewards: { step: number; reward: number }[];
}

/**
 * An episode that can be shown at any step. A step is a frame, or a decision of the agent where the episode cannot be played frame
 * by frame. The session has states on the way, so that no step is far from one.
 */
export class Track {
  readonly #session: Session;
  readonly #episode: Episode;
  readonly #states: number;
  #steps: string[] = [];
  #spacing = 1;
  #at = 0;
  #scores: number[] = [0];
  #framesAStep = 1;
  #loaded: Group = {};
  #settings: Record<string, unknown> = {};

  /** `states`: how many the session may hold. */
  constructor(session: Session, episode: Episode, states: number) {
    this.#session = session;
    this.#episode = episode;
    this.#states = Math.min(MOST_STATES, states - 2);
  }

  get episode(): Episode {
    return this.#episode;
  }

  /** Steps after the first moment. */
  get length(): number {
    return this.#steps.length;
  }

  /** The reply of `load`. */
  get loaded(): Group {
    return this.#loaded;
  }

  /** Frames of the game in each step. */
  get framesAStep(): number {
    return this.#framesAStep;
  }

  /** The words of `act` for each step. */
  get steps(): readonly string[] {
    return this.#steps;
  }

  /** The sum of rewards after a step. */
  score(step: number): number {
    return this.#scores[step] ?? 0;
  }

  /** Plays the episode through. `progress` is called with the part that is done. */
  async prepare(progress: (part: number) => void): Promise<Outcome> {
    const skip = Number(this.#episode.settings.frame_skip ?? 1);
    const frames = Number.isInteger(skip) && skip > 1 ? await this.#attempt(skip, progress) : undefined;
    if (frames?.differences?.length === 0) {
      return frames;
    }
    return this.#attempt(1, progress);
  }

  /** Loads the game of the episode: with the image that the user has added, if the log names that. */
  #load(session: Session): Promise<Group> {
    const { game, md5 = "" } = this.#episode;
    return isOwn(md5) ? session.load(md5, { as: game, ...this.#settings }) : session.load(game, this.#settings);
  }

  /** The moment after a step, as the session shows it. */
  async show(step: number): Promise<Group> {
    const target = Math.max(0, Math.min(this.length, step));
    const state = Math.floor(target / this.#spacing);
    const onward = target > this.#at && state * this.#spacing <= this.#at;
    const acts = this.#steps.slice(onward ? this.#at : state * this.#spacing, target);
    this.#at = target;
    if (onward) {
      return this.#session.act(...joinRuns(acts));
    }
    const restored = this.#session.restore(name(state));
    if (!acts.length) {
      return restored;
    }
    restored.catch(() => {}); // if it fails, the acts do, too
    return this.#session.act(...joinRuns(acts));
  }

  /** Records the episode under a name in the server's folder, in another session. The reply says what was made. */
  async film(session: Session, kind: string, name: string, progress: (part: number) => void): Promise<Group> {
    await this.#load(session);
    await session.record(kind, name);
    for (let at = 0; at < this.length; at += FILMED_AHEAD) {
      await Promise.all(this.#steps.slice(at, at + FILMED_AHEAD).map((act) => session.act(act)));
      progress(Math.min(1, (at + FILMED_AHEAD) / this.length));
    }
    return session.stopRecording();
  }

  /** Plays with each act divided into `parts` frames. */
  async #attempt(parts: number, progress: (part: number) => void): Promise<Outcome> {
    const { settings, acts } = this.#episode;
    this.#settings = { ...settings, ...(parts > 1 ? { frame_skip: 1 } : {}), sound: 1 };
    this.#loaded = await this.#load(this.#session);
    this.#framesAStep = parts > 1 ? 1 : Number(settings.frame_skip ?? 1) || 1;
    this.#steps = parts > 1 ? acts.flatMap((act) => new Array<string>(parts).fill(act)) : [...acts];
    this.#spacing = Math.max(1, Math.ceil((this.#steps.length + 1) / this.#states));
    await this.#session.observe("reward", "terminated", "truncated", "lives", "frames");
    const outcome = await this.#play(progress);
    await this.#session.observe(...FIELDS);
    await this.show(0);
    return outcome;
  }

  async #play(progress: (part: number) => void): Promise<Outcome> {
    const rewards: Outcome["rewards"] = [];
    const hashes: Promise<Group>[] = [];
    const stretch = HASH_EVERY * (this.#steps.length / this.#episode.acts.length || 1);
    let frames = 0;
    let last: Group = {};
    this.#scores = [0];
    for (let at = 0; at <= this.#steps.length; at += SENT_AHEAD) {
      const sent: Promise<Group>[] = [];
      for (let step = at; step <= Math.min(at + SENT_AHEAD - 1, this.#steps.length); ++step) {
        if (step % this.#spacing === 0) {
          void this.#session.save(name(step / this.#spacing), { generator: 1 });
        }
        if (step < this.#steps.length) {
          sent.push(this.#session.act(this.#steps[step]!));
          if ((step + 1) % stretch === 0) {
            hashes.push(this.#hash());
          }
        }
      }
      for (const group of await Promise.all(sent)) {
        const step = this.#scores.push((this.#scores.at(-1) ?? 0) + group.reward) - 1;
        if (group.reward) {
          rewards.push({ step, reward: group.reward });
        }
        frames += group.frames;
        last = group;
      }
      progress(Math.min(1, (at + SENT_AHEAD) / (this.#steps.length + 1)));
    }
    hashes.push(this.#hash());
    this.#steps.splice(frames); // an act after the end plays no frame
    const found = (await Promise.all(hashes)).map(({ state_hash }) => hexOf(state_hash));
    return { rewards, differences: this.#compare(frames, last, found) };
  }

  #hash(): Promise<Group> {
    const hash = this.#session.look("state_hash");
    hash.catch(() => {}); // if it fails, the acts do, too
    return hash;
  }

  #compare(frames: number, last: Group, hashes: readonly string[]): string[] | undefined {
    const { ended, hashes: logged = [] } = this.#episode;
    if (!ended) {
      return undefined;
    }
    const stretch = logged.findIndex((hash, number) => hash !== hashes[number]);
    const differs: Record<string, boolean> = {
      [`the state in decisions ${stretch * HASH_EVERY + 1} to ${Math.min((stretch + 1) * HASH_EVERY, ended.decisions)}`]: stretch >= 0,
      "the score": ended.score !== this.score(this.length),
      "the lives": ended.lives !== last.lives,
      "the frames": ended.frames !== frames,
      "the end": last[ended.end] !== 1,
    };
    return Object.keys(differs).filter((what) => differs[what]);
  }
}

function name(state: number): string {
  return `step${state}`;
}
