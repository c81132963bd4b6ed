// Sessions of WebAssembly do what those of the program do: RACEBEAM_PROGRAM names the program, and RACEBEAM_WASM racebeam.wasm.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import test, { after } from "node:test";
import { launch, LostError, RefusedError } from "racebeam";
import { gzipSync } from "node:zlib";
import { addImage, EmulatorWorker, open } from "racebeam/wasm";

const source = readFileSync(process.env.RACEBEAM_WASM);
const worker = new EmulatorWorker({ source });
after(() => worker.end());
const path = (name) => new URL(`../../../${name}`, import.meta.url);
const IMAGE = readFileSync(path("games/homebrew/updraft.bin"));

async function opened(context) {
  const session = await open({ source });
  context.after(() => session.disconnect());
  return session;
}

/** A session here, and one of the program. */
async function both(context) {
  const other = launch();
  context.after(() => other.disconnect());
  return [await opened(context), other];
}

/** What a request is answered: groups, or why it was refused. */
async function answer(session, request) {
  try {
    return await session.request(request);
  } catch (error) {
    assert.ok(error instanceof RefusedError, String(error));
    return error.message;
  }
}

/** The sections of the conversation that all clients hold over TCP, but those that depend on a clock: { name, requests }. */
function sections() {
  const text = readFileSync(path("clients/conformance/conversation.txt"), "utf8");
  const all = text.split(/^section /m).slice(1).filter((section) => section.includes("\nconnect $TCP\n") && !section.includes("\nwait "));
  return all.map((section) => {
    const requests = [...section.matchAll(/^(?:>|send) (?!stats$)(.*)$/gm)].map(([, request]) => request); // stats has times
    return { name: section.split(/\s/, 1)[0], requests };
  });
}

for (const { name, requests } of sections()) {
  test(`the conversation's section ${name} is that of the program`, async (context) => {
    const [here, there] = await both(context);
    const values = { IMAGE: IMAGE.toString("base64"), LONG: "x".repeat(2 ** 21) };
    for (const request of requests) {
      const line = request.replace(/\$(\w+)/g, (word, name) => values[name]);
      const [ours, theirs] = [await answer(here, line), await answer(there, line)];
      if (line.startsWith("hello") && typeof theirs !== "string") {
        Object.assign(theirs[0], { threads: 1, max_idle: 0 }); // a page has one, and time
      }
      assert.deepEqual(ours, theirs, line.slice(0, 80));
      values.DATA = theirs[0].data ?? values.DATA;
    }
  });
}

/** A digest of what acts show, and of new episodes. */
async function digest(session, acts) {
  const hash = createHash("md5");
  for (let act = 0; act < acts; ++act) {
    const shown = await session.act((7 * act) % 18);
    for (const [key, value] of Object.entries(shown)) {
      hash.update(key).update(value instanceof Uint8Array ? value : String(value));
    }
    if (shown.terminated || shown.truncated) {
      await session.reset();
    }
  }
  return hash.digest("hex");
}

for (const game of ["beamfall", "updraft"]) {
  for (const settings of [{ seed: 7, sticky: 0 }, { seed: 8, frame_skip: 4, noop_max: 30 }, { seed: 9, preset: "machado2018" }]) {
    test(`${game} shows the same with ${JSON.stringify(settings)}`, async (context) => {
      const digests = [];
      for (const session of await both(context)) {
        await session.load(game, { ...settings, sound: 1, max_episode_frames: 900 });
        await session.observe("reward", "terminated", "truncated", "lives", "ram:raw", "screen:raw", "rgb:raw", "audio:raw");
        digests.push(await digest(session, 400));
      }
      assert.equal(digests[0], digests[1]);
    });
  }

  test(`states of ${game} are continued on either side`, async (context) => {
    const sessions = await both(context);
    const states = [];
    for (const session of sessions) {
      await session.load(game, { seed: 5 });
      await session.observe("terminated", "truncated", "ram", "screen");
      await digest(session, 150);
      await session.save("here", { generator: 1 });
      states.push(await session.exportState("here"));
    }
    assert.deepEqual(states[0], states[1]);
    const continued = await digest(sessions[0], 150);
    for (const [at, session] of sessions.entries()) {
      await session.load(game, { seed: 99 });
      await session.importState("there", states[1 - at]);
      await session.restore("there");
      assert.equal(await digest(session, 150), continued);
    }
  });
}

test("an image from outside is played", async (context) => {
  const game = await opened(context);
  assert.equal((await game.load("inline", { image: IMAGE })).md5, createHash("md5").update(IMAGE).digest("hex"));
  const sent = await digest(game, 50);
  await game.load("updraft", { seed: (await game.settings()).seed });
  assert.equal(await digest(game, 50), sent);
});

const CHANGED = Uint8Array.from(IMAGE); // an image that no game file lists
CHANGED[CHANGED.length - 8] ^= 1; // between the code and the vectors
const file = (name, ...parts) => Object.assign(new Blob(parts), { name });

for (const [kind, add] of [["the process", (blob, options) => addImage(blob, { source, ...options })], ["a worker", (blob, options) => worker.addImage(blob, options)]]) {
  test(`an image that is added in ${kind} is loaded by its MD5`, async () => {
    const known = await add(file("any.bin", IMAGE));
    assert.deepEqual(known, { md5: createHash("md5").update(IMAGE).digest("hex"), game: "updraft" });
    const added = await add(file("Mine.bin.gz", gzipSync(CHANGED)));
    assert.deepEqual(added, { md5: createHash("md5").update(CHANGED).digest("hex"), game: "mine" });
    const game = await (kind === "a worker" ? worker.open() : open({ source }));
    assert.deepEqual((({ rule, md5 }) => ({ rule, md5 }))(await game.load(added.md5)), { rule: 0, md5: added.md5 });
    await add(file("mine.bin", CHANGED), { gameFile: file("game.toml", readFileSync(path("games/catalogue/updraft.toml"))) });
    assert.deepEqual((({ rule, game }) => ({ rule, game }))(await game.load(added.md5)), { rule: 1, game: "game" });
    await game.disconnect();
  });
}

