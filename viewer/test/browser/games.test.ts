// The list of games: titles, a filter, pictures.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { Server, Tabs, until } from "./harness.js";

const IMAGE = path.join(path.dirname(new URL(import.meta.url).pathname), "../../../games/homebrew/beamfall.bin");
const OTHERS = 12; // images that the catalogue does not know
const PADDING = 4000; // a place in the image that the game does not read

describe("the list of games", () => {
  const server = new Server();
  const tabs = new Tabs();
  let page: Page;

  before(async () => {
    const folder = path.join(server.folder, "images");
    mkdirSync(folder);
    const bytes = readFileSync(IMAGE);
    for (let number = 0; number < OTHERS; ++number) {
      bytes[PADDING] = number + 1;
      writeFileSync(path.join(folder, `own_game_${number}.bin`), bytes);
    }
    await server.start(["--roms", folder]);
    page = await tabs.open(server.address);
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  const shown = () => page.locator("#game-list li:visible").allTextContents();

  test("games of the catalogue have their titles, others their names", async () => {
    await page.getByRole("button", { name: "Updraft", exact: true }).waitFor();
    const titles = await shown();
    assert.equal(titles.length, OTHERS + 2);
    assert.ok(titles.includes("Beamfall") && titles.includes("own_game_3"), titles.join());
  });

  test("the filter leaves those that have all its words", async () => {
    const filter = page.getByLabel("Filter the games");
    await filter.fill("GAME own_game_1");
    assert.deepEqual((await shown()).sort(), ["own_game_1", "own_game_10", "own_game_11"]);
    await filter.fill("nothing like it");
    await page.getByText("No game of this server has these words.").waitFor();
    await filter.fill("");
    assert.equal((await shown()).length, OTHERS + 2);
  });

  test("games have pictures once they are in view", async () => {
    const colours = (name: string) => page.getByRole("button", { name, exact: true }).locator("canvas").evaluate((canvas: HTMLCanvasElement) =>
      new Set(new Uint32Array(canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size);
    await until(async () => await colours("Beamfall") > 3, "the picture of the first game");
    assert.equal(await colours("Updraft"), 1, "no picture before it is in view");
    await page.getByRole("button", { name: "Updraft", exact: true }).scrollIntoViewIfNeeded();
    await until(async () => await colours("Updraft") > 3, "the picture of the last game");
  });
});
