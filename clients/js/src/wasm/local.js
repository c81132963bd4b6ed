import { fillRandom, readBytes } from "#system";
import { LostError } from "../errors.js";
import { rawSize } from "../raw.js";

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

  send(line) {
    try {
      for (let rest = new TextEncoder().encode(`${line}\n`); rest.length;) {
        rest = this.#take(rest);
      }
      if (this.#emulator.calls.finished(this.#session)) {
        this.#receiver.lost(new LostError("the session has ended"));
      }
    } catch (cause) {
      this.#receiver.lost(new LostError(`the emulator has failed: ${cause.message}`, { cause }));
    }
  }

  end() {
    this.#emulator.calls.close_session(this.#session);
    this.#session = 0;
  }

  /** Takes bytes of a request, and gives the replies to the receiver. Returns the bytes that are left. */
  #take(bytes) {
    const { calls } = this.#emulator;
    const some = bytes.subarray(0, calls.room(this.#session));
    this.#emulator.memory.set(some, calls.space(this.#session));
    const size = calls.run(this.#session, some.length);
    const at = calls.replies();
    this.#deliver(this.#emulator.memory.subarray(at, at + size));
    return bytes.subarray(some.length);
  }

  #deliver(replies) {
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
