/** The titles of the catalogue's games, by their names: build.mjs puts them in. */
declare const TITLES: Readonly<Record<string, string>>;

const own = new Map<string, string>(); // titles of images that the user has added, by their MD5s

/** The title of a game. A game of the server's own has its name. */
export function titleOf(game: string): string {
  return own.get(game) ?? (Object.hasOwn(TITLES, game) ? TITLES[game]! : game);
}

/** Remembers an image that the user has added, and the game that it was recognised as. */
export function nameOwn(md5: string, game: string): void {
  own.set(md5, `${titleOf(game)}, your image`);
}

/** Whether the user has added an image with this MD5. */
export function isOwn(md5: string): boolean {
  return own.has(md5);
}
