// build/viewer-static, as scripts/viewer --static makes it, below a path of a server that has only files.

import { once } from "node:events";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import os from "node:os";
import path from "node:path";

const FOLDER = path.resolve("../build/viewer-static");
const BELOW = "/some/where/";
const TYPES: Record<string, string> = { ".css": "text/css", ".html": "text/html", ".js": "text/javascript", ".svg": "image/svg+xml" };

export class Folder {
  /** The files that were asked for, in order. */
  readonly asked: string[] = [];
  address = "";
  readonly #disk = mkdtempSync(path.join(os.tmpdir(), "racebeam-"));
  readonly #server = createServer(({ url = "", headers }, reply) => {
    const name = url.slice(BELOW.length) || "index.html";
    this.asked.push(name);
    const file = path.join(FOLDER, name);
    if (headers["content-length"] || !url.startsWith(BELOW) || !existsSync(file)) {
      reply.writeHead(404).end();
      return;
    }
    reply.writeHead(200, { "Content-Type": TYPES[path.extname(name)] ?? "application/octet-stream" }).end(readFileSync(file));
  });

  async start(): Promise<void> {
    await once(this.#server.listen(0, "127.0.0.1"), "listening");
    this.address = `http://127.0.0.1:${(this.#server.address() as AddressInfo).port}${BELOW}`;
  }

  /** Writes a file that a person could choose. Returns its path. */
  onDisk(name: string, bytes: Uint8Array | string): string {
    const file = path.join(this.#disk, name);
    writeFileSync(file, bytes);
    return file;
  }

  stop(): void {
    this.#server.close();
    this.#server.closeAllConnections();
    rmSync(this.#disk, { recursive: true, force: true });
  }
}

/** A file of the tree. */
export function source(name: string): Uint8Array {
  return readFileSync(path.resolve("..", name));
}

/** The image of one of our own games, with another byte between its code and its vectors: no game file lists it. */
export function changedImage(game: string): Uint8Array {
  const image = Uint8Array.from(source(`games/homebrew/${game}.bin`));
  image[image.length - 8]! ^= 1;
  return image;
}
