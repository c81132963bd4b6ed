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

/** A `File`, or a `Blob` with a name. */
export type NamedBlob = Blob & { readonly name: string };

/** How sessions load an image that was added: by its MD5. `game` is the name of the game that it was recognised as. */
export interface AddedImage {
  md5: string;
  game: string;
}

export interface Beside {
  /** The game file of the image: its title, console and rule. Without it, the catalogue decides. */
  gameFile?: NamedBlob;
}

/**
 * Adds the image in a file for all sessions of a source, as `racebeam serve --rom` does: plain, with gzip, or in a zip archive.
 * Rejects with a RefusedError that says why it cannot be played.
 */
export function addImage(file: NamedBlob, options?: Source & Beside): Promise<AddedImage>;

/** An emulator in a worker, so that a long request does not block the page. */
export class EmulatorWorker {
  /** Starts the worker. script: the address of worker.js, if a bundler has moved it. */
  constructor(options?: Source & { script?: URL });
  /** Opens a session in this worker. Its requests and replies pass through a separate MessagePort. */
  open(): Promise<Session>;
  /** Adds an image for the sessions of this worker, as the function addImage() does. */
  addImage(file: NamedBlob, options?: Beside): Promise<AddedImage>;
  /** Ends the worker and its sessions. */
  end(): void;
}
