import assert from "node:assert/strict";
import test from "node:test";
import { Pacer } from "../../src/play/pacer.js";

/** The frames at each tick of a display, whose ticks come up to `jitter` milliseconds late. */
function frames(display: number, seconds: number, { rate = 60, jitter = 0 } = {}): number[] {
  const pacer = new Pacer(rate);
  return Array.from({ length: Math.round(display * seconds) + 1 }, (_, tick) => pacer.due((1000 * tick) / display + jitter * ((tick * 7) % 5) / 4));
}

const sum = (numbers: number[]) => numbers.reduce((a, b) => a + b, 0);

for (const display of [30, 50, 59.94, 60, 75, 120, 144, 240]) {
  test(`a display of ${display} Hz gets 60 frames a second`, () => {
    const total = sum(frames(display, 60));
    assert.ok(Math.abs(total - 3600) <= 1, `${total} frames`);
  });
}

test("a display of 60 Hz gets one frame a tick, although its ticks jitter", () => {
  assert.deepEqual(new Set(frames(60, 60, { jitter: 1.2 }).slice(1)), new Set([1]));
});

test("a display of 144 Hz never gets two frames at once", () => {
  assert.equal(Math.max(...frames(144, 10, { jitter: 0.5 })), 1);
});

test("PAL has 50 frames a second", () => {
  assert.ok(Math.abs(sum(frames(60, 60, { rate: 50 })) - 3000) <= 1);
});

test("time in which the tab slept is forgotten", () => {
  const pacer = new Pacer(60);
  pacer.due(0);
  assert.equal(pacer.due(3_600_000), 1);
  assert.equal(pacer.due(3_600_017), 1);
});

test("the first tick after a restart has no frame", () => {
  const pacer = new Pacer(60);
  pacer.due(0);
  pacer.restart();
  assert.equal(pacer.due(100), 0);
});
