// Sessions in this process, as WebAssembly: games without a server. index.d.ts describes them.

import { startWorker } from "#system";
import { RefusedError } from "../errors.js";
import { greet } from "../greeting.js";
import { Lines } from "../lines.js";
import { connectionTo } from "./local.js";
import { PortConnection } from "./port.js";

const NAME = "racebeam.wasm";
const LARGEST_FILE = 2 ** 24; // bytes: the program reads no larger ones

/** An address as text, or bytes as they are. */
function plain(source = new URL(NAME, import.meta.url)) {
  return source instanceof URL ? source.href : source;
}

/** A file's name and bytes. */
async function contents(file) {
  if (file.size > LARGEST_FILE) {
    throw new RefusedError("bad-image", `${file.name}: larger than ${LARGEST_FILE} bytes`);
  }
  return { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) };
}

/** Adds an image over a new connection, which ends. */
async function add(connection, file, gameFile) {
  const lines = new Lines(connection, {});
  try {
    const { line } = await lines.ask({ image: await contents(file), ...(gameFile ? { gameFile: await contents(gameFile) } : {}) });
    const [, code, sentence] = /^error (\S+) (.*)$/.exec(line) ?? [];
    if (code) {
      throw new RefusedError(code, sentence);
    }
    const [, md5, game] = /^ok md5=(\S+) game=(\S+)$/.exec(line);
    return { md5, game };
  } finally {
    await lines.end();
  }
}

export async function addImage(file, { source, gameFile } = {}) {
  return add(await connectionTo(plain(source)), file, gameFile);
}

export async function open({ source, ...options } = {}) {
  return greet(await connectionTo(plain(source)), NAME, options);
}

/** Starts a worker for any number of sessions. */
export class EmulatorWorker {
  #worker;
  #fail;
  #failed = new Promise((_, reject) => (this.#fail = reject));

  constructor({ source, script = new URL("worker.js", import.meta.url) } = {}) {
    this.#failed.catch(() => {}); // each session tells
    this.#worker = startWorker(script, this.#fail);
    this.#worker.postMessage({ source: plain(source) });
  }

  open(options = {}) {
    return greet(this.#connect(), NAME, options);
  }

  addImage(file, { gameFile } = {}) {
    return add(this.#connect(), file, gameFile);
  }

  #connect() {
    const { port1, port2 } = new MessageChannel();
    this.#worker.postMessage({ port: port2 }, [port2]);
    return new PortConnection(port1, this.#failed);
  }

  end() {
    this.#worker.terminate();
    this.#fail(new Error("it was ended"));
  }
}
