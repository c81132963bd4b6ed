/** The version of the protocol that this client speaks. */
export const PROTOCOL: 1;

/** A group of a reply. Numbers come as numbers, fields that are bytes as Uint8Array, the rest as strings. */
export type Group = Record<string, any>;

/** Such as { seed: 7, frame_skip: 4, preset: "dqn2015" }. */
export type Settings = Record<string, string | number>;

/** An action's name or number, with the marks of the protocol: "FIRE", 3, "UP*10", "5/LEFT@0.5". */
export type Action = string | number;

/** A branch's group: reward, acts, terminated, truncated, lives, and state with keep. */
export interface Branch extends Group {
  /** The reward of each act. */
  rewards: number[];
  /** Those of player B, where the game's rules have one. */
  rewards_b?: number[];
}

export interface Options {
  /** For servers that require one. */
  token?: string;
  /** Milliseconds to wait for a connection, and for each reply. Without it, for ever. */
  timeout?: number;
  /** Options of node:tls, such as { ca }. */
  tls?: import("node:tls").ConnectionOptions;
  /** The class WebSocket for ws:// and wss:// addresses, where the platform has none (Node before 22). */
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

/** A session of a server of its own, which ends with the session. Not in a browser. */
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
  /** Ends the session. More than once does nothing. */
  disconnect(): Promise<void>;
  [Symbol.asyncDispose](): Promise<void>;

  /** Any request: words, and objects that stand for settings. Returns the groups of the reply. */
  request(...parts: (Action | Settings | Action[])[]): Promise<Group[]>;

  hello(token?: string): Promise<Group>;
  help(...topic: string[]): Promise<string>;
  games(...which: string[]): Promise<string[]>;
  game(name: string): Promise<Group>;
  /** image: the bytes of a cartridge, if the game is "inline". */
  load(game: string, settings?: Settings & { image?: Uint8Array } | Record<string, any>): Promise<Group>;
  settings(): Promise<Group>;
  set(settings: { mode?: number; difficulty?: number }): Promise<Group>;
  modes(): Promise<number[]>;
  difficulties(): Promise<number[]>;
  /** Names by number. */
  actions(): Promise<Map<number, string>>;
  /** Names for bytes of the fields ram, by their indices, and tia, in their order. */
  names(): Promise<{ ram: Map<number, string>; tia: string[] }>;
  observe(...fields: string[]): Promise<string[]>;
  look(...fields: string[]): Promise<Group>;
  /** The colour of each value of a pixel, 0xAABBGGRR: what a Uint32Array over the bytes of an ImageData takes. */
  palette(): Promise<Uint32Array>;
  act(...actions: Action[]): Promise<Group>;
  reset(seed?: number): Promise<Group>;
  peek(index: number, count?: number): Promise<Uint8Array>;
  poke(index: number, bytes: Uint8Array | number[]): Promise<void>;
  save(name: string, settings?: { random?: 0 | 1 }): Promise<void>;
  restore(name: string): Promise<Group>;
  drop(...names: string[]): Promise<void>;
  states(): Promise<string[]>;
  exportState(name: string): Promise<Uint8Array>;
  importState(name: string, bytes: Uint8Array): Promise<void>;
  /** Each list is played from the state. */
  branch(name: string, lists: Action[][], settings?: { keep?: string }): Promise<Branch[]>;
  open(count: number, settings?: Settings): Promise<Group[]>;
  step(...actions: Action[]): Promise<Group[]>;
  /** A mask such as "0110", settings such as { seed: 9 }, or both. */
  restart(...maskAndSettings: (string | Settings)[]): Promise<Group[]>;
  /** Gives the machines of open() back: the command close. */
  closeMachines(): Promise<void>;
  record(kinds: string, name: string, settings?: { machine?: number }): Promise<Group>;
  stopRecording(): Promise<Group>;
  /** Lets other sessions watch this one under a name. */
  share(name: string, settings?: { watchers?: number }): Promise<Group>;
  unshare(): Promise<void>;
  /** The sessions that can be watched. */
  shared(): Promise<Group[]>;
  /** A shared session as it was lately, with fields such as "screen:rle"; since: the frame of the last reply. */
  watch(name: string, settings?: { since?: number }, ...fields: string[]): Promise<Group>;
  stats(): Promise<Group>;
  quit(): Promise<void>;
}

/** The last screens, oldest first, zeros where there was none. For observe("grey84:delta"). */
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

/** The server is not there, has gone, or sent what is no reply. */
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
