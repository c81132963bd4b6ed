import assert from "node:assert/strict";
import test from "node:test";
import { History } from "../../src/play/history.js";

/** A session whose state is the text of all acts since the beginning. */
class Recorder {
  readonly states = new Map<string, string>();
  shown = "";
  readonly history: History;

  constructor(spacing: number, slots: number) {
    this.history = new History(spacing, slots);
  }

  play(act: string): void {
    const state = this.history.saves();
    if (state) {
      this.states.set(state, this.shown);
    }
    this.history.add(act);
    this.shown += act;
  }

  back(moment: number): void {
    const { state, acts } = this.history.back(moment)!;
    this.shown = this.states.get(state)! + acts.join("");
  }
}

const LETTERS = "abcdefghijklmnopqrstuvwxyz";

test("any moment that can be reached is reached exactly", () => {
  for (let moment = 0; moment <= 26; ++moment) {
    const recorder = new Recorder(4, 5);
    [...LETTERS].forEach((act) => recorder.play(act));
    const { earliest } = recorder.history;
    recorder.back(moment);
    assert.equal(recorder.shown, LETTERS.slice(0, Math.max(earliest, moment)));
    assert.equal(recorder.history.now, recorder.shown.length);
  }
});

test("there are never more states than slots", () => {
  const recorder = new Recorder(2, 3);
  [...LETTERS].forEach((act) => recorder.play(act));
  assert.equal(recorder.states.size, 3);
  assert.equal(recorder.history.earliest, 20);
});

test("one may go back and play on, again and again", () => {
  const recorder = new Recorder(3, 4);
  let expected = "";
  for (let round = 0; round < 200; ++round) {
    const act = LETTERS[round % 26]!;
    recorder.play(act);
    expected += act;
    if (round % 5 === 4) {
      recorder.back(recorder.history.now - (round % 7));
      expected = expected.slice(0, recorder.history.now);
    }
    assert.equal(recorder.shown, expected);
  }
});

test("before the first act, the history cannot go back", () => {
  assert.equal(new History(3, 4).back(0), undefined);
});

test("scores belong to moments", () => {
  const history = new History(4, 4);
  for (const act of ["a", "b", "c"]) {
    history.saves();
    history.add(act);
  }
  [1, 2, 3].forEach((moment) => history.reward(moment, 10));
  assert.equal(history.score(3), 30);
  history.back(1);
  assert.equal(history.score(1), 10);
  history.reward(3, 10); // the reply to an act that was taken back
  assert.equal(history.score(3), 0);
  history.begin();
  assert.equal(history.score(1), 0);
});

test("the difficulty switches are where the acts moved them, also after a way back", () => {
  const history = new History(2, 8);
  history.begin(2);
  const after = ["0", "20", "0", "23", "22/1", "21"].map((act) => (history.saves(), history.add(act), history.difficulty));
  assert.deepEqual(after, [2, 3, 3, 1, 3, 2]);
  for (const [moment, difficulty] of [[5, 3], [4, 1], [2, 3], [1, 2], [0, 2]] as const) {
    history.back(moment);
    assert.equal(history.difficulty, difficulty);
  }
});
