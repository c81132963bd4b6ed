/** The version of the protocol that this client speaks. */
export const PROTOCOL: 1;

/** A group of a reply. Numbers come as numbers, fields that are bytes as Uint8Array, the rest as strings. */
export type Group = Record<string, any>;

/** Settings of a request, such as { seed: 7, frame_skip: 4, preset: "dqn2015" }. */
export type Settings = Record<string, string | number | boolean>;

/** Settings of load. */
export interface LoadSettings {
  /** The bytes of a cartridge, if the game is "inline". */
  image?: Uint8Array;
  /** With image: the game whose rules apply. It is one of the catalogue, or of an available image. */
  as?: string;
  // generated: settings, from protocol/protocol.toml
  /** A set of settings from the literature; other keys override it. Default: none. */
  preset?: "none" | "paper2013" | "dqn2015" | "machado2018" | "gym-v5";
  /**
   * Seed of everything that is random in play; random: the server chooses one. Accepted: random, or 1 to
   * 4294967295. Default: random.
   */
  seed?: number | "random";
  /** Seed of the memory's contents at power-on. Accepted: 0 to 4294967295. Default: 4753849. */
  system_seed?: number;
  /**
   * Frames of an act; with a range, each act draws its number from it. Accepted: 1 to 1000, or a range such
   * as 2-4. Default: 1.
   */
  frame_skip?: number | string;
  /** Probability that a frame repeats the previous action. Accepted: 0 to 1. Default: 0.25. */
  sticky?: number;
  /** Variation of the game. Accepted: see `modes`. Default: the game's. */
  mode?: number;
  /** Difficulty switches. Accepted: see `difficulties`. Default: 0. */
  difficulty?: number;
  /** Frames after which an episode is truncated; 0: never. Accepted: 0 to 2147483647. Default: 108000. */
  max_episode_frames?: number;
  /** What a lost life does. Default: ignored. */
  life_loss?: "ignored" | "reported" | "end" | "restart";
  /**
   * An episode begins with 0 to noop_max - 1 frames of NOOP, drawn by seed. Accepted: 0 to 1000. Default: 0.
   */
  noop_max?: number;
  /** What happens at the end of an episode. Default: disabled. */
  autoreset?: "disabled" | "next-step" | "same-step";
  /** The actions that `act` accepts. Default: full. */
  action_set?: "full" | "legal" | "minimal" | "console";
  /** An act's reward is clamped to at least this. Accepted: none or a whole number. Default: none. */
  reward_min?: number | string;
  /** An act's reward is clamped to at most this. Accepted: none or a whole number. Default: none. */
  reward_max?: number | string;
  /** Rules of score and end: those of the reference, or corrected ones. Default: ale-0.12. */
  rules?: "ale-0.12" | "fixed";
  /** Blend each screen with the one before it. Accepted: 0 or 1. Default: 0. */
  color_averaging?: 0 | 1 | boolean;
  /** Generate the samples of the field audio. Accepted: 0 or 1. Default: 0. */
  sound?: 0 | 1 | boolean;
  /**
   * How the cartridge switches its banks; auto detects it. Accepted: auto or a scheme's name, with _ for a
   * blank. Default: the game's, else auto.
   */
  scheme?: string;
  /** Controller in the left port. Default: the game's, else joystick. */
  left?:
    | "joystick"
    | "paddles"
    | "keyboard"
    | "driving"
    | "booster"
    | "genesis"
    | "light_gun"
    | "trackball"
    | "atari_mouse"
    | "amiga_mouse"
    | "savekey"
    | "none";
  /** Controller in the right port. Default: the game's, else joystick. */
  right?:
    | "joystick"
    | "paddles"
    | "keyboard"
    | "driving"
    | "booster"
    | "genesis"
    | "light_gun"
    | "trackball"
    | "atari_mouse"
    | "amiga_mouse"
    | "savekey"
    | "none";
  /** Television standard; auto detects it. Default: the game's, else auto. */
  format?: "auto" | "ntsc" | "pal" | "pal60" | "secam";
  /** First line of the picture. Accepted: 0 to 50. Default: the game's, else 34. */
  ystart?: number;
  /**
   * Lines of the picture, 200 at least; with PAL and SECAM, 210 means 250. Accepted: 100 to 256. Default: the
   * game's, else 210.
   */
  height?: number;
  // end of settings
}

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
  /** Milliseconds to wait for a connection, and for each reply. Default: no limit. */
  timeout?: number;
  /** Options of node:tls, such as { ca }. */
  tls?: import("node:tls").ConnectionOptions;
  /** The class WebSocket for ws:// and wss:// addresses, if the platform lacks it (Node before 22). */
  WebSocket?: unknown;
  /** The most bytes of a line of a reply. A longer line ends the session. */
  longestReply?: number;
}

