// The transport over WebSocket: messages of a server that the tests play, and the real server where the platform has WebSocket.

import assert from "node:assert/strict";
import test from "node:test";
import { connect, LostError, RefusedError, TimeoutError } from "../src/index.js";

/** A class WebSocket whose server answers each line by `answer`: a list of messages, or { close: [code, reason] }. */
function socketOf(answer, { opens = true, made = [] } = {}) {
  return class extends EventTarget {
    constructor(url) {
      super();
      made.push(this);
      this.url = url;
      setImmediate(() => this.dispatchEvent(new Event(opens ? "open" : "error")));
    }

    send(line) {
      const reply = line.startsWith("hello") ? ["ok server=test protocol=1"] : answer(line);
      setImmediate(() => (Array.isArray(reply) ? reply.forEach((data) => this.tell("message", { data })) : this.tell("close", reply)));
    }

    close() {
      this.closed = true;
      setImmediate(() => this.tell("close", { code: 1005, reason: "" }));
    }

    tell(type, properties) {
      this.dispatchEvent(Object.assign(new Event(type), properties));
    }
  };
}

const bytes = (...values) => Uint8Array.from(values).buffer;

async function opened(answer, options = {}) {
  const made = [];
  const session = await connect("ws://127.0.0.1:1", { WebSocket: socketOf(answer, { made }), ...options });
  return { session, made };
}

test("each line is a message, and so are the bytes of a reply", async () => {
  const replies = { "observe ram:raw palette:raw lives": ["ok fields=ram,palette,lives"], "act FIRE":
    ["ok ram=2 palette=3 lives=4 raw=5", bytes(1, 2, 3, 4, 5)] };
  const { session, made } = await opened((line) => replies[line] ?? ["error bad-action it is"]);
  await session.observe("ram:raw", "palette:raw", "lives");
  const sent = [session.act("FIRE"), session.act("JUMP"), session.act("FIRE")];
  const [first, refused, last] = await Promise.allSettled(sent);
  assert.deepEqual(first.value, { ram: Uint8Array.of(1, 2), palette: Uint8Array.of(3, 4, 5), lives: 4 });
  assert.ok(refused.reason instanceof RefusedError);
  assert.deepEqual(last.value, first.value);
  await session.disconnect();
  assert.equal(made[0].closed, true);
});

test("the server's endpoint is /session, unless the address has a path", async () => {
  for (const [address, url] of [["ws://h:1", "ws://h:1/session"], ["wss://h:1/", "wss://h:1/session"], ["ws://h:1/a/b", "ws://h:1/a/b"]]) {
    const made = [];
    await (await connect(address, { WebSocket: socketOf(() => ["ok"], { made }) })).disconnect();
    assert.equal(made[0].url, url);
  }
});

const faults = {
  "a close": { code: 1001, reason: "stopping" },
  "an invalid reply": ["220 mail.example.org"],
  "bytes that no line announces": [bytes(1)],
  "a line in place of bytes": ["ok ram=1 raw=1", "ok"],
  "fewer bytes than the fields have": ["ok ram=2 raw=1", bytes(1)],
  "a line that is too long": [`ok a=${"0".repeat(2000)}`],
  "too many bytes": ["ok ram=2000 raw=2000"],
};
for (const [name, answer] of Object.entries(faults)) {
  test(`${name} ends the session`, async () => {
    const { session } = await opened((line) => (line.startsWith("observe") ? ["ok fields=ram"] : answer), { longestReply: 1000 });
    await session.observe("ram:raw");
    await assert.rejects(session.act("FIRE"), LostError);
    await assert.rejects(session.act("FIRE"), LostError);
  });
}

test("the reason of the server is reported", async () => {
  const { session } = await opened(() => ({ code: 1008, reason: "three wrong tokens" }));
  await assert.rejects(session.act("FIRE"), /1008 three wrong tokens/);
});

test("a server that is not there, or is silent", async () => {
  await assert.rejects(connect("ws://127.0.0.1:1", { WebSocket: socketOf(() => [], { opens: false }) }), LostError);
  const silent = class extends EventTarget { close() {} };
  await assert.rejects(connect("ws://127.0.0.1:1", { WebSocket: silent, timeout: 20 }), TimeoutError);
  const { session } = await opened(() => [], { timeout: 2000 }); // the greeting has to come in time
  await assert.rejects(session.act("FIRE"), TimeoutError);
});

test("an invalid address is refused", async () => {
  for (const address of ["ws://", "ws://h:99999", "wss:h"]) {
    await assert.rejects(connect(address, { WebSocket: socketOf(() => []) }), TypeError, address);
  }
});
