// A method for each command, with its own server: the program that RACEBEAM_PROGRAM names.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import test from "node:test";
import { launch, LostError } from "../src/index.js";

const skip = process.env.RACEBEAM_PROGRAM ? false : "RACEBEAM_PROGRAM names no program";

function launched(context, ...options) {
  const session = launch({ options });
  context.after(() => session.disconnect());
  return session;
}

test("each command has a method", { skip }, async (context) => {
  const folder = mkdtempSync(path.join(os.tmpdir(), "racebeam-"));
  const game = launched(context, "--record-dir", folder, "--roms", folder);
  context.after(() => rmSync(folder, { recursive: true })); // after the server has ended
  assert.match((await game.hello()).server, /^racebeam\//);
  assert.match(await game.help("act"), /act A/);
  assert.deepEqual(await game.games(), ["beamfall", "updraft"]);
  assert.equal((await game.game("beamfall")).here, 1);
  assert.equal((await game.load("beamfall", { seed: 3, sticky: 0, preset: "paper2013" })).frame_skip, 5);
  assert.equal((await game.settings()).seed, 3);
  assert.equal((await game.set({ difficulty: 1 })).difficulty, 1);
  assert.deepEqual(await game.modes(), [0]);
  assert.deepEqual(await game.difficulties(), [0, 1]);
  const { ram, tia } = await game.names();
  assert.equal(ram.get(1), "lives");
  assert.equal(tia.length, (await game.look("tia")).tia.length);
  assert.equal((await game.actions()).get(17), "DOWNLEFTFIRE");
  assert.deepEqual(await game.observe("reward", "terminated", "truncated", "frame"), ["reward", "terminated", "truncated", "frame"]);
  assert.equal((await game.act("UP", "FIRE*2")).frame, 15);
  await game.poke(5, [0x12, 0xf4]);
  assert.deepEqual(await game.peek(5, 2), Uint8Array.of(0x12, 0xf4));
  await game.save("a");
  await game.save("r", { generator: 1 });
  await game.importState("b", await game.exportState("a"));
  assert.deepEqual(await game.states(), ["a", "b", "r"]);
  await game.drop("a", "r");
  assert.equal((await game.restore("b")).frame, 15);
  const branches = await game.branch("b", [["FIRE*4", "UP"], [0]], { keep: "leaf" });
  assert.deepEqual(branches.map((branch) => branch.rewards.length), [5, 1]);
  await assert.rejects(game.branch("b", "RIGHT*5"), /the lists are 'RIGHT\*5'; branch takes an array of arrays/);
  await assert.rejects(game.branch("b", ["RIGHT*5"]), /branch takes an array of arrays/);
  assert.equal(branches[1].state, "leaf1");
  assert.equal((await game.record("gif", "film")).recording, "film.gif");
  await game.act("FIRE");
  assert.equal((await game.stopRecording()).frames, 5);
  assert.equal((await game.open(3, { autoreset: "same-step" })).length, 3);
  await game.record("png", "pictures", { machine: 2 });
  assert.deepEqual((await game.step("UP", "FIRE", "NOOP")).map(({ frame }) => frame), [5, 5, 5]);
  await game.save("c", { machine: 1 });
  assert.equal((await game.restore("c", 2)).frame, (await game.restore("c", { machine: 0 })).frame);
  assert.ok((await game.exportState("c", { episode: true })).length > (await game.exportState("c")).length);
  assert.equal((await game.restart("010", { seed: 4 })).length, 3);
  await game.closeMachines();
  assert.equal((await game.reset()).reward, 0);
  assert.equal((await game.reset(9)).reward, 0);
  assert.equal((await game.share("room", { watchers: 2 })).share, "room");
  assert.deepEqual((await game.shared()).map(({ name }) => name), ["room"]);
  assert.equal((await game.watch("room", {}, "screen:rle")).screen.length, 33600);
  assert.equal((await game.watch("room", { since: (await game.watch("room")).frame }, "screen")).screen, undefined);
  await game.unshare();
  assert.ok((await game.stats()).requests > 20);
  await game.quit();
  await assert.rejects(game.act("FIRE"), LostError);
});

test("screens have colours", { skip }, async (context) => {
  const game = launched(context);
  await game.load("beamfall");
  const { screen, rgb } = await game.look("screen:zlib", "rgb");
  const colours = await game.palette();
  for (let at = 0; at < screen.length; ++at) {
    assert.equal(colours[screen[at]], (0xff000000 | (rgb[3 * at + 2] << 16) | (rgb[3 * at + 1] << 8) | rgb[3 * at]) >>> 0);
  }
});

test("a refusal has a code and leaves the session", { skip }, async (context) => {
  const game = launched(context);
  await assert.rejects(game.load("nothing"), { code: "unknown-game" });
  await assert.rejects(game.load("inline", { image: Uint8Array.of(1, 2, 3) }), { code: "bad-image" });
  assert.equal((await game.load("beamfall")).game, "beamfall");
});

test("requests are sent ahead by not awaiting them", { skip }, async (context) => {
  const game = launched(context);
  await game.load("beamfall");
  await game.observe("frame");
  const shown = await Promise.all(Array.from({ length: 100 }, () => game.act("NOOP")));
  assert.deepEqual(shown.map(({ frame }) => frame), Array.from({ length: 100 }, (_, n) => n + 1));
});
