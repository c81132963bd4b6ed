// Servers that misbehave, and bad input of the caller. No server of racebeam is needed.

import assert from "node:assert/strict";
import { once } from "node:events";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import readline from "node:readline";
import test from "node:test";
import { connect, launch, LostError, RefusedError, TimeoutError } from "../src/index.js";

const HELLO = "ok server=test protocol=1\n";

/** A session of a server that answers each line as it is told; undefined closes the connection. Both end with the test. */
async function served(context, answer, options = { timeout: 2000, longestReply: 65536 }) { // a busy machine may greet late
  const sockets = new Set();
  const server = net.createServer((socket) => {
    sockets.add(socket.on("error", () => {}).on("close", () => sockets.delete(socket)));
    readline.createInterface({ input: socket }).on("line", (line) => {
      const reply = line.startsWith("hello") ? HELLO : answer(line);
      if (reply === undefined) {
        socket.destroySoon();
      } else if (socket.writable) {
        socket.write(reply, "latin1");
      }
    });
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  context.after(() => {
    sockets.forEach((socket) => socket.destroy());
    server.close();
  });
  const session = await connect(`tcp://127.0.0.1:${server.address().port}`, options);
  context.after(() => session.disconnect());
  return { session, sockets };
}

function temporaryFolder(context) {
  const folder = mkdtempSync(path.join(os.tmpdir(), "racebeam-"));
  context.after(() => rmSync(folder, { recursive: true }));
  return folder;
}

const faults = {
  "a server that closes": [undefined, LostError],
  "an invalid reply": ["220 mail.example.org\n", LostError],
  "binary data": ["\u00ff\u0080\n", LostError],
  "an endless line": [`ok a=${"0".repeat(1 << 17)}`, LostError],
  "half a line": ["ok rew", TimeoutError],
  "silence": ["", TimeoutError],
};
for (const [name, [answer, kind]] of Object.entries(faults)) {
  test(`${name} ends the session`, async (context) => {
    const { session } = await served(context, () => answer);
    await assert.rejects(session.act("FIRE"), kind);
    await assert.rejects(session.act("FIRE"), (error) => error instanceof LostError && !(error instanceof TimeoutError));
  });
}

test("an invalid reply is quoted for a terminal", async (context) => {
  const { session } = await served(context, () => "\x1b[31mred\u00ff\n");
  await assert.rejects(session.act("FIRE"), ({ message }) => message.includes("'\\x1b[31mred") && /^[ -~]*$/.test(message));
});

test("an invalid number of bytes is not executed by a terminal", async (context) => {
  const { session } = await served(context, () => "ok raw=\x1b[31mred\n");
  await assert.rejects(session.act("FIRE"), ({ message }) => message.includes("raw=\\x1b[31mred") && /^[ -~]*$/.test(message));
});

test("a file that names no server is refused in a sentence", async (context) => {
  const folder = temporaryFolder(context);
  const at = (name) => `file:${path.join(folder, name)}`;
  for (const [name, text, sentence] of [
    ["empty", "", /empty is empty; file:PATH takes the --ready-file or --announce file of a server$/],
    ["notes", "dear diary\n", /notes has other contents; file:PATH takes/],
    [".", undefined, / is not a regular file; file:PATH takes/],
    ["broken", "{\x00\xff", /broken is not a whole announce file$/],
  ]) {
    if (text !== undefined) {
      writeFileSync(path.join(folder, name), text, "latin1");
    }
    await assert.rejects(connect(at(name)), { name: "TypeError", message: sentence });
  }
  for (const time of ["", "x", "-1", "1e3", "99999999999999999999"]) {
    await assert.rejects(connect(`${at("empty")}?wait=${time}`), { name: "TypeError", message: /\?wait= takes seconds, from 0 to 999999999$/ });
  }
  const closed = net.createServer().listen(0, "127.0.0.1");
  await once(closed, "listening");
  const { port } = closed.address();
  closed.close();
  await once(closed, "close");
  writeFileSync(path.join(folder, "stale"), `# addresses\ntcp://127.0.0.1:${port}\n`);
  await assert.rejects(connect(at("stale")), { name: "LostError", message: new RegExp(`tcp://127.0.0.1:${port}: .*stale names`) });
});

test("an error in a pipeline leaves the others", async (context) => {
  const { session } = await served(context, (line) => (line === "bad" ? "error bad-action it is\n" : `ok n=${line}\n`));
  const replies = await Promise.allSettled(["1", "bad", "2"].map((line) => session.request(line)));
  assert.deepEqual(replies.map((reply) => reply.value?.[0].n ?? reply.reason.code), [1, "bad-action", 2]);
  assert.ok(replies[1].reason instanceof RefusedError);
  assert.equal(replies[1].reason.message, "bad-action: it is");
});

test("all that waits is rejected when the server dies", async (context) => {
  const { session } = await served(context, (line) => (line === "die" ? undefined : "ok\n"));
  const replies = await Promise.allSettled(["1", "die", "3"].map((line) => session.request(line)));
  assert.deepEqual(replies.map(({ status }) => status), ["fulfilled", "rejected", "rejected"]);
});

test("any number of requests can be sent ahead", async (context) => {
  const { session } = await served(context, () => `ok a=${"0".repeat(10000)}\n`, {});
  const replies = await Promise.all(Array.from({ length: 5000 }, () => session.request("act FIRE")));
  assert.equal(replies.length, 5000);
});

test("the next request reports why a server ends", async (context) => {
  const { session, sockets } = await served(context, () => "ok\n");
  for (const socket of sockets) {
    socket.end("error stopping the server stops\n");
  }
  await session.ended;
  await assert.rejects(session.act("FIRE"), { code: "stopping" });
  await assert.rejects(session.act("FIRE"), LostError);
});

test("a watched session has its own arrays", async (context) => {
  const replies = { load: "height=9", observe: "fields=grey84", act: "grey84=000001" + "0503", watch: "height=10 screen=000001" + "0701" };
  const { session } = await served(context, (line) => `ok ${replies[line.split(" ")[0]] ?? ""}\n`);
  await session.load("beamfall");
  await session.observe("grey84:delta");
  await session.act("FIRE");
  const watched = async (...fields) => (await session.request("watch", "room", ...fields))[0].screen;
  assert.equal((await watched("screen:delta")).length, 1600);
  replies.watch = "height=10 screen=000101" + "0801";
  assert.deepEqual((await watched("since=3", "screen:delta")).slice(0, 3), Uint8Array.of(7, 8, 0));
  assert.deepEqual((await watched("screen:delta", "lives")).slice(0, 3), Uint8Array.of(0, 8, 0));
  assert.deepEqual((await session.act("FIRE")).grey84.slice(0, 4), Uint8Array.of(5, 5, 5, 0));
});

test("the end of a session is reported without a request", async (context) => {
  const { session, sockets } = await served(context, () => "ok\n");
  sockets.forEach((socket) => socket.end());
  assert.ok(await session.ended instanceof LostError);
  const { session: other } = await served(context, () => "ok\n");
  await other.disconnect();
  assert.equal((await other.ended).message, "the client closed the session");
  await assert.rejects(other.reset(), { name: "LostError", message: "the session has ended: the client closed the session" });
});

test("use after disconnect() is refused", async (context) => {
  const { session } = await served(context, () => "");
  const waiting = session.act("FIRE");
  await session.disconnect();
  await session.disconnect();
  await assert.rejects(waiting, LostError);
  await assert.rejects(session.act("FIRE"), LostError);
});

test("connections leave nothing open", async (context) => {
  const kept = await served(context, () => "ok\n");
  const open = [kept.sockets];
  for (let n = 0; n < 50; ++n) {
    const { session, sockets } = await served(context, () => "ok\n");
    open.push(sockets);
    await session.disconnect();
  }
  const count = () => open.reduce((sum, sockets) => sum + sockets.size, 0);
  for (let patience = 200; patience > 0 && count() > 1; --patience) {
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
  assert.equal(count(), 1); // that of the session that is kept
});

test("the caller's words are checked", async (context) => {
  for (const address of ["", "nonsense", "tcp://host", "tcp://host:99999", "unix:", "http://host:1"]) {
    await assert.rejects(connect(address), TypeError, address);
  }
  const folder = temporaryFolder(context);
  writeFileSync(path.join(folder, "ready"), "# addresses\nclassic+unix:x\n");
  await assert.rejects(connect(`file:${folder}/ready`), TypeError);
  for (const address of [`file:${folder}/nothing`, `unix:${folder}/nothing`, `pipes:${folder}/nothing`]) {
    await assert.rejects(connect(address), LostError, address);
  }
  const missing = await launch({ program: "/nonexistent/racebeam" }).hello().catch((error) => error);
  assert.ok(missing instanceof LostError);
  assert.match(missing.message, /the program \/nonexistent\/racebeam cannot be started: /);
  const { session } = await served(context, () => "ok\n");
  for (const bytes of ["01FF", 3, null, undefined, [256], [-1], [0.5], ["1"]]) {
    await assert.rejects(session.poke(0, bytes), TypeError);
  }
  await assert.rejects(session.request("act\nact"), TypeError);
  await assert.rejects(session.request("# a comment"), TypeError);
  await session.act("FIRE");
});

test("bytes after a line may come in any pieces", async (context) => {
  const pieces = ["ok reward=1 ram=", "4 raw=4", "\n\x01\n", "\x02", "\xffok reward=2 ram=1 raw=1\n", "\x07"];
  const { session, sockets } = await served(context, (line) => (line.startsWith("observe") ? "ok fields=reward,ram\n" : ""));
  await session.observe("reward", "ram:raw");
  const replies = [session.act("FIRE"), session.act("FIRE")];
  for (const piece of pieces) {
    await new Promise((resolve) => setTimeout(resolve, 5)); // the subject: the client reads each piece by itself
    sockets.forEach((socket) => socket.write(piece, "latin1"));
  }
  assert.deepEqual(await Promise.all(replies), [{ reward: 1, ram: Uint8Array.of(1, 10, 2, 255) }, { reward: 2, ram: Uint8Array.of(7) }]);
});

for (const [name, answer] of [["announced", "ok ram=99999 raw=99999\n"], ["of another size", "ok ram=3 raw=2\n\x01\x02"]]) {
  test(`too many bytes, ${name}, end the session`, async (context) => {
    const { session } = await served(context, (line) => (line.startsWith("observe") ? "ok fields=ram\n" : answer));
    await session.observe("ram:raw");
    await assert.rejects(session.act("FIRE"), LostError);
  });
}
