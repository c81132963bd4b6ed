import assert from "node:assert/strict";
import test from "node:test";
import { ACTIONS, actionOf, actWord, DOWN, FIRE, joinRuns, JOYSTICK_ACTIONS, LEFT, moveOf, RESET, RIGHT, SELECT, describeAct, UP } from "../../src/input/actions.js";
import { pressedOn } from "../../src/input/gamepad.js";
import { directionAt } from "../../src/input/touch.js";

test("each combination of direction and button is an action of its own", () => {
  const pressed = [0, UP, DOWN].flatMap((y) => [0, LEFT, RIGHT].flatMap((x) => [0, FIRE].map((fire) => x | y | fire)));
  assert.deepEqual(pressed.map(actionOf).sort((a, b) => a - b), Array.from({ length: JOYSTICK_ACTIONS }, (_, action) => action));
  assert.equal(ACTIONS[actionOf(UP | RIGHT | FIRE)], "UPRIGHTFIRE");
  assert.equal(ACTIONS[actionOf(DOWN | LEFT)], "DOWNLEFT");
});

test("opposite directions cancel each other", () => {
  assert.equal(ACTIONS[actionOf(LEFT | RIGHT | UP)], "UP");
  assert.equal(actionOf(LEFT | RIGHT | UP | DOWN), 0);
});

test("a switch of the console releases the joystick", () => {
  assert.equal(ACTIONS[actionOf(RESET | UP | FIRE)], "RESET");
  assert.equal(ACTIONS[actionOf(SELECT | LEFT)], "SELECT");
  assert.equal(actWord(SELECT, FIRE), "19/1");
});

test("a difficulty switch moves to its other position", () => {
  const moves = [0, 1, 2, 3].map((difficulty) => [1, 2].map((bit) => ACTIONS[Number(moveOf(bit as 1 | 2, difficulty))]));
  assert.deepEqual(moves, [["LEFT_A", "RIGHT_A"], ["LEFT_B", "RIGHT_A"], ["LEFT_A", "RIGHT_B"], ["LEFT_B", "RIGHT_B"]]);
});

test("an act has player B if B presses something", () => {
  assert.equal(actWord(FIRE), "1");
  assert.equal(actWord(0, FIRE), "0/1");
  assert.equal(describeAct("0/1"), "NOOP, FIRE");
});

test("equal acts in a row are one word", () => {
  assert.deepEqual(joinRuns(["1", "1", "1", "0/2", "1", "1"]), ["1*3", "0/2", "1*2"]);
  assert.deepEqual(joinRuns([]), []);
});

test("a gamepad has a stick, a cross and buttons", () => {
  const button = (pressed: boolean) => ({ pressed, touched: pressed, value: Number(pressed) });
  const pad = (axes: number[], down: number[]) => pressedOn({ axes, buttons: Array.from({ length: 16 }, (_, at) => button(down.includes(at))) });
  assert.equal(pad([-1, 0.9], []), LEFT | DOWN);
  assert.equal(pad([0.3, -0.3], []), 0);
  assert.equal(pad([], [12, 15, 0]), UP | RIGHT | FIRE);
  assert.equal(pad([], [8, 9]), SELECT | RESET);
});

test("a thumb points in eight directions, or rests", () => {
  assert.equal(directionAt(0.1, 0.1), 0);
  assert.deepEqual([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]].map(([x, y]) => directionAt(x!, y!)),
    [RIGHT, RIGHT | DOWN, DOWN, DOWN | LEFT, LEFT, LEFT | UP, UP, UP | RIGHT]);
});
