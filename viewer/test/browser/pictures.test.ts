// The pictures of docs/viewer.md. With PICTURES=write in the environment they are made; otherwise they are compared.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { after, before, describe, test } from "node:test";
import pixelmatch from "pixelmatch";
import type { Page } from "playwright-core";
import { PNG } from "pngjs";
import { connect } from "racebeam";
import { linkTo } from "../../src/replay/link.js";
import { numberIn, Server, Tabs, until } from "./harness.js";

const FOLDER = path.join(path.dirname(new URL(import.meta.url).pathname), "../../../docs/viewer");
const TOLERANCE = 0.05; // of the pixels: other systems have other fonts

describe("the pictures of docs/viewer.md", () => {
  const server = new Server();
  const tabs = new Tabs();

  before(async () => {
    await server.start(["--listen", "tcp://127.0.0.1:0"]);
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });

  /** Compares what the page shows with a picture, or makes it. */
  async function compare(page: Page, name: string, fullPage = false): Promise<void> {
    await page.mouse.move(0, 0);
    await page.waitForTimeout(700); // marks fade
    const shot = await page.screenshot({ fullPage, caret: "hide" });
    const file = path.join(FOLDER, `${name}.png`);
    if (process.env.PICTURES === "write") {
      mkdirSync(FOLDER, { recursive: true });
      writeFileSync(file, shot);
      return;
    }
    const [seen, kept] = [PNG.sync.read(shot), PNG.sync.read(readFileSync(file))];
    assert.deepEqual([seen.width, seen.height], [kept.width, kept.height], name);
    const different = pixelmatch(seen.data, kept.data, undefined, seen.width, seen.height, { threshold: 0.2 });
    assert.ok(different <= TOLERANCE * seen.width * seen.height, `${name}: ${different} pixels differ`);
  }

  /** Plays frames of Beamfall, one by one. */
  async function play(page: Page, keys: readonly [string, number][]): Promise<void> {
    await page.getByRole("button", { name: "Play beamfall" }).waitFor();
    await page.locator("#figures").evaluate((figures: HTMLElement) => (figures.hidden = true));
    await page.locator("#stage").focus();
    let frame = 0;
    for (const [key, frames] of keys) {
      await page.keyboard.down(key);
      for (let press = 0; press < frames; ++press) {
        await page.keyboard.press("Period");
      }
      frame += frames;
      await until(async () => await numberIn(page, "#frame") === frame, `frame ${frame}`);
      await page.keyboard.up(key);
    }
    await page.locator("#stage").blur();
  }

  test("the view Play with its panels", async () => {
    const page = await tabs.open(server.address, { viewport: { width: 1280, height: 900 }, colorScheme: "dark" });
    await page.getByRole("button", { name: "Inspect" }).click();
    await play(page, [["Space", 34], ["ArrowUp", 12], ["Space", 14]]);
    await compare(page, "play", true);
    await page.context().close();
  });

  test("the view Play on a phone", async () => {
    const page = await tabs.open(server.address, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, colorScheme: "light" });
    await play(page, [["Space", 40]]);
    await compare(page, "phone");
    await page.context().close();
  });

  test("the view Watch", async () => {
    const sessions = await Promise.all([["sarsa", "beamfall", "FIRE"], ["uct", "updraft", "FIRE"], ["random", "beamfall", "UPRIGHT"]]
      .map(async ([name = "", game = "", action = ""]) => {
        const session = await connect(server.agents);
        await session.load(game, { seed: 7, sticky: 0 });
        await session.share(name);
        await session.act(`${action}*150`);
        return session;
      }));
    const page = await tabs.open(`${server.address}#watch`, { viewport: { width: 1280, height: 900 }, colorScheme: "dark" });
    await page.locator("#watched-facts").filter({ hasText: "frame150" }).waitFor();
    await page.waitForTimeout(1500); // the speed of the sessions is told anew
    await compare(page, "watch");
    await page.context().close();
    await Promise.all(sessions.map((session) => session.disconnect()));
  });

  test("the view Replay", async () => {
    const acts = Array.from({ length: 900 }, (_, at) => ["11", "12", "1", "0", "10"][(at >> 5) % 5]!);
    const link = await linkTo({ title: "An episode of Beamfall", game: "beamfall", settings: { seed: "7", sticky: "0" }, acts }, 430);
    const page = await tabs.open(`${server.address}#${link}`, { viewport: { width: 1280, height: 960 }, colorScheme: "light" });
    await page.locator("#place").filter({ hasText: "frame 430 of" }).waitFor();
    await page.locator('[data-part="facts"]').filter({ hasText: "score" }).waitFor();
    await compare(page, "replay");
    await page.context().close();
  });
});
