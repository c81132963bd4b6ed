// The client in a browser: sessions over WebSocket only. It lacks launch() and zlib() of index.js.

import { openWebSocket } from "./connections/websocket.js";
import { greet } from "./greeting.js";

export { applyDelta, base64, hex, rle } from "./decode.js";
export { LostError, RefusedError, TimeoutError } from "./errors.js";
export { PROTOCOL } from "./greeting.js";
export { Session } from "./session.js";
export { ScreenStack } from "./stack.js";

/** The address of the server that the page came from. */
function own() {
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}`;
}

export async function connect(address = own(), options = {}) {
  if (!/^wss?:\/\/./.test(address)) {
    throw new TypeError(`the address is '${address}'; in a browser it takes ws://HOST:PORT or wss://HOST:PORT`);
  }
  return greet(await openWebSocket(address, options), address, options);
}