const REFUSED = {
  "image empty.bin: the file is empty": [file("empty.bin")],
  "image large.bin: larger than the largest image, 524288 bytes": [file("large.bin", new Uint8Array(524289))],
  "huge.bin: larger than 16777216 bytes": [file("huge.bin", new Uint8Array(2 ** 24 + 1))],
  "image cut.gz: the gzip file is truncated": [file("cut.gz", gzipSync(IMAGE).subarray(0, 500))],
  "image a.zip: the zip archive is damaged": [file("a.zip", "PK\x03\x04...")],
  "image a.7z: 7z archives are not read": [file("a.7z", Uint8Array.from([0x37, 0x7a, 0xbc, 0xaf, 0x27, 0x1c]))],
  "no cartridge scheme fits an image of 3000 bytes": [file("odd.bin", new Uint8Array(3000))],
  "game.toml:1: title: a game must have this key": [file("a.bin", IMAGE), { gameFile: file("game.toml", "modes = [1]\n") }],
};

test("files that cannot be played are refused", async () => {
  for (const [sentence, [image, options]] of Object.entries(REFUSED)) {
    await assert.rejects(addImage(image, { source, ...options }), (error) => {
      assert.ok(error instanceof RefusedError);
      assert.ok(error.message.startsWith("bad-image: ") && error.message.includes(sentence), error.message);
      return true;
    });
  }
});

test("seeds are drawn at random", async (context) => {
  const game = await opened(context);
  assert.notEqual((await game.load("beamfall")).seed, (await game.load("beamfall")).seed);
});

test("sessions of a source share an emulator, and do not disturb each other", async (context) => {
  const [one, other] = [await opened(context), await opened(context)];
  await one.load("beamfall", { seed: 1 });
  await one.share("room");
  assert.equal((await other.request("watch", "room"))[0].game, "beamfall");
  await other.load("beamfall", { seed: 1 });
  for (let act = 0; act < 50; ++act) {
    assert.deepEqual(await one.act("FIRE"), await other.act("FIRE"));
  }
  await one.disconnect();
  assert.deepEqual((await other.request("shared"))[0].count, 0);
});

test("sessions give their memory back", async () => {
  for (let session = 0; session < 64; ++session) { // 1.1 GiB of states, more than all may have
    const game = await open({ source });
    await game.load("beamfall");
    await Promise.all(Array.from({ length: 256 }, (_, state) => game.save(`s${state}`)));
    await game.disconnect();
  }
});

test("a session ends with quit and with disconnect", async (context) => {
  for (const end of [(session) => session.request("quit"), (session) => session.disconnect()]) {
    const game = await opened(context);
    await end(game);
    assert.ok(await game.ended instanceof LostError);
    await assert.rejects(game.hello(), LostError);
    await game.disconnect();
  }
});

test("sessions of a worker are those of the process", async (context) => {
  const worker = new EmulatorWorker({ source });
  context.after(() => worker.end());
  const sessions = [await opened(context), await worker.open(), await worker.open()];
  const digests = await Promise.all(sessions.map(async (session) => {
    await session.load("beamfall", { seed: 7 });
    await session.observe("reward", "terminated", "truncated", "screen:raw", "ram");
    return digest(session, 50);
  }));
  assert.deepEqual(digests, Array(3).fill(digests[0]));
  assert.match(await answer(sessions[1], "act JUMP"), /^bad-action: /);
  await sessions[1].share("room");
  assert.equal((await sessions[2].request("shared"))[0].count, 1);
  await sessions[1].disconnect();
  while ((await sessions[2].request("shared"))[0].count) { // until the worker has ended the session
    await sessions[2].hello();
  }
});

test("sessions end with their worker, and without one", async () => {
  const worker = new EmulatorWorker({ source });
  const session = await worker.open();
  const waiting = assert.rejects(session.hello(), LostError);
  worker.end();
  await waiting;
  await assert.rejects(new EmulatorWorker({ source: IMAGE }).open(), LostError);
  await assert.rejects(new EmulatorWorker({ source: new URL("none.wasm", import.meta.url) }).open(), /none\.wasm/);
  await assert.rejects(new EmulatorWorker({ source, script: new URL("none.js", import.meta.url) }).open(), /the worker has failed/);
});

test("bytes that are not racebeam.wasm are refused", async () => {
  await assert.rejects(open({ source: IMAGE }), WebAssembly.CompileError);
  await assert.rejects(open({ source: new URL("none.wasm", import.meta.url) }), /none\.wasm/);
});

test("the program of the page prints what the page says", () => {
  const page = readFileSync(new URL("README.md", import.meta.url), "utf8");
  const [, program, output] = /^```js\n(.*?)^```\n\n```text\n(.*?)^```$/ms.exec(page);
  const bytes = `open({ source: readFileSync(${JSON.stringify(process.env.RACEBEAM_WASM)}) })`;
  const printed = execFileSync(process.execPath, ["--input-type=module", "-e",
    `import { readFileSync } from "node:fs";\n${program.replace("open()", bytes)}`], { cwd: new URL("..", import.meta.url) });
  assert.equal(String(printed), output);
});
