import { fillRandom, readBytes } from "#system";
import { LostError } from "../errors.js";
import { rawSize } from "../raw.js";

const encoder = new TextEncoder();
const NEWLINE = 10;
const NOT_SUPPORTED = 58; // as a result of WASI's functions; those of Emscripten return it negated

/** What racebeam.wasm needs of a system, and a result of success. All else fails with "not supported". */
const SYSTEM = {
  clock_time_get: (memory, clock, precision, at) => {
    new DataView(memory().buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
    return 0;
  },
  getentropy: (memory, at, size) => {
    fillRandom(memory().subarray(at, at + size));
    return 0;
  },
};

/** The imports of a module. memory: a function that returns the memory's bytes. */
function importsOf(module, memory) {
  const imports = {};
  for (const { module: space, name } of WebAssembly.Module.imports(module)) {
    const call = SYSTEM[name] ?? (() => (space === "env" ? -NOT_SUPPORTED : NOT_SUPPORTED));
    (imports[space] ??= {})[name] = (...values) => call(memory, ...values);
  }
  return imports;
}

/** racebeam.wasm of these bytes in this process. */
class Emulator {
  #exports;

  static async load(bytes) {
    const emulator = new Emulator();
    const module = await WebAssembly.compile(bytes);
    const { exports } = await WebAssembly.instantiate(module, importsOf(module, () => emulator.memory));
    emulator.#exports = exports;
    exports._initialize();
    return emulator;
  }

  /** The bytes of its memory, which moves when it grows. */
  get memory() {
    return new Uint8Array(this.#exports.memory.buffer);
  }

  get calls() {
    return this.#exports;
  }
}

/** A connection to a session in this process. A reply is there when send() returns. */
class LocalConnection {
  #emulator;
  #session;
  #receiver;

  constructor(emulator) {
    this.#emulator = emulator;
    this.#session = emulator.calls.open_session();
  }

  /** Gives each reply to `receiver`: reply(line, bytes), and lost(error) at the end. */
  listen(receiver) {
    this.#receiver = receiver;
  }

  /** Sends a line, or adds an image for all sessions: { image, gameFile }, each with its name and bytes. */
  send(request) {
    try {
      if (typeof request === "string") {
        this.#ask(request);
      } else {
        this.#add(request);
      }
      if (this.#emulator.calls.finished(this.#session)) {
        this.#receiver.lost(new LostError("the emulator closed the session"));
      }
    } catch (cause) {
      this.#receiver.lost(new LostError(`the emulator has failed: ${cause.message}`, { cause }));
    }
  }

  end() {
    this.#emulator.calls.close_session(this.#session);
    this.#session = 0;
  }

  #ask(line) {
    const { calls } = this.#emulator;
    for (let rest = encoder.encode(`${line}\n`); rest.length;) {
      const some = rest.subarray(0, calls.room(this.#session));
      this.#emulator.memory.set(some, calls.space(this.#session));
      this.#deliver(calls.run(this.#session, some.length));
      rest = rest.subarray(some.length);
    }
  }

  #add({ image, gameFile = { name: "", bytes: new Uint8Array() } }) {
    const { calls } = this.#emulator;
    const parts = [encoder.encode(image.name), image.bytes, encoder.encode(gameFile.name), gameFile.bytes];
    const sizes = parts.map((part) => part.length);
    let at = calls.file_space(sizes.reduce((sum, size) => sum + size));
    for (const part of parts) {
      this.#emulator.memory.set(part, at);
      at += part.length;
    }
    this.#deliver(calls.add_image(...sizes.slice(0, 3)));
  }

  /** Gives the receiver the replies, which have `size` bytes. */
  #deliver(size) {
    const at = this.#emulator.calls.replies();
    let replies = this.#emulator.memory.subarray(at, at + size);
    while (replies.length) {
      const end = replies.indexOf(NEWLINE);
      const line = new TextDecoder().decode(replies.subarray(0, end));
      const next = end + 1 + rawSize(line);
      this.#receiver.reply(line, replies.slice(end + 1, next));
      replies = replies.subarray(next);
    }
  }
}

const emulators = new Map(); // promises, by the addresses or the bytes that they are of

/** A connection to a new session. source: the address of racebeam.wasm, or its bytes, which are loaded once. */
export async function connectionTo(source) {
  if (!emulators.has(source)) {
    const bytes = typeof source === "string" ? readBytes(new URL(source)) : source;
    const loading = Promise.resolve(bytes).then(Emulator.load);
    emulators.set(source, loading);
    loading.catch(() => emulators.delete(source));
  }
  return new LocalConnection(await emulators.get(source));
}
