import type { Session } from "../index.js";

export interface Source {
  /** The address of racebeam.wasm, or its bytes. Without it, the file beside this module. */
  source?: URL | BufferSource;
}

/**
 * A session in this page or process, without a server: the emulator runs as WebAssembly. All sessions of one source share an
 * emulator.
 */
export function open(options?: Source): Promise<Session>;

/** An emulator in a worker, so that a long request does not block the page. */
export class EmulatorWorker {
  /** Starts the worker. script: the address of worker.js, if a bundler has moved it. */
  constructor(options?: Source & { script?: URL });
  /** Opens a session in this worker. Its requests and replies pass through a separate MessagePort. */
  open(): Promise<Session>;
  /** Ends the worker and its sessions. */
  end(): void;
}
