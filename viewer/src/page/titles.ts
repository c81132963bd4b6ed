/** The titles of the catalogue's games, by their names: build.mjs puts them in. */
declare const TITLES: Readonly<Record<string, string>>;

/** The title of a game. A game of the server's own has its name. */
export function titleOf(game: string): string {
  return Object.hasOwn(TITLES, game) ? TITLES[game]! : game;
}
