// Prints the table of docs/viewer.md about the page without a server, build/viewer-static, in Chromium and in Firefox. SECONDS: of play,
// but at most 15, since Beamfall is over after 20 seconds without a key.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tabs } from "../browser/harness.js";
import { Firefox } from "../firefox/browser.js";
import { Folder } from "../static/folder.js";

const SECONDS = Math.min(15, Number(process.env.SECONDS ?? 20));
const LOADS = 11;

const tabs = new Tabs();
const folder = new Folder();
let firefox: Firefox;

/** What both drivers of browsers have. */
interface Page {
  waitForFunction(condition: () => boolean): Promise<unknown>;
  evaluate<Result>(what: () => Result): Promise<Result>;
  click(selector: string): Promise<void>;
}

/** Milliseconds from the request for the page until a game can be chosen. */
async function loaded(page: Page): Promise<number> {
  await page.waitForFunction(() => document.querySelector("#start")?.textContent === "Play Beamfall");
  return page.evaluate(() => performance.now());
}

async function now(page: Page): Promise<{ milliseconds: number; frame: number; line: string }> {
  return page.evaluate(() => ({ milliseconds: performance.now(), frame: Number(document.querySelector("#frame")?.textContent),
    line: document.querySelector("#figures")?.textContent ?? "" }));
}

/** The cells of a browser's column. `open` loads the page. */
async function column(open: () => Promise<Page>): Promise<string[]> {
  const loads: number[] = [];
  for (let load = 0; load < LOADS; ++load) {
    loads.push(await loaded(await open()));
  }
  loads.sort((a, b) => a - b);
  const page = await open();
  await loaded(page);
  await page.click("#start");
  await new Promise((resolve) => setTimeout(resolve, 1500));
  const first = await now(page);
  await new Promise((resolve) => setTimeout(resolve, 1000 * SECONDS));
  const last = await now(page);
  const line = /(\d+) pictures\/s .* sound (\w+, \d+ gaps)/.exec(last.line);
  assert.ok(line, last.line);
  const frames = 1000 * (last.frame - first.frame) / (last.milliseconds - first.milliseconds);
  return [loads[(LOADS - 1) / 2]!.toFixed(0), loads[LOADS - 1]!.toFixed(0), frames.toFixed(1), line[1]!, line[2]!];
}

before(() => folder.start());
after(async () => {
  await tabs.close();
  await firefox?.close();
  folder.stop();
});

test("figures of the page without a server", async () => {
  const chromium = await column(() => tabs.open(folder.address));
  firefox = await Firefox.open(folder.address);
  const other = await column(async () => {
    await firefox.page.goto(folder.address);
    return firefox.page;
  });
  const rows = [`until a game can be chosen, ms: middle of ${LOADS} loads`, "the longest of them, ms", "frames a second", "pictures a second at the end",
    "sound"];
  console.log(["| what | Chromium | Firefox |", "|---|---:|---:|", ...rows.map((row, k) => `| ${row} | ${chromium[k]!} | ${other[k]!} |`)].join("\n"));
});
