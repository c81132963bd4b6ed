import { saveFile, toBase64 } from "#platform";
import { Commands } from "./commands.js";
import { base64, hex, rewards } from "./decode.js";
import { LostError, printable, RefusedError } from "./errors.js";
import { Fields } from "./fields.js";
import { Lines } from "./lines.js";
import { keyed, list, words } from "./words.js";

const isByte = (value) => Number.isInteger(value) && value >= 0 && value <= 255;

function toHex(bytes) {
  if (!(Array.isArray(bytes) || ArrayBuffer.isView(bytes)) || !Array.from(bytes).every(isByte)) {
    throw new TypeError(`the bytes are '${bytes}'; they must be a Uint8Array, or an array of numbers from 0 to 255`);
  }
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("").toUpperCase();
}

/** A word for each list of actions. */
function wordsOfLists(lists) {
  if (!Array.isArray(lists) || !lists.every(Array.isArray)) {
    throw new TypeError(`the lists are '${lists}'; branch takes an array of arrays of actions, such as [["FIRE", "UP"]]`);
  }
  return lists.map((actions) => actions.join(","));
}

/** Returns the groups, or a promise of them if values are still to be decoded. */
function settle(groups) {
  const waiting = [];
  for (const group of groups) {
    for (const key in group) {
      if (group[key] instanceof Promise) {
        waiting.push(group[key].then((value) => (group[key] = value)));
      }
    }
  }
  return waiting.length ? Promise.all(waiting).then(() => groups) : groups;
}

/** A map from pairs NUMBER:NAME. */
function namesByNumber(pairs) {
  return new Map(pairs.map((pair) => pair.split(":")).map(([number, name]) => [Number(number), name]));
}

/** The value of a key as it was sent. */
function text(line, key) {
  return new RegExp(` ${key}=(\\S*)`).exec(line)[1];
}

/** One session, with a method for each command. */
export class Session extends Commands {
  #lines;
  #fields = new Fields();

  constructor(connection, { timeout, longestReply = 2 ** 28 } = {}) {
    super();
    this.#lines = new Lines(connection, { timeout, longestReply });
  }

  get ended() {
    return this.#lines.lost;
  }

  async disconnect() {
    await this.#lines.end();
  }

  async [Symbol.asyncDispose ?? Symbol.for("Symbol.asyncDispose")]() {
    await this.disconnect();
  }

  async request(...parts) {
    return (await this.#ask(words(...parts))).groups;
  }

  async #ask(line) {
    if (line.includes("\n") || /^ *#/.test(line)) {
      throw new TypeError(`a request is one line, and no comment: '${line}'`);
    }
    return this.#parse(line, await this.#lines.ask(line));
  }

  /** Parses the reply to a request. Throws a RefusedError, or ends the session with a LostError. */
  async #parse(request, { line, bytes }) {
    const refused = /^error (\S+) ?(.*)$/.exec(line);
    if (refused) {
      throw new RefusedError(refused[1], refused[2]);
    }
    try {
      if (line !== "ok" && !line.startsWith("ok ")) {
        throw new RangeError(`'${line.slice(0, 60)}' is not a reply`);
      }
      return { groups: await settle(this.#fields.groups(request, line, bytes)), line };
    } catch (cause) {
      const error = new LostError(`the server sent an invalid reply: ${printable(cause.message)}`, { cause });
      this.#lines.end(error);
      throw error;
    }
  }

  async #first(...parts) {
    return (await this.request(...parts))[0];
  }

  async #text(key, ...parts) {
    return text((await this.#ask(words(...parts))).line, key);
  }

  async #list(key, ...parts) {
    return list(await this.#text(key, ...parts));
  }

  // Commands that need more than their words

  async help(...topic) {
    return (await this.#ask(words("help", ...topic))).line.slice(3);
  }

  game(name) {
    return this.#first("games", name);
  }

  load(game, { image, ...settings } = {}) {
    return this.#first("load", game, image ? { image: toBase64(image) } : [], settings);
  }

  async actions() {
    return namesByNumber(await this.#list("actions", "actions"));
  }

  async names() {
    const { ram_names: ram, tia_names: tia } = await this.#first("names");
    return { ram: namesByNumber(list(ram)), tia: list(tia) };
  }

  async palette() {
    const { palette } = await this.look("palette");
    return new Uint32Array(256).map((_, value) => (0xff000000 | (palette[3 * value + 2] << 16) | (palette[3 * value + 1] << 8)
      | palette[3 * value]) >>> 0);
  }

  async peek(index, count = 1) {
    return hex(await this.#text("bytes", "peek", index, count));
  }

  async poke(index, bytes) {
    await this.request("poke", index, toHex(bytes));
  }

  async exportState(name, settings = {}) {
    return base64(await this.#text("data", "export", name, settings));
  }

  async importState(name, bytes) {
    await this.request("import", name, toBase64(bytes));
  }

  async branch(name, lists, settings = {}) {
    const branches = (await this.request("branch", name, settings, wordsOfLists(lists))).slice(1);
    for (const branch of branches) {
      branch.rewards = rewards(branch.rewards);
      if ("rewards_b" in branch) {
        branch.rewards_b = rewards(branch.rewards_b);
      }
    }
    return branches;
  }

  async savePng(path, machine) {
    await saveFile(path, base64(await this.#text("data", "shot", keyed("machine", machine))));
  }

  stopRecording() {
    return this.#first("record", "stop");
  }
}
