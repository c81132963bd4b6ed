// What browsers offer to sessions of WebAssembly in place of Node: node.js has the same functions.

export async function readBytes(url) {
  const response = await fetch(url);
  if (!response.ok) {
    throw new Error(`${url} cannot be read: status ${response.status}`);
  }
  return response.arrayBuffer();
}

export function fillRandom(bytes) {
  crypto.getRandomValues(bytes);
}

/** Starts a worker. `fail` is called with the error that ends it. */
export function startWorker(script, fail) {
  const worker = new Worker(script, { type: "module" });
  worker.onerror = (event) => fail(new Error(event.message || `${script} cannot be run`));
  return worker;
}

/** In a worker: gives each message to `receive`. */
export function whenReceived(receive) {
  globalThis.onmessage = ({ data }) => receive(data);
}
