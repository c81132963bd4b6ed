import { LostError, printable, TimeoutError } from "../errors.js";
import { rawSize } from "../raw.js";

const NOTHING = new Uint8Array(0);

/** A connection over a WebSocket: a text message for each line; a binary message has the bytes that follow one. */
class WebSocketConnection {
  #socket;
  #line; // a line whose bytes are still to come

  constructor(socket) {
    this.#socket = socket;
  }

  /** Gives each reply to `receiver`: reply(line, bytes), and lost(error) at the end. */
  listen(receiver, longest) {
    this.#socket.addEventListener("message", ({ data }) => {
      const problem = this.#take(data, receiver, longest);
      if (problem) {
        receiver.lost(new LostError(`the server sent ${problem}`));
      }
    });
    this.#socket.addEventListener("close", ({ code, reason }) => {
      receiver.lost(new LostError(`the server has closed the connection (${printable([code, reason].filter(Boolean).join(" "))})`));
    });
  }

  send(line) {
    this.#socket.send(line);
  }

  end() {
    this.#socket.close();
  }

  /** Returns what is wrong with a message, if anything is. */
  #take(data, receiver, longest) {
    const expected = this.#line === undefined ? "string" : "object";
    if (typeof data !== expected) {
      return expected === "string" ? "bytes that no line announces" : "a line in place of bytes";
    }
    const size = typeof data === "string" ? Math.max(data.length, rawSize(data)) : data.byteLength;
    if (Number.isNaN(size)) {
      return `a reply that ends in 'raw=' without a number of bytes: ${printable(data.slice(-40))}`;
    }
    if (size > longest) {
      return `a reply longer than ${longest} bytes`;
    }
    if (typeof data !== "string") {
      const line = this.#line;
      this.#line = undefined;
      receiver.reply(line, new Uint8Array(data));
    } else if (rawSize(data)) {
      this.#line = data;
    } else {
      receiver.reply(data, NOTHING);
    }
    return undefined;
  }
}

/** The address with the path of the server's endpoint, unless it has a path. */
function endpoint(address) {
  const url = new URL(address);
  if (url.pathname === "/") {
    url.pathname = "/session";
  }
  return url.href;
}

/** Opens a connection to ws://HOST:PORT or wss://HOST:PORT. `Socket` is the class WebSocket, if the platform lacks it. */
export function openWebSocket(address, { timeout, WebSocket: Socket = globalThis.WebSocket }) {
  if (!Socket) {
    throw new TypeError(`this version of Node has no WebSocket for ${address}; Node 22 has one, and the option WebSocket takes one`);
  }
  return new Promise((resolve, reject) => {
    const socket = new Socket(endpoint(address));
    socket.binaryType = "arraybuffer";
    const fail = (error) => {
      clearTimeout(timer);
      socket.close();
      reject(error);
    };
    const timer = timeout && setTimeout(() => fail(new TimeoutError(`${address} did not answer in ${timeout} ms`)), timeout);
    socket.addEventListener("error", () => fail(new LostError(`no server answers at ${address}`)));
    socket.addEventListener("open", () => {
      clearTimeout(timer);
      resolve(new WebSocketConnection(socket));
    });
  });
}
