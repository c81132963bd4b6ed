import assert from "node:assert/strict";
import test from "node:test";
import { deflateSync } from "node:zlib";
import { applyDelta, base64, hex, rle, ScreenStack, zlib } from "../src/index.js";

const BYTES = Uint8Array.of(0, 0, 0, 255, 255, 26);

test("each encoding gives the bytes", () => {
  assert.deepEqual(hex("000000FFFF1A"), BYTES);
  assert.deepEqual(rle("0003FF021A01"), BYTES);
  assert.deepEqual(base64("AAAA//8a"), BYTES);
  assert.deepEqual(zlib(deflateSync(BYTES).toString("base64")), BYTES);
  const array = new Uint8Array(6);
  applyDelta(array, "000301FF020000011A01");
  applyDelta(array, "");
  assert.deepEqual(array, BYTES);
});

test("what is damaged is refused", () => {
  const damaged = { hex: ["0", "0G", "G0", "\u01000"], rle: ["00", "0"], base64: ["!AAA", "AAA", "A==="], zlib: ["AAAA", "eJxjYGD4"] };
  for (const [name, texts] of Object.entries(damaged)) {
    for (const text of texts) {
      assert.throws(() => ({ hex, rle, base64, zlib })[name](text), RangeError, `${name} ${text}`);
    }
  }
  for (const text of ["00", "000001", "00000101", "0006010101", "FFFF01AAFF"]) {
    assert.throws(() => applyDelta(new Uint8Array(6), text), RangeError, text);
  }
});

test("a stack has the last screens", () => {
  const stack = new ScreenStack(3);
  assert.deepEqual(stack.push(Uint8Array.of(1, 2)), Uint8Array.of(0, 0, 0, 0, 1, 2));
  stack.push(Uint8Array.of(3, 4));
  stack.push(Uint8Array.of(5, 6));
  assert.deepEqual(stack.push(Uint8Array.of(7, 8)), Uint8Array.of(3, 4, 5, 6, 7, 8));
  stack.clear();
  assert.deepEqual(stack.push(Uint8Array.of(9, 9)), Uint8Array.of(0, 0, 0, 0, 9, 9));
});
