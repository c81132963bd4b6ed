// What Node offers, and browsers offer otherwise: browser.js has the same functions.

import { writeFile } from "node:fs/promises";
import { inflateSync } from "node:zlib";

export function inflate(bytes) {
  return new Uint8Array(inflateSync(bytes));
}

export function fromBase64(text) {
  return new Uint8Array(Buffer.from(text, "base64"));
}

export function toBase64(bytes) {
  return Buffer.from(bytes).toString("base64");
}

export function saveFile(path, bytes) {
  return writeFile(path, bytes);
}
