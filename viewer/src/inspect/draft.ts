// A draft of a game file, games/catalogue/README.md, from what the user found in memory.

import { ACTIONS } from "../input/actions.js";

export interface Findings {
  title: string;
  md5: string;
  minimal: readonly number[];
  /** Indices of the bytes of the score, the least significant first. */
  score: readonly number[];
  /** bcd: two decimal digits a byte. */
  coding: "bcd" | "binary";
  /** Index of the byte that counts lives. */
  lives?: number;
  /** Lives when an episode begins. */
  livesAtStart?: number;
  /** The game is over when this byte has this value. */
  over?: { index: number; value: number };
}

const MOST_BCD = 3; // bytes of bcd()

function hex(value: number): string {
  return `0x${value.toString(16).toUpperCase().padStart(2, "0")}`;
}

function address(index: number): string {
  return hex(index + 0x80);
}

/** An expression for the score. */
function score(indices: readonly number[], coding: "bcd" | "binary"): string {
  if (coding === "binary") {
    return indices.map((index, place) => (place ? `${256 ** place} * ram[${address(index)}]` : `ram[${address(index)}]`)).join(" + ");
  }
  const parts: string[] = [];
  for (let at = 0; at < indices.length; at += MOST_BCD) {
    const part = `bcd(${indices.slice(at, at + MOST_BCD).map(address).join(", ")})`;
    parts.push(at ? `${100 ** at} * ${part}` : part);
  }
  return parts.join(" + ");
}

/** What the rule of the game file gives for these bytes of RAM. */
export interface Outcome {
  score?: number;
  lives?: number;
  over?: boolean;
}

/** The decimal number of bytes with two digits each, as the game file's bcd() reads them: digits are not checked. */
function decimal(bytes: readonly number[]): number {
  return bytes.reduce((sum, byte, place) => sum + (10 * (byte >> 4) + (byte & 15)) * 100 ** place, 0);
}

/** Does what the rule of gameFile() would do with these bytes of RAM. Leaves out what was not found. */
export function outcome({ score: indices, coding, lives, over }: Pick<Findings, "score" | "coding" | "lives" | "over">, ram: Uint8Array): Outcome {
  const bytes = indices.map((index) => ram[index] ?? 0);
  const left = lives === undefined ? undefined : ram[lives] ?? 0;
  return {
    ...(bytes.length ? { score: coding === "bcd" ? decimal(bytes) : bytes.reduce((sum, byte, place) => sum + byte * 256 ** place, 0) } : {}),
    ...(left === undefined ? {} : { lives: left }),
    ...(over ? { over: ram[over.index] === over.value } : left === undefined ? {} : { over: left === 0 }),
  };
}

function terminal({ over, lives }: Findings): string {
  return over ? `ram[${address(over.index)}] == ${hex(over.value)}` : lives === undefined ? "0" : "lives == 0";
}

/** A text in TOML's quotes. */
function quote(text: string): string {
  return JSON.stringify(text.replace(/[\x00-\x1f\x7f]/g, " "));
}

/** The text of a game file. */
export function gameFile(findings: Findings): string {
  const { title, md5, minimal, lives, livesAtStart } = findings;
  const step = [
    `score    = ${findings.score.length ? score(findings.score, findings.coding) : "0  # not found yet"}`,
    ...(lives === undefined ? [] : [`lives    = ram[${address(lives)}]`]),
    `terminal = ${terminal(findings)}${terminal(findings) === "0" ? "  # not found yet" : ""}`,
  ];
  return [
    `# ${title.replace(/\s+/g, " ")}: a draft from the memory search of the viewer`,
    "",
    `title   = ${quote(title)}`,
    `minimal = [${minimal.map((action) => `"${ACTIONS[action]}"`).join(", ")}]`,
    "",
    "[[image]]",
    `md5 = "${md5}"`,
    "",
    "[rule]",
    'source = "racebeam"',
    ...(lives === undefined || livesAtStart === undefined ? [] : [`reset  = { lives = ${livesAtStart} }`]),
    "step   = '''",
    ...step,
    "'''",
    "",
  ].join("\n");
}
