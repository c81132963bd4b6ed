import assert from "node:assert/strict";
import test from "node:test";
import { Resampler } from "../../src/sound/resampler.js";

const INPUT = 30720;
const OUTPUT = 48000;
const TONE = 480; // a second

/** A frame of a tone, as bytes. */
function frame(number: number, size = 512): Uint8Array {
  return Uint8Array.from({ length: size }, (_, at) => 128 + Math.round(100 * Math.sin((2 * Math.PI * TONE * (number * size + at)) / INPUT)));
}

/** The sound of some seconds. `fills(second)`: frames a second of the machine. */
function played(seconds: number, fills: (second: number) => number): { sound: Float32Array; resampler: Resampler } {
  const resampler = new Resampler(INPUT, OUTPUT);
  const sound = new Float32Array(seconds * OUTPUT);
  let frames = 0;
  let pushed = 0;
  for (let at = 0; at < sound.length; at += 128) {
    for (frames += (fills(at / OUTPUT) * 128) / OUTPUT; pushed < Math.floor(frames);) {
      resampler.push(frame(pushed++));
    }
    resampler.pull(sound.subarray(at, at + 128));
  }
  return { sound, resampler };
}

/** The largest step between two samples. */
function largestStep(sound: Float32Array): number {
  let most = 0;
  for (let at = 1; at < sound.length; ++at) {
    most = Math.max(most, Math.abs(sound[at]! - sound[at - 1]!));
  }
  return most;
}

const SMOOTH = (100 / 128) * 2 * Math.PI * (TONE / OUTPUT) * 1.3 + 0.02; // the steepest of the tone, bytes rounded, and a fade

for (const rate of [59.8, 60, 60.2]) {
  test(`a machine of ${rate} frames a second sounds without gaps`, () => {
    const { sound, resampler } = played(20, () => rate);
    assert.equal(resampler.gaps, 0);
    assert.ok(largestStep(sound) < SMOOTH, `a step of ${largestStep(sound)}`);
    assert.ok(resampler.waiting > 500 && resampler.waiting < 4000, `${resampler.waiting} samples wait`);
  });
}

test("the sound fades when the machine pauses, and comes again", () => {
  const { sound, resampler } = played(4, (second) => (second > 1 && second < 2 ? 0 : 60));
  assert.equal(resampler.gaps, 1);
  assert.ok(largestStep(sound) < SMOOTH, `a step of ${largestStep(sound)}`);
  assert.ok(sound.subarray(1.5 * OUTPUT, 1.9 * OUTPUT).every((sample) => sample === 0));
  assert.ok(sound.subarray(3 * OUTPUT).some((sample) => sample > 0.5));
});

test("a burst of frames is skipped, so that the sound stays near the picture", () => {
  const resampler = new Resampler(INPUT, OUTPUT);
  for (let number = 0; number < 100; ++number) {
    resampler.push(frame(number));
  }
  assert.ok(resampler.waiting < INPUT * 0.25);
});

test("128 is silence", () => {
  const resampler = new Resampler(INPUT, OUTPUT);
  resampler.push(new Uint8Array(5000).fill(128));
  const sound = new Float32Array(1000);
  resampler.pull(sound);
  assert.ok(sound.every((sample) => sample === 0));
});
