// The page without a server, in Chromium: build/viewer-static, as scripts/viewer --static makes it.

import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import path from "node:path";
import { after, afterEach, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { numberIn, Tabs, until } from "../browser/harness.js";

const FOLDER = path.resolve("../build/viewer-static");
const TYPES: Record<string, string> = { ".css": "text/css", ".html": "text/html", ".js": "text/javascript", ".svg": "image/svg+xml" };

describe("the page without a server", () => {
  const tabs = new Tabs();
  const asked: string[] = [];
  const files = createServer(({ url = "/" }, reply) => {
    const name = url === "/" ? "index.html" : url.slice(1);
    asked.push(name);
    reply.setHeader("Content-Type", TYPES[path.extname(name)] ?? "application/octet-stream");
    reply.end(readFileSync(path.join(FOLDER, name)));
  });
  let page: Page;

  before(async () => {
    await once(files.listen(0, "127.0.0.1"), "listening");
    page = await tabs.open(`http://127.0.0.1:${(files.address() as AddressInfo).port}/`);
  });
  after(async () => {
    await tabs.close();
    files.close();
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
    const before = asked.length;
    await page.keyboard.press("i");
    const ram = page.locator("#ram");
    const first = await ram.textContent();
    await until(async () => await ram.textContent() !== first, "other bytes");
    assert.equal(asked.length, before);
  });

  test("the episode is replayed", async () => {
    await page.getByRole("button", { name: "Replay this episode" }).click();
    await page.locator("#decks").getByText("score 0 of").waitFor();
  });
});
