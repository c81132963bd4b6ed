/** The version of the protocol that this client speaks. */
export const PROTOCOL: 1;

/** A group of a reply. Numbers come as numbers, fields that are bytes as Uint8Array, the rest as strings. */
export type Group = Record<string, any>;

/** Such as { seed: 7, frame_skip: 4, preset: "dqn2015" }. */
export type Settings = Record<string, string | number | boolean>;

/** An action's name or number, with the marks of the protocol: "FIRE", 3, "UP*10", "5/LEFT@0.5". */
export type Action = string | number;

/** A branch's group: reward, acts, terminated, truncated, lives, and state with keep. */
export interface Branch extends Group {
  /** The reward of each act. */
  rewards: number[];
  /** The rewards of player B, if the game's rules have one. */
  rewards_b?: number[];
}

export interface Options {
  /** The token of servers that require one. */
  token?: string;
  /** Milliseconds to wait for a connection, and for each reply. Without it, for ever. */
  timeout?: number;
  /** Options of node:tls, such as { ca }. */
  tls?: import("node:tls").ConnectionOptions;
  /** The class WebSocket for ws:// and wss:// addresses, if the platform lacks it (Node before 22). */
  WebSocket?: unknown;
  /** Bytes. A server that sends a longer line is taken for broken. */
  longestReply?: number;
}

/**
 * A session of the server at an address: tcp://HOST:PORT, tls://HOST:PORT, ws://HOST:PORT, wss://HOST:PORT, unix:PATH, pipes:PREFIX
 * (named pipes), stdio (the streams of this process) or file:PATH (the first address in the server's ready file or announce file,
 * with the token of the latter; file:PATH?wait=SECONDS waits for the server). Without one, the variable RACEBEAM_ADDRESS has it.
 *
 * In a browser: ws://HOST:PORT or wss://HOST:PORT; without an address, the server that the page came from.
 */
export function connect(address?: string, options?: Options): Promise<Session>;

/** A session with a server that it starts, and that ends with it. Not in a browser. */
export function launch(settings?: {
  /** The program racebeam. Without it, that of RACEBEAM_PROGRAM, or of the PATH. */
  program?: string;
  /** Of `racebeam serve`, such as ["--roms", DIR]. */
  options?: string[];
  timeout?: number;
  longestReply?: number;
}): Session;

/**
 * One session, with a method for each command. Requests can be sent ahead: call the methods without awaiting. Each promise gets
 * its own reply. It is rejected with a RefusedError, and the session continues; or with a LostError, and the session has ended.
 */
export class Session {
  /** Resolves with the reason once the session has ended, whether or not a request waits. */
  readonly ended: Promise<LostError>;
  /** Ends the session. Further calls do nothing. */
  disconnect(): Promise<void>;
  [Symbol.asyncDispose](): Promise<void>;

  /** Any request: words, and objects that stand for settings. Returns the groups of the reply. */
  request(...parts: (Action | Settings | Action[])[]): Promise<Group[]>;

  help(...topic: string[]): Promise<string>;
  /** What the server knows about one game. */
  game(name: string): Promise<Group>;
  /** Power on with an image and begin an episode. image: the bytes of a cartridge, if the game is "inline". */
  load(game: string, settings?: Settings & { image?: Uint8Array } | Record<string, any>): Promise<Group>;
  /** Names by number. */
  actions(): Promise<Map<number, string>>;
  /** Names for bytes of the fields ram, by their indices, and tia, in their order. */
  names(): Promise<{ ram: Map<number, string>; tia: string[] }>;
  /** The colour of each value of a pixel, 0xAABBGGRR: what a Uint32Array over the bytes of an ImageData takes. */
  palette(): Promise<Uint32Array>;
  peek(index: number, count?: number): Promise<Uint8Array>;
  poke(index: number, bytes: Uint8Array | number[]): Promise<void>;
  /** episode: 1 for the score, the progress of the episode and the stack of screens, too; whole is its old name. */
  exportState(name: string, settings?: { episode?: 0 | 1 | boolean; whole?: 0 | 1 | boolean }): Promise<Uint8Array>;
  importState(name: string, bytes: Uint8Array): Promise<void>;
  /** Each list is played from the state. */
  branch(name: string, lists: Action[][], settings?: { keep?: string }): Promise<Branch[]>;
  /**
   * Saves a picture of the screen as a PNG file. In a browser, offers the file for download under this name.
   * machine: one of those of open, 0 the first
   */
  savePng(path: string, machine?: number): Promise<void>;
  stopRecording(): Promise<Group>;

