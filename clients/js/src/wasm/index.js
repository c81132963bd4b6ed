// Sessions in this process, as WebAssembly: games without a server. index.d.ts describes them.

import { startWorker } from "#system";
import { greet } from "../greeting.js";
import { connectionTo } from "./local.js";
import { PortConnection } from "./port.js";

const NAME = "racebeam.wasm";

/** An address as text, or bytes as they are. */
function plain(source = new URL(NAME, import.meta.url)) {
  return source instanceof URL ? source.href : source;
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
    const { port1, port2 } = new MessageChannel();
    this.#worker.postMessage({ port: port2 }, [port2]);
    return greet(new PortConnection(port1, this.#failed), NAME, options);
  }

  end() {
    this.#worker.terminate();
    this.#fail(new Error("it was ended"));
  }
}