/**
 * Opens a session with the server at an address: tcp://HOST:PORT, tls://HOST:PORT, ws://HOST:PORT, wss://HOST:PORT, unix:PATH, pipes:PREFIX
 * (named pipes), stdio (the streams of this process) or file:PATH (the first address in the server's ready file or announce file,
 * with the token of the latter; file:PATH?wait=SECONDS waits for the server). Default: the address in the environment variable RACEBEAM_ADDRESS.
 *
 * In a browser: ws://HOST:PORT or wss://HOST:PORT; without an address, the server that the page came from.
 */
export function connect(address?: string, options?: Options): Promise<Session>;

/** Starts a server, and opens a session with it. The server stops when the session ends. Not in a browser. */
export function launch(settings?: {
  /** The path of the program racebeam. Default: that of RACEBEAM_PROGRAM, else the one on the PATH. */
  program?: string;
  /** Options of `racebeam serve`, such as ["--roms", DIR]. */
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

  /** Sends any request: words, and objects that stand for settings. Returns the groups of the reply. */
  request(...parts: (Action | Settings | Action[])[]): Promise<Group[]>;

  /** Explain a command, setting, field, preset, encoding or error code, as a text for people. */
  help(...topic: string[]): Promise<string>;
  /** Describe a game. */
  game(name: string): Promise<Group>;
  /**
   * Power on with an image and begin an episode. Returns the settings in effect.
   * @param game its name, the MD5 of its image, or "inline" for settings.image
   */
  load(game: string, settings?: LoadSettings | Settings): Promise<Group>;
  /** List the actions that act accepts. Returns their names by number. */
  actions(): Promise<Map<number, string>>;
  /** Name bytes of the fields ram, by their indices, and tia, in their order. */
  names(): Promise<{ ram: Map<number, string>; tia: string[] }>;
  /** The colour of each value of a pixel, 0xAABBGGRR: what a Uint32Array over the bytes of an ImageData takes. */
  palette(): Promise<Uint32Array>;
  /**
   * Read bytes of RAM.
   * @param index the index of the first byte, 0 to 127
   * @param count the number of bytes, by default 1
   */
  peek(index: number, count?: number): Promise<Uint8Array>;
  /**
   * Write bytes of RAM.
   * @param index the index of the first byte, 0 to 127
   */
  poke(index: number, bytes: Uint8Array | number[]): Promise<void>;
  /**
   * Export a state, for later or for another process.
   * @param settings.episode whether to include the score, the progress of the episode and the stack of screens
   * @param settings.whole the old name of episode
   */
  exportState(name: string, settings?: { episode?: 0 | 1 | boolean; whole?: 0 | 1 | boolean }): Promise<Uint8Array>;
  /** Save an exported state under a name. */
  importState(name: string, bytes: Uint8Array): Promise<void>;
  /**
   * Play lists of actions from a state; the session itself does not change.
   * @param settings.keep the prefix of names under which the states at the ends of the lists are saved
   */
  branch(name: string, lists: Action[][], settings?: { keep?: string }): Promise<Branch[]>;
  /**
   * Save a picture of the screen as a PNG file. In a browser, offer the file for download under this name.
   * @param machine the index of a machine of open, from 0
   */
  savePng(path: string, machine?: number): Promise<void>;
  /** End the recording. Returns what was kept. */
  stopRecording(): Promise<Group>;

  // generated: commands, from protocol/protocol.toml
  /**
   * Greet the server; the reply has its name, version and limits.
   * @param token a token that the server accepts
   */
  hello(token?: string | { token?: string }): Promise<Group>;
  /**
   * List the games whose image is here, or all known games; or describe one.
   * @param which all for all known games, or the name of a game to describe
   */
  games(which?: string): Promise<string[]>;
  /** Show the settings in effect. */
  settings(): Promise<Group>;
  /**
   * Change the mode, from the next reset on, or the difficulty, at once.
   * @param settings.mode a number that modes lists
   * @param settings.difficulty a number that difficulties lists
   */
  set(settings?: { mode?: number; difficulty?: number; }): Promise<Group>;
  /** List the game's modes. */
  modes(): Promise<number[]>;
  /** List the game's difficulties. */
  difficulties(): Promise<number[]>;
  /**
   * Select the fields of replies.
   * @param fields the fields, such as lives or screen:rle, or none; without them, the selection does not
   *     change
   */
  observe(...fields: string[]): Promise<string[]>;
  /**
   * Show these fields once; without fields, the selected ones.
   * @param fields the fields, such as lives or screen:rle
   */
  look(...fields: string[]): Promise<Group>;
  /**
   * Play actions until the episode ends.
   * @param actions names or numbers of actions, also with marks, such as RIGHT*10
   */
  act(...actions: Action[]): Promise<Group>;
  /**
   * Begin an episode; with a seed, power on anew with it.
   * @param seed the seed with which the console is powered on anew, or random
   */
  reset(seed?: number | "random" | { seed?: number | "random" }): Promise<Group>;
  /**
   * Save the state; generator=1: with the random generator.
   * @param name a name for the state
   * @param settings.generator 1: the state includes the random generator
   * @param settings.machine the index of a machine of open, from 0
   */
  save(name: string, settings?: { generator?: 0 | 1 | boolean; machine?: number; random?: 0 | 1 | boolean; }): Promise<void>;
  /**
   * Restore a saved state.
   * @param name the name of the state
   * @param machine the index of a machine of open, from 0
   */
  restore(name: string, machine?: number | { machine?: number }): Promise<Group>;
  /**
   * Delete states.
   * @param names the names of the states, or all
   */
  drop(...names: string[]): Promise<void>;
  /** List the names of the states. */
  states(): Promise<string[]>;
  /**
   * Create N machines with the loaded game and settings; their seeds count up.
   * @param count the number of machines
   * @param settings.autoreset what happens at the end of an episode
   * @param settings.steps what a step is
   * @param settings.start how an episode begins; requires steps=frames
   * @param settings.life_loss what a lost life does
   * @param settings.stack what a stack of screens begins with; requires steps=frames
   * @param settings.pool which frames a stack shows; requires steps=frames
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
  /**
   * Play one act on each machine: an action each, or one for all.
   * @param actions an action for each machine, or one for all
   */
  step(...actions: Action[]): Promise<Group[]>;
  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   * @param mask a 0 or a 1 for each machine, such as 0110
   * @param seed the seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on
   */
  restart(mask?: string | Settings, seed?: number | "random" | { seed?: number | "random" }): Promise<Group[]>;
  /** Close the machines. */
  closeMachines(): Promise<void>;
  /**
   * Record frames, sound or both into the server's folder.
   * @param kinds the kinds of files, separated by commas, such as gif,wav
   * @param name a name for the files, without an extension
   * @param machine the index of a machine of open, from 0
   */
  record(kinds: string, name: string, machine?: number | { machine?: number }): Promise<Group>;
  /**
   * Log the episodes from the next reset on, so that anybody can verify them.
   * @param name a name for the submission, or inline; last answers with the last log, and stop ends logging
   * @param settings.agent the agent's name (default: agent)
   * @param settings.version the agent's version (default: 1)
   * @param settings.agent_seed the agent's seed (default: 0)
   * @param settings.trial the number of the trial (default: 1)
   * @param settings.training_frames frames that the agent was trained on (default: 0)
   * @param settings.phrase the phrase that the episodes' seeds follow from, with _ for a blank
   * @param settings.role what the agent is
   * @param settings.link a page about the agent
   * @param settings.machine the index of a machine of open, from 0
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
   * @param name a name for the file, without .png
   * @param machine the index of a machine of open, from 0
   */
  shot(name?: string | Settings, machine?: number | { machine?: number }): Promise<Group>;
  /**
   * Let other sessions watch the game under this name.
   * @param name a name for the shared session
   * @param watchers the most sessions that may watch at the same time
   */
  share(name: string, watchers?: number | { watchers?: number }): Promise<Group>;
  /** Stop sharing the game. */
  unshare(): Promise<void>;
  /** List the shared sessions. */
  shared(): Promise<Group[]>;
  /**
   * Show the latest copy of a shared session.
   * @param name the name of the shared session
   * @param settings.since the frame of the last reply; the fields come only if there is a newer one
   * @param fields fields among screen, ram and palette, such as screen:delta
   */
  watch(name: string, settings?: { since?: number; }, ...fields: string[]): Promise<Group>;
  /** Show counters of this session. */
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

// Decoders of fields. Each throws a RangeError if the text has another form.

/** Decodes two digits a byte. */
export function hex(text: string): Uint8Array;
/** Decodes runs: value and length. */
export function rle(text: string): Uint8Array;
/** Decodes base64. */
export function base64(text: string): Uint8Array;
/** Decodes zlib in base64. Not in a browser, where decompression is asynchronous. */
export function zlib(text: string): Uint8Array;
/** Changes an array by a delta. */
export function applyDelta(array: Uint8Array, text: string): void;