  // generated: commands, from protocol/protocol.toml
  /**
   * The server's name, version and limits.
   * token: that the server requires
   */
  hello(token?: string | { token?: string }): Promise<Group>;
  /** List the games whose image is here, or all known games; or describe one. */
  games(which?: string): Promise<string[]>;
  /** The settings in effect. */
  settings(): Promise<Group>;
  /**
   * Change the mode, from the next reset on, or the difficulty, at once.
   * mode: see modes
   * difficulty: see difficulties
   */
  set(settings?: { mode?: number; difficulty?: number; }): Promise<Group>;
  /** The game's modes. */
  modes(): Promise<number[]>;
  /** The game's difficulties. */
  difficulties(): Promise<number[]>;
  /**
   * Select the fields of replies.
   * fields: without them, asks for the selection
   */
  observe(...fields: string[]): Promise<string[]>;
  /** Show these fields once; without fields, the selected ones. */
  look(...fields: string[]): Promise<Group>;
  /** Play actions until the episode ends. */
  act(...actions: Action[]): Promise<Group>;
  /**
   * Begin an episode; with a seed, power on anew with it.
   * seed: powers on anew with it
   */
  reset(seed?: number | "random" | { seed?: number | "random" }): Promise<Group>;
  /**
   * Save the state; generator=1: with the random generator.
   * generator: 1: with the random generator
   * machine: one of those of open, 0 the first
   */
  save(name: string, settings?: { generator?: 0 | 1 | boolean; machine?: number; random?: 0 | 1 | boolean; }): Promise<void>;
  /**
   * Restore a saved state.
   * machine: one of those of open, 0 the first
   */
  restore(name: string, machine?: number | { machine?: number }): Promise<Group>;
  /** Delete states. */
  drop(...names: string[]): Promise<void>;
  /** The names of the states. */
  states(): Promise<string[]>;
  /**
   * Create N machines with the loaded game and settings; their seeds count up.
   * autoreset: what happens at the end of an episode
   * steps: what a step is
   * start: how an episode begins; with steps=frames
   * life_loss: what a lost life does
   * stack: what a stack of screens begins with; with steps=frames
   * pool: which frames a stack shows; with steps=frames
   */
  open(count: number, settings?: {
    autoreset?: "next-step" | "disabled" | "same-step";
    steps?: "acts" | "frames";
    start?: "fire-noops" | "noops-fire" | "baselines" | "noops";
    life_loss?: "ignored" | "reported" | "end" | "restart";
    stack?: "zeros" | "repeats";
    pool?: 0 | 1 | boolean;
    lives?: "ignored" | "told" | "end" | "restart";
  }): Promise<Group[]>;
  /** Play one act on each machine: an action each, or one for all. */
  step(...actions: Action[]): Promise<Group[]>;
  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   * seed: powers on anew: machine 0 with N, machine 1 with N + 1, and so on
   */
  restart(mask?: string | Settings, seed?: number | "random" | { seed?: number | "random" }): Promise<Group[]>;
  /** Close the machines. */
  closeMachines(): Promise<void>;
  /**
   * Record frames, sound or both into the server's folder.
   * machine: one of those of open, 0 the first
   */
  record(kinds: string, name: string, machine?: number | { machine?: number }): Promise<Group>;
  /**
   * Log the episodes from the next reset on, so that anybody can verify them.
   * name: a name for the submission, or inline; last answers with the last log, and stop ends logging
   * agent: the agent's name (default: agent)
   * version: the agent's version (default: 1)
   * agent_seed: the agent's seed (default: 0)
   * trial: the number of the trial (default: 1)
   * training_frames: frames that the agent was trained on (default: 0)
   * phrase: the phrase that the episodes' seeds follow from, with _ for a blank
   * role: what the agent is
   * link: a page about the agent
   * machine: one of those of open, 0 the first
   */
  log(name: string, settings?: {
    agent?: string;
    version?: string;
    agent_seed?: number;
    trial?: number;
    training_frames?: number;
    phrase?: string;
    role?: "learner" | "planner" | "baseline";
    link?: string;
    machine?: number;
  }): Promise<Group>;
  /**
   * Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
   * name: a name for the file, without .png
   * machine: one of those of open, 0 the first
   */
  shot(name?: string | Settings, machine?: number | { machine?: number }): Promise<Group>;
  /**
   * Let other sessions watch the game under this name.
   * watchers: how many may watch at the same time
   */
  share(name: string, watchers?: number | { watchers?: number }): Promise<Group>;
  /** End what share has begun. */
  unshare(): Promise<void>;
  /** List the shared sessions. */
  shared(): Promise<Group[]>;
  /**
   * Show a shared session as it was lately.
   * since: the frame of the last reply; the fields come only if there is a newer one
   */
  watch(name: string, settings?: { since?: number; }, ...fields: string[]): Promise<Group>;
  /** Counters of this session. */
  stats(): Promise<Group>;
  /** End the session. */
  quit(): Promise<void>;
  // end of commands
}

/** A stack of the last screens, oldest first, with zeros before the first one. It is for observe("grey84x84x1:delta"). */
export class ScreenStack {
  constructor(depth: number);
  /** Begins anew, as after a reset. */
  clear(): void;
  /** Adds a screen. Returns the stack. */
  push(screen: Uint8Array): Uint8Array;
}

/** The server refused a request. */
export class RefusedError extends Error {
  /** A code of the protocol, such as "bad-action". */
  code: string;
}

/** The server is not there, has gone, or sent an invalid reply. */
export class LostError extends Error {}

/** The server did not answer in time. */
export class TimeoutError extends LostError {}

/** The encodings of fields. They throw a RangeError if the text has another form. */
export function hex(text: string): Uint8Array;
export function rle(text: string): Uint8Array;
export function base64(text: string): Uint8Array;
/** Not in a browser, where inflating takes a promise. */
export function zlib(text: string): Uint8Array;
/** Changes an array by a delta. */
export function applyDelta(array: Uint8Array, text: string): void;
