// What a player presses, as a set of bits, and the actions of the line protocol.

export const UP = 1;
export const DOWN = 2;
export const LEFT = 4;
export const RIGHT = 8;
export const FIRE = 16;
export const RESET = 32; // switches of the console, which only player A has
export const SELECT = 64;

export const ACTIONS = ["NOOP", "FIRE", "UP", "RIGHT", "LEFT", "DOWN", "UPRIGHT", "UPLEFT", "DOWNRIGHT", "DOWNLEFT", "UPFIRE", "RIGHTFIRE",
  "LEFTFIRE", "DOWNFIRE", "UPRIGHTFIRE", "UPLEFTFIRE", "DOWNRIGHTFIRE", "DOWNLEFTFIRE", "RESET", "SELECT", "LEFT_A", "LEFT_B", "RIGHT_A",
  "RIGHT_B", "COLOR", "BW"] as const;
export const JOYSTICK_ACTIONS = 18; // the others need action_set=console
export const LAST_CONTROLLER_ACTION = 177; // DOWNLEFTFIRE+TRIGGER+BOOSTER, in the table of docs/spec/controllers.md

/** One of two opposite directions, or neither. */
function either(pressed: number, one: number, other: number, names: [string, string]): string {
  const both = pressed & (one | other);
  return both === one ? names[0] : both === other ? names[1] : "";
}

/** The number of the action that presses these. Opposite directions cancel each other, and a switch releases the joystick. */
export function actionOf(pressed: number): number {
  const name = pressed & RESET ? "RESET" : pressed & SELECT ? "SELECT" : either(pressed, UP, DOWN, ["UP", "DOWN"]) + either(pressed, RIGHT, LEFT, ["RIGHT", "LEFT"]) + (pressed & FIRE ? "FIRE" : "");
  return name ? ACTIONS.indexOf(name as typeof ACTIONS[number]) : 0;
}

const MOVES = ["LEFT_A", "LEFT_B", "RIGHT_A", "RIGHT_B"]; // of the difficulty switches

/** The act that moves a difficulty switch to its other position. `bit`: 1 is the left one, 2 the right one. */
export function moveOf(bit: 1 | 2, difficulty: number): string {
  return String(ACTIONS.indexOf("LEFT_A") + 2 * (bit - 1) + (difficulty & bit ? 1 : 0));
}

/** The positions of both difficulty switches after an act. */
export function difficultyAfter(difficulty: number, act: string): number {
  const move = MOVES.indexOf(ACTIONS[Number(act.split("/")[0])] ?? "");
  const bit = move < 2 ? 1 : 2;
  return move < 0 ? difficulty : move % 2 ? difficulty & ~bit : difficulty | bit;
}

/** A word of the command `act`: what both players press. */
export function actWord(playerA: number, playerB = 0): string {
  const [a, b] = [actionOf(playerA), actionOf(playerB)];
  return b ? `${a}/${b}` : `${a}`;
}

/** Words of `act`, where equal ones that follow each other become one with its count. */
export function joinRuns(words: readonly string[]): string[] {
  const runs: [string, number][] = [];
  for (const word of words) {
    const last = runs.at(-1);
    if (last?.[0] === word) {
      ++last[1];
    } else {
      runs.push([word, 1]);
    }
  }
  return runs.map(([word, times]) => (times === 1 ? word : `${word}*${times}`));
}

/** A word of `act` for people, such as "UPFIRE" or "LEFT, FIRE". */
export function describeAct(word: string): string {
  return word.split("/").map((number) => ACTIONS[Number(number)] ?? number).join(", ");
}
