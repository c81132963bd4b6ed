import assert from "node:assert/strict";
import test from "node:test";
import { gameFile, outcome } from "../../src/inspect/draft.js";
import { valuesOf } from "../../src/inspect/palette.js";
import { addressOf, byteOf, MemorySearch } from "../../src/inspect/search.js";

const ram = (bytes: Record<number, number>) => {
  const all = new Uint8Array(128);
  Object.entries(bytes).forEach(([index, value]) => (all[Number(index)] = value));
  return all;
};

test("a search narrows by what bytes did", () => {
  const search = new MemorySearch();
  search.begin(ram({ 1: 3, 2: 9, 3: 5 }));
  assert.equal(search.candidates.length, 128);
  search.narrow("changed", ram({ 1: 2, 2: 8, 3: 6 }));
  assert.deepEqual(search.candidates, [1, 2, 3]);
  search.narrow("decreased", ram({ 1: 1, 2: 7, 3: 9 }));
  assert.deepEqual(search.candidates, [1, 2]);
  search.narrow("unchanged", ram({ 1: 1, 2: 6 }));
  assert.deepEqual(search.candidates, [1]);
  search.narrow("increased", ram({ 1: 2 }));
  search.narrow("equal", ram({ 1: 2 }), 2);
  assert.deepEqual(search.candidates, [1]);
  search.narrow("equal", ram({ 1: 2 }), 3);
  assert.deepEqual(search.candidates, []);
});

test("a step of the search can be taken back", () => {
  const search = new MemorySearch();
  search.undo();
  search.narrow("changed", ram({ 1: 1 })); // begins by itself
  assert.equal(search.candidates.length, 0);
  search.undo();
  assert.equal(search.candidates.length, 128);
  search.narrow("equal", ram({ 7: 70 }), 70);
  assert.deepEqual(search.candidates, [7]);
});

test("a search keeps its own copy of RAM", () => {
  const search = new MemorySearch();
  const bytes = ram({});
  search.begin(bytes);
  bytes[4] = 1;
  search.narrow("increased", bytes);
  assert.deepEqual(search.candidates, [4]);
});

test("bytes are read in both notations", () => {
  assert.deepEqual(["$1F", "0x1f", " 31 ", "255", "256", "-1", "", "$", "1F", "$100"].map(byteOf),
    [31, 31, 31, 255, undefined, undefined, undefined, undefined, undefined, undefined]);
  assert.deepEqual([0, 127].map(addressOf), ["$80", "$FF"]);
});

const FOUND = { title: "A \"game\"\n", md5: "0".repeat(32), minimal: [0, 1, 11], score: [4, 3, 2], coding: "bcd" as const };

test("a draft has what was found", () => {
  const text = gameFile({ ...FOUND, lives: 1, livesAtStart: 4 });
  assert.match(text, /^score {4}= bcd\(0x84, 0x83, 0x82\)$/m);
  assert.match(text, /^lives {4}= ram\[0x81\]$/m);
  assert.match(text, /^terminal = lives == 0$/m);
  assert.match(text, /^reset {2}= \{ lives = 4 \}$/m);
  assert.match(text, /^title {3}= "A \\"game\\" "$/m);
  assert.match(text, /^minimal = \["NOOP", "FIRE", "RIGHTFIRE"\]$/m);
});

test("a draft says what is missing", () => {
  const text = gameFile({ ...FOUND, score: [], over: { index: 2, value: 255 } });
  assert.match(text, /^score {4}= 0 {2}# not found yet$/m);
  assert.match(text, /^terminal = ram\[0x82\] == 0xFF$/m);
  assert.match(gameFile({ ...FOUND, score: [] }), /^terminal = 0 {2}# not found yet$/m);
});

test("a draft's rule gives what its game file would give", () => {
  const bytes = ram({ 1: 3, 2: 0x01, 3: 0x23, 4: 0x45, 5: 7 });
  assert.deepEqual(outcome({ score: [4, 3, 2], coding: "bcd", lives: 1 }, bytes), { score: 12345, lives: 3, over: false });
  assert.deepEqual(outcome({ score: [4, 3], coding: "binary" }, bytes), { score: 0x2345 });
  assert.deepEqual(outcome({ score: [], coding: "bcd", over: { index: 5, value: 7 } }, bytes), { over: true });
  assert.deepEqual(outcome({ score: [4], coding: "bcd", lives: 9 }, bytes), { score: 45, lives: 0, over: true });
});

test("a score may have any number of bytes", () => {
  assert.match(gameFile({ ...FOUND, score: [0, 1, 2, 3] }), /= bcd\(0x80, 0x81, 0x82\) \+ 1000000 \* bcd\(0x83\)$/m);
  assert.match(gameFile({ ...FOUND, score: [0, 1], coding: "binary" }), /= ram\[0x80\] \+ 256 \* ram\[0x81\]$/m);
});

test("the colours of a screen come by their number", () => {
  assert.deepEqual(valuesOf(Uint8Array.of(2, 0, 2, 6, 6, 6)), [6, 2, 0]);
});
