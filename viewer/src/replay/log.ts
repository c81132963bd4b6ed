// Logs of episodes: docs/episodes.md describes the file.

import { JOYSTICK_ACTIONS, LAST_CONTROLLER_ACTION } from "../input/actions.js";

export interface Episode {
  /** For people. */
  title: string;
  game: string;
  /** The settings of `load`, without the game. */
  settings: Readonly<Record<string, string>>;
  /** Words of `act`, in order. */
  acts: readonly string[];
  /** What the log says of its end. An episode of this page lacks it. */
  ended?: { score: number; frames: number; decisions: number; end: string; lives: number };
  /** Hashes of the machine's state, in hexadecimal digits: after every HASH_EVERY decisions, and at the end. */
  hashes?: readonly string[];
  md5?: string;
}

const MAGIC = "RBEPISOD";
const VERSION = 1;
const HEADER = 24; // bytes before the contents
const LARGEST = 2 * 1024 * 1024; // bytes, of the file and of its contents
export const HASH_EVERY = 256; // decisions
const HASH_SIZE = 8;
const STRENGTH_SIZE = 4;
const OLD_WORDS: Readonly<Record<string, string>> = { life_loss_ends: "0", autoreset: "0" }; // of logs, with the values that are usual

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; ++bit) {
    crc = crc & 1 ? 0xedb88320 ^ (crc >>> 1) : crc >>> 1;
  }
  return crc;
});

/** The CRC-32 of some pieces in a row. */
export function crc32(...pieces: Uint8Array[]): number {
  let crc = 0xffffffff;
  for (const piece of pieces) {
    for (const byte of piece) {
      crc = CRC_TABLE[(crc ^ byte) & 0xff]! ^ (crc >>> 8);
    }
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/** Inflates a zlib stream. Throws if there are more than `most`. */
export async function inflate(bytes: Uint8Array, most = LARGEST): Promise<Uint8Array> {
  const reader = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  const pieces: Uint8Array[] = [];
  let size = 0;
  for (let { done, value } = await reader.read(); !done; { done, value } = await reader.read()) {
    pieces.push(value!);
    size += value!.length;
    if (size > most) {
      await reader.cancel();
      throw new Error(`the log has more than ${most} bytes of contents`);
    }
  }
  const whole = new Uint8Array(size);
  pieces.reduce((at, piece) => (whole.set(piece, at), at + piece.length), 0);
  return whole;
}

/** Checks the seal of a log. Returns the contents that it protects. */
async function unseal(file: Uint8Array): Promise<Uint8Array> {
  if (file.length > LARGEST) {
    throw new Error(`the file has ${file.length} bytes; a log has at most ${LARGEST}`);
  }
  const magic = new TextDecoder("latin1").decode(file.subarray(0, MAGIC.length));
  if (magic !== MAGIC || file.length < HEADER) {
    throw new Error("the file is not a log of an episode");
  }
  const header = new DataView(file.buffer, file.byteOffset, HEADER);
  if (header.getUint32(8, true) !== VERSION) {
    throw new Error(`the log has version ${header.getUint32(8, true)}; this page reads version ${VERSION}`);
  }
  const packed = file.subarray(HEADER);
  if (header.getUint32(20, true) !== crc32(file.subarray(0, 20), packed)) {
    throw new Error("the log was altered or cut off: its checksum does not fit");
  }
  const contents = await inflate(packed);
  if (contents.length !== Number(header.getBigUint64(12, true))) {
    throw new Error("the log was altered: the size of its contents does not fit");
  }
  return contents;
}

/** The pairs KEY=VALUE among the words of a line. */
function pairs(words: readonly string[]): Record<string, string> {
  return Object.fromEntries(words.filter((word) => word.includes("=")).map((word) => {
    const equals = word.indexOf("=");
    return [word.slice(0, equals), word.slice(equals + 1)];
  }));
}

/** Settings without old words that change nothing, of which a server warns. */
function newWords(settings: Record<string, string>): Record<string, string> {
  return Object.fromEntries(Object.entries(settings).filter(([key, value]) => OLD_WORDS[key] !== value));
}

/** The digits of hashes, whose lowest byte comes first. */
function digits(hashes: Uint8Array): string[] {
  return Array.from({ length: hashes.length / HASH_SIZE }, (_, number) => hexOf(hashes.slice(number * HASH_SIZE, (number + 1) * HASH_SIZE).reverse()));
}

/** Bytes in hexadecimal digits. */
export function hexOf(bytes: Uint8Array): string {
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** The words of `act`. Without strengths, all are 1. */
function words(actions: Uint8Array, strengths: Uint8Array): string[] {
  const view = new DataView(strengths.buffer, strengths.byteOffset, strengths.length);
  return Array.from(actions, (action, number) => {
    const strength = strengths.length === 0 ? 1 : view.getFloat32(STRENGTH_SIZE * number, true);
    return strength === 1 ? String(action) : `${action}@${strength}`;
  });
}

/** The end of the lines of text: the place after the empty line. */
function endOfText(contents: Uint8Array): number {
  for (let at = 1; at < contents.length; ++at) {
    if (contents[at] === 10 && contents[at - 1] === 10) {
      return at + 1;
    }
  }
  throw new Error("the log has no empty line after its text");
}

/** Reads a log. Throws an Error with a sentence if the file is not a log. */
export async function readLog(file: Uint8Array, name: string): Promise<Episode> {
  const contents = await unseal(file);
  const start = endOfText(contents);
  const lines = new TextDecoder().decode(contents.subarray(0, start)).split("\n").map((line) => line.split(" "));
  const [load = [], image = [], from = [], ended = []] = lines;
  if (load[0] !== "load" || !load[1] || image[0] !== "image" || from[0] !== "from" || ended[0] !== "ended") {
    throw new Error("the log's text does not begin with load, image, from and ended");
  }
  const settings = newWords(pairs(load.slice(2)));
  const lastAction = settings.action_set === "console" ? LAST_CONTROLLER_ACTION : JOYSTICK_ACTIONS - 1;
  const { score, frames, decisions, end = "", lives } = pairs(ended);
  const hashes = contents.subarray(start, start + HASH_SIZE * (Math.floor(Number(decisions) / HASH_EVERY) + 1));
  const actions = contents.subarray(start + hashes.length, start + hashes.length + Number(decisions));
  const strengths = contents.subarray(start + hashes.length + actions.length);
  if (![0, STRENGTH_SIZE * actions.length].includes(strengths.length)) {
    throw new Error(`the log has ${strengths.length} bytes of strengths; accepted: 0, or ${STRENGTH_SIZE} for each action`);
  }
  if (actions.length !== Number(decisions) || actions.some((action) => action > lastAction)) {
    throw new Error(`the log has ${actions.length} actions; its text says ${decisions}, from 0 to ${lastAction}`);
  }
  return {
    title: pairs(from).unit ? `${pairs(from).unit}, episode ${pairs(from).episode}` : name,
    game: load[1],
    settings,
    acts: words(actions, strengths),
    ended: { score: Number(score), frames: Number(frames), decisions: Number(decisions), end, lives: Number(lives) },
    hashes: digits(hashes),
    ...(image[1] ? { md5: image[1] } : {}),
  };
}
