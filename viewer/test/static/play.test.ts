// The page without a server, in Chromium.

import assert from "node:assert/strict";
import { after, afterEach, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { numberIn, Tabs, until } from "../browser/harness.js";
import { Folder } from "./folder.js";

describe("the page without a server", () => {
  const tabs = new Tabs();
  const folder = new Folder();
  let page: Page;

  before(async () => {
    await folder.start();
    page = await tabs.open(folder.address);
  });
  after(async () => {
    await tabs.close();
    folder.stop();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  test("beamfall is played to a score by keys", async () => {
    await page.getByRole("button", { name: "Play Beamfall" }).click();
    await page.keyboard.down(" ");
    await page.keyboard.down("ArrowRight");
    await until(async () => await numberIn(page, "#score") > 0, "a score");
    await page.keyboard.up("ArrowRight");
    await page.keyboard.up(" ");
  });

  test("RAM is inspected while nothing is sent", async () => {
    const before = folder.asked.length;
    await page.keyboard.press("i");
    const ram = page.locator("#ram");
    const first = await ram.textContent();
    await until(async () => await ram.textContent() !== first, "other bytes");
    assert.equal(folder.asked.length, before);
  });

  test("the episode is replayed", async () => {
    await page.getByRole("button", { name: "Replay this episode" }).click();
    await page.locator("#decks").getByText("score 0 of").waitFor();
  });

  test("it offers no view of other sessions", async () => {
    assert.deepEqual(await page.locator("nav a:visible").allTextContents(), ["Play", "Replay"]);
  });
});
