// What Node offers to sessions of WebAssembly, and browsers offer otherwise: browser.js has the same functions.

import { randomFillSync } from "node:crypto";
import { readFile } from "node:fs/promises";
import { parentPort, Worker } from "node:worker_threads";

export function readBytes(url) {
  return readFile(url);
}

export function fillRandom(bytes) {
  randomFillSync(bytes);
}

export function startWorker(script, fail) {
  const worker = new Worker(script);
  worker.on("error", fail);
  worker.unref(); // it does not keep the process
  return worker;
}

export function whenReceived(receive) {
  parentPort.on("message", receive);
}
