import { toBase64 } from "#platform";
import { base64, hex, rewards } from "./decode.js";
import { LostError, printable, RefusedError } from "./errors.js";
import { Fields } from "./fields.js";
import { Lines } from "./lines.js";

function words(...parts) {
  return parts.flat().map((part) => (typeof part === "object" ? pairs(part) : String(part))).filter(Boolean).join(" ");
}

function pairs(settings) {
  return Object.entries(settings).map(([key, value]) => `${key}=${value}`).join(" ");
}

function list(value) {
  return value === "" ? [] : String(value).split(",");
}

function toHex(bytes) {
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("").toUpperCase();
}

/** The groups, or a promise of them if values are still to be decoded. */
function settled(groups) {
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

/** The value of a key as it was sent. */
function text(line, key) {
  return new RegExp(` ${key}=(\\S*)`).exec(line)[1];
}

/** One session, with a method for each command. */
export class Session {
  #lines;
  #fields = new Fields();

  constructor(connection, { timeout, longestReply = 2 ** 28 } = {}) {
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
    return this.#understood(line, await this.#lines.ask(line));
  }

  async #understood(request, { line, bytes }) {
    const refused = /^error (\S+) ?(.*)$/.exec(line);
    if (refused) {
      throw new RefusedError(refused[1], refused[2]);
    }
    try {
      if (line !== "ok" && !line.startsWith("ok ")) {
        throw new RangeError(`'${line.slice(0, 60)}' is no reply`);
      }
      return { groups: await settled(this.#fields.groups(request, line, bytes)), line };
    } catch (cause) {
      const error = new LostError(`the server sent what is no reply: ${printable(cause.message)}`, { cause });
      this.#lines.end(error);
      throw error;
    }
  }

  async #first(...parts) {
    return (await this.request(...parts))[0];
  }

  async #rest(...parts) {
    return (await this.request(...parts)).slice(1);
  }

  async #text(key, ...parts) {
    return text((await this.#ask(words(...parts))).line, key);
  }

  async #list(key, ...parts) {
    return list(await this.#text(key, ...parts));
  }

  // Commands

  hello(token) {
    return this.#first("hello", token ? { token } : []);
  }

  async help(...topic) {
    return (await this.#ask(words("help", ...topic))).line.slice(3);
  }

  games(...which) {
    return this.#list("games", "games", ...which);
  }

  game(name) {
    return this.#first("games", name);
  }

  load(game, { image, ...settings } = {}) {
    return this.#first("load", game, image ? { image: toBase64(image) } : [], settings);
  }

  settings() {
    return this.#first("settings");
  }

  set(settings) {
    return this.#first("set", settings);
  }

  async modes() {
    return (await this.#list("modes", "modes")).map(Number);
  }

  async difficulties() {
    return (await this.#list("difficulties", "difficulties")).map(Number);
  }

  async actions() {
    const named = (await this.#list("actions", "actions")).map((pair) => pair.split(":"));
    return new Map(named.map(([number, name]) => [Number(number), name]));
  }

  async names() {
    const { ram_names: ram, tia_names: tia } = await this.#first("names");
    const named = list(ram).map((pair) => pair.split(":"));
    return { ram: new Map(named.map(([index, name]) => [Number(index), name])), tia: list(tia) };
  }

  observe(...fields) {
    return this.#list("fields", "observe", ...fields);
  }

  look(...fields) {
    return this.#first("look", ...fields);
  }

  async palette() {
    const { palette } = await this.look("palette");
    return new Uint32Array(256).map((_, value) => (0xff000000 | (palette[3 * value + 2] << 16) | (palette[3 * value + 1] << 8)
      | palette[3 * value]) >>> 0);
  }

  act(...actions) {
    return this.#first("act", ...actions);
  }

  reset(seed) {
    return this.#first("reset", seed === undefined ? [] : { seed });
  }

  async peek(index, count = 1) {
    return hex(await this.#text("bytes", "peek", index, count));
  }

  async poke(index, bytes) {
    await this.request("poke", index, toHex(bytes));
  }

  async save(name, settings = {}) {
    await this.request("save", name, settings);
  }

  restore(name) {
    return this.#first("restore", name);
  }

  async drop(...names) {
    await this.request("drop", ...names);
  }

  states() {
    return this.#list("states", "states");
  }

  async exportState(name) {
    return base64(await this.#text("data", "export", name));
  }

  async importState(name, bytes) {
    await this.request("import", name, toBase64(bytes));
  }

  async branch(name, lists, settings = {}) {
    const branches = await this.#rest("branch", name, settings, lists.map((actions) => actions.join(",")));
    for (const branch of branches) {
      branch.rewards = rewards(branch.rewards);
      if ("rewards_b" in branch) {
        branch.rewards_b = rewards(branch.rewards_b);
      }
    }
    return branches;
  }

  open(count, settings = {}) {
    return this.#rest("open", count, settings);
  }

  step(...actions) {
    return this.#rest("step", ...actions);
  }

  restart(...maskAndSettings) {
    return this.#rest("restart", ...maskAndSettings);
  }

  async closeMachines() {
    await this.request("close");
  }

  record(kinds, name, settings = {}) {
    return this.#first("record", kinds, name, settings);
  }

  stopRecording() {
    return this.#first("record", "stop");
  }

  share(name, settings = {}) {
    return this.#first("share", name, settings);
  }

  async unshare() {
    await this.request("unshare");
  }

  shared() {
    return this.#rest("shared");
  }

  watch(name, settings = {}, ...fields) {
    return this.#first("watch", name, settings, ...fields);
  }

  stats() {
    return this.#first("stats");
  }

  async quit() {
    await this.request("quit");
  }
}
