import type { Group } from "racebeam";
import { byId, offer } from "../page/elements.js";
import type { Choice, Game } from "./player.js";

function list(value: unknown): string[] {
  return String(value ?? "").split(",").filter(Boolean);
}

/** The lists of games, modes and difficulties. */
export class GameChoice {
  /** Called when the user has chosen. */
  chosen: (choice: Choice) => void = () => {};

  readonly #game = byId("game", HTMLSelectElement);
  readonly #mode = byId("mode", HTMLSelectElement);
  readonly #difficulty = byId("difficulty", HTMLSelectElement);

  constructor() {
    this.#game.onchange = () => this.chosen({ game: this.#game.value });
    this.#mode.onchange = this.#difficulty.onchange = () =>
      this.chosen({ game: this.#game.value, mode: Number(this.#mode.value), difficulty: Number(this.#difficulty.value) });
  }

  /** Offers games. */
  offer(games: readonly string[]): void {
    offer(this.#game, games.map((name) => [name, name]), games[0]);
  }

  /** Shows a game that was loaded, and offers its modes and difficulties. `described`: the reply of `games GAME`. */
  show(game: Game, described: Group): void {
    const two = new Set(list(described.two_player_modes));
    const modes = new Set([...list(described.modes), ...two]);
    this.#game.value = game.name;
    offer(this.#mode, [...modes].map((mode) => [mode, two.has(mode) ? `${mode}, two players` : mode]), String(game.mode));
    offer(this.#difficulty, list(described.difficulties).map((each) => [each, each]), String(game.difficulty));
  }
}
