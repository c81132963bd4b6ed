import { DOWN, FIRE, LEFT, RESET, RIGHT, SELECT, UP } from "./actions.js";

const TILT = 0.5; // of an axis, which counts as a direction

/** Buttons of the standard gamepad. */
const BUTTONS: readonly (readonly [number, number])[] = [[12, UP], [13, DOWN], [14, LEFT], [15, RIGHT], [0, FIRE], [1, FIRE], [2, FIRE], [3, FIRE],
  [8, SELECT], [9, RESET]];

/** What a gamepad presses. */
export function pressedOn({ axes, buttons }: Pick<Gamepad, "axes" | "buttons">): number {
  const [x = 0, y = 0] = axes;
  let bits = (x < -TILT ? LEFT : 0) | (x > TILT ? RIGHT : 0) | (y < -TILT ? UP : 0) | (y > TILT ? DOWN : 0);
  for (const [number, bit] of BUTTONS) {
    bits |= buttons[number]?.pressed ? bit : 0;
  }
  return bits;
}

/** What a player presses on the player's gamepad: player 0 has the first one. */
export function gamepad(player: number): number {
  const pad = navigator.getGamepads().filter((each) => each !== null)[player];
  return pad ? pressedOn(pad) : 0;
}
