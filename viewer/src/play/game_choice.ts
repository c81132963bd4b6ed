import type { Group } from "racebeam";
import { byId, offer, tell } from "../page/elements.js";
import { GameList } from "./game_list.js";
import type { Pictures } from "./pictures.js";
import type { Choice, Game } from "./player.js";

/** The difficulty switches: button, side, and the bit that stands for A. */
const SWITCHES = [["left-switch", "Left", 1], ["right-switch", "Right", 2]] as const;

function list(value: unknown): string[] {
  return String(value ?? "").split(",").filter(Boolean);
}

/** The games, and the modes and difficulties of the one that is loaded. */
export class GameChoice {
  /** Called when the user has chosen. */
  onChoose: (choice: Choice) => void = () => {};
  /** Called when the user moves a difficulty switch: 1 is the left one, 2 the right one. */
  onMoveSwitch: (bit: 1 | 2) => void = () => {};

  readonly #games: GameList;
  readonly #mode = byId("mode", HTMLSelectElement);
  #game: Game | undefined;
  #difficulty = 0;
  #difficulties: readonly number[] = [];

  constructor(pictures: Pictures) {
    this.#games = new GameList(pictures);
    this.#games.onChoose = (game) => this.onChoose({ game });
    this.#mode.onchange = () => this.#choose({ mode: Number(this.#mode.value) });
    for (const [id, , bit] of SWITCHES) {
      const button = byId(id, HTMLButtonElement);
      button.onclick = () => this.onMoveSwitch(bit);
      button.onmousedown = (event) => event.preventDefault(); // the game keeps the focus
    }
  }

  /** Offers games. */
  offer(games: readonly string[]): void {
    this.#games.offer(games);
  }

  /** Shows a game that was loaded, its modes and its difficulties. `described`: the reply of `games GAME`. */
  show(game: Game, described: Group, difficulties: readonly number[]): void {
    this.#game = game;
    this.#games.mark(game.key);
    const two = new Set(list(described.two_player_modes));
    const modes = new Set([...list(described.modes), ...two]);
    offer(this.#mode, [...modes].map((mode) => [mode, two.has(mode) ? `${mode}, two players` : mode]), String(game.mode));
    this.#difficulties = difficulties;
    this.showSwitches(game.difficulty);
  }

  /** Shows where the difficulty switches are. One that the game has no use for is disabled. */
  showSwitches(difficulty: number): void {
    this.#difficulty = difficulty;
    for (const [id, side, bit] of SWITCHES) {
      const button = byId(id, HTMLButtonElement);
      button.disabled = !this.#difficulties.includes(difficulty ^ bit);
      tell(byId(`${id}-text`, HTMLElement), `${side}: ${difficulty & bit ? "A" : "B"}`);
    }
  }

  #choose(change: Partial<Choice>): void {
    if (this.#game) {
      const { key: game, mode } = this.#game;
      this.onChoose({ game, mode, difficulty: this.#difficulty, ...change });
    }
  }
}
