// Addresses, and the connections to what they name.

import { spawn } from "node:child_process";
import { open as openPath } from "node:fs";
import { readFile, stat } from "node:fs/promises";
import net from "node:net";
import { setTimeout as sleep } from "node:timers/promises";
import tls from "node:tls";
import { promisify } from "node:util";
import { LostError, TimeoutError } from "../errors.js";
import { Streams } from "./streams.js";
import { openWebSocket } from "./websocket.js";

const USABLE = /^(tcp|tls|unix|pipes):/; // TCP is cheaper than WebSocket
const ANNOUNCEMENT = 1; // the version of announce files that this client reads
const FILES = "file:PATH takes the --ready-file or --announce file of a server";
const RETRY_MILLISECONDS = 50;
const openFile = promisify(openPath); // a plain descriptor, which a socket then owns

/** Waits for a socket to connect; `event` says that it has. Resolves with a connection. */
function connectSocket(socket, event, address, timeout) {
  return new Promise((resolve, reject) => {
    const fail = (error) => {
      clearTimeout(timer);
      socket.destroy();
      reject(error);
    };
    const timer = timeout && setTimeout(() => fail(new TimeoutError(`${address} did not answer in ${timeout} ms`)), timeout);
    socket.once("error", (error) => fail(new LostError(`no server answers at ${address}: ${error.message}`, { cause: error })));
    socket.once(event, () => {
      clearTimeout(timer);
      resolve(new Streams({ input: socket, output: socket, end: () => socket.destroy() }));
    });
  });
}

/** Opens the named pipes of a server. */
async function openPipes(prefix) {
  try {
    const input = new net.Socket({ fd: await openFile(`${prefix}_out`, "r"), readable: true, writable: false }); // in this order
    const output = new net.Socket({ fd: await openFile(`${prefix}_in`, "w"), readable: false, writable: true });
    const end = () => [output, input].forEach((stream) => stream.destroy());
    return new Streams({ input, output, end });
  } catch (error) {
    throw new LostError(error.message, { cause: error });
  }
}

/** A process that speaks the protocol on its standard streams. It ends when its input does. */
export function processOf(program, options) {
  const child = spawn(program, ["serve", "--stdio", "--log-level", "warning", ...options], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => child.once("close", resolve).once("error", resolve));
  child.once("error", (error) => {
    child.stdout.destroy(new LostError(`the program ${program} cannot be started: ${error.message}`, { cause: error }));
  });
  const end = () => {
    child.stdin.destroy();
    return ended;
  };
  return new Streams({ input: child.stdout, output: child.stdin, end });
}

/** Parses an announce file. */
function parseAnnouncement(path, text) {
  let announcement;
  try {
    announcement = JSON.parse(text);
  } catch {
    throw new TypeError(`${path} is not a whole announce file`);
  }
  const version = announcement.racebeam_announce;
  if (version !== ANNOUNCEMENT) {
    throw new TypeError(`${path} is an announce file of version ${version}; this client reads version ${ANNOUNCEMENT}`);
  }
  return announcement;
}

/** The first address of a ready file or an announce file that this client can use, and the token of the latter. */
async function addressInFile(path) {
  let regular, text;
  try {
    regular = (await stat(path)).isFile();
    text = regular && await readFile(path, "utf8"); // a pipe might block
  } catch (error) {
    throw new LostError(error.message, { cause: error });
  }
  if (!regular) {
    throw new TypeError(`${path} is not a regular file; ${FILES}`);
  }
  const { addresses, token } = text.startsWith("{") ? parseAnnouncement(path, text) : { addresses: text.split("\n") };
  const address = addresses.find((line) => USABLE.test(line));
  if (address === undefined && !/^[{#]/.test(text)) {
    throw new TypeError(`${path} ${text ? "has other contents" : "is empty"}; ${FILES}`);
  }
  if (address === undefined) {
    throw new TypeError(`${path} names no address that this client can use`);
  }
  return { address, token };
}

/** Throws an error again, with the file that names the address. */
function nameSource(error, path) {
  error.message += ` (${path} names this address)`;
  throw error;
}

/** A connection to the server that a file names. Waits for both, `seconds` at most. */
async function openFileAddress(path, seconds, options) {
  const until = performance.now() + seconds * 1000;
  for (;;) {
    try {
      const { address, token } = await addressInFile(path);
      return { connection: await openDirectly(address, options).catch((error) => nameSource(error, path)), token };
    } catch (error) {
      if (!(error instanceof LostError) || performance.now() >= until) {
        throw error;
      }
      await sleep(RETRY_MILLISECONDS);
    }
  }
}

function openNetwork(address, [, kind, host, port], { timeout, tls: trust = {} }) {
  const where = { host, port: Number(port), noDelay: true };
  if (kind === "tcp") {
    return connectSocket(net.connect(where), "connect", address, timeout);
  }
  const servername = net.isIP(host) ? "" : host;
  return connectSocket(tls.connect({ ...where, servername, minVersion: "TLSv1.2", ...trust }), "secureConnect", address, timeout);
}

/** A connection to the server at an address that no file names. */
async function openDirectly(address, options) {
  const network = /^(tcp|tls):\/\/\[?(.+?)\]?:(\d{1,5})$/.exec(address);
  if (network && network[3] < 65536) {
    return openNetwork(address, network, options);
  }
  if (/^wss?:\/\/./.test(address) && URL.canParse(address)) {
    return openWebSocket(address, options);
  }
  if (address === "stdio") {
    return new Streams({ input: process.stdin, output: process.stdout, end: () => process.stdin.destroy() });
  }
  const [, kind, path] = /^(unix|pipes):(.+)$/.exec(address) ?? [];
  switch (kind) {
    case "unix":
      return connectSocket(net.connect({ path }), "connect", address, options.timeout);
    case "pipes":
      return openPipes(path);
    default:
      throw new TypeError((address ? `the address is '${address}'` : "no address was given, and the variable RACEBEAM_ADDRESS is not set")
        + "; it takes tcp://HOST:PORT, tls://HOST:PORT, ws://HOST:PORT, wss://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, "
        + "also in RACEBEAM_ADDRESS");
  }
}

/** { connection, token }: a connection to the server at an address, and the token of its announce file, if there is one. */
export async function openAddress(address, options) {
  const [, path, seconds] = /^file:(.+?)(?:\?wait=([^]*))?$/.exec(address) ?? [];
  if (seconds !== undefined && !/^\d{1,9}(\.\d+)?$/.test(seconds)) {
    throw new TypeError(`the address is '${address}'; ?wait= takes seconds, from 0 to 999999999`);
  }
  return path ? openFileAddress(path, Number(seconds ?? 0), options) : { connection: await openDirectly(address, options) };
}
