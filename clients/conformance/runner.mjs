// Takes the steps of a file with the client in JavaScript, and prints what came of each: runner.mjs FILE.

import { readFileSync } from "node:fs";
import { setTimeout as sleep } from "node:timers/promises";
import { connect, launch, LostError, RefusedError, ScreenStack, TimeoutError } from "../js/src/index.js";

const LONGEST_REPLY = 2 ** 20;

let session;
let options;
let last;
let stack;
let sent = []; // { command, reply }
const variables = { ...process.env };

function adler(bytes) {
  let a = 1;
  let b = 0;
  for (const byte of bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  const digits = (value) => value.toString(16).padStart(4, "0");
  return `${bytes.length}:${digits(b)}${digits(a)}`;
}

function shown(command, group) {
  if (stack) {
    if (["reset", "load", "observe"].includes(command)) {
      stack.screens.clear();
    }
    if (stack.field in group) {
      group[stack.name] = stack.screens.push(group[stack.field]);
      delete group[stack.field];
    }
  }
  return Object.keys(group).sort().map((key) => ` ${key}=${group[key] instanceof Uint8Array ? adler(group[key]) : group[key]}`).join("");
}

async function reply() {
  const { command, reply: groups } = sent.shift();
  last = (await groups)[0];
  return `ok${(await groups).map((group) => shown(command, group)).join(" |")}`;
}

/** Prints what a step gives, or the word for its failure. */
async function say(step) {
  let printed;
  try {
    printed = await step();
  } catch (error) {
    if (error instanceof RefusedError) {
      printed = `error ${error.code}`;
    } else if (error instanceof TimeoutError) {
      printed = "timeout";
    } else if (error instanceof LostError) {
      printed = "lost";
    } else if (error instanceof TypeError) {
      printed = "invalid";
    } else {
      throw error;
    }
  }
  if (printed !== undefined) {
    console.log(printed);
  }
}

const connected = (address, token) => connect(address, { ...options, token });

const steps = {
  section(_, name) {
    options = { longestReply: LONGEST_REPLY, timeout: 60000 };
    stack = undefined;
    sent = [];
    return `section ${name}`;
  },
  async connect(_, ...words) {
    await steps.close();
    session = await connected(...words);
    return "connected";
  },
  async another(_, ...words) {
    await (await connected(...words)).disconnect();
    return "connected";
  },
  async connections(_, count, address) {
    for (let n = 0; n < count; ++n) {
      await (await connected(address)).disconnect();
    }
    return "connected";
  },
  async launch() {
    await steps.close();
    session = launch({ program: process.env.RACEBEAM_BINARY });
    return "connected";
  },
  send(line) {
    const groups = session.request(line);
    groups.catch(() => {}); // reply() looks at it later
    sent.push({ command: line.split(" ")[0], reply: groups });
  },
  ">"(line) {
    steps.send(line);
    return reply();
  },
  async receive(_, count) {
    for (let n = 0; n < count; ++n) {
      await say(reply);
    }
  },
  async picture(_, path) {
    await session.savePng(path);
    return `picture ${adler(readFileSync(path))}`;
  },
  keep(_, name, key) {
    variables[name] = last[key];
  },
  async close() {
    await session?.disconnect();
  },
  timeout(_, seconds) {
    options.timeout = 1000 * seconds;
  },
  trust(_, path) {
    options.tls = { ca: readFileSync(path) };
  },
  stack(_, field, depth) {
    stack = { field, name: `${field}x${depth}`, screens: new ScreenStack(Number(depth)) };
  },
  async wait(_, seconds) {
    await sleep(1000 * seconds);
  },
  async time(line, count, ahead) {
    const request = line.split(" ").slice(2).join(" ");
    const start = performance.now();
    for (let step = 0; step < count; step += Number(ahead)) {
      await Promise.all(Array.from({ length: ahead }, () => session.request(request)));
    }
    return `time ${ahead} ${((performance.now() - start) / 1000).toFixed(6)}`;
  },
};

for (const line of readFileSync(process.argv[2], "utf8").split("\n")) {
  if (line.trim() && !line.startsWith("#")) {
    const filled = line.replace(/\$(\w+)/g, (_, name) => variables[name]).trim();
    const [word] = filled.split(" ", 1);
    const rest = filled.slice(word.length + 1);
    await say(() => steps[word](rest, ...rest.split(" ")));
  }
}
await steps.close();
