// A person's image in the page without a server, in Chromium.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { after, afterEach, before, describe, test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Page } from "playwright-core";
import { addImage, open } from "racebeam/wasm";
import { numberIn, Tabs, until } from "../browser/harness.js";
import { changedImage, Folder, source } from "./folder.js";

const REFUSED: readonly (readonly [string, Uint8Array, string])[] = [
  ["empty.bin", new Uint8Array(), "image empty.bin: the file is empty."],
  ["large.bin", new Uint8Array(524289), "image large.bin: larger than the largest image, 524288 bytes."],
  ["huge.bin", new Uint8Array(2 ** 24 + 1), "huge.bin: larger than 16777216 bytes."],
  ["odd.bin", new Uint8Array(3000), "no cartridge scheme fits an image of 3000 bytes"],
  ["cut.gz", gzipSync(source("games/homebrew/updraft.bin")).subarray(0, 900), "image cut.gz: the gzip file is truncated."],
  ["a.zip", new TextEncoder().encode("PK\x03\x04 and no more"), "image a.zip: the zip archive is damaged."],
  ["a.toml", new Uint8Array(), "A game file belongs to an image: choose both at once."],
];

describe("an image from disk", () => {
  const tabs = new Tabs();
  const folder = new Folder();
  const requests: string[] = [];
  let page: Page;

  before(async () => {
    await folder.start();
    page = await tabs.open(folder.address);
    await page.getByRole("button", { name: "Play Beamfall" }).waitFor();
    const loaded = new Set(folder.asked);
    assert.deepEqual([...loaded].sort(), ["favicon.svg", "index.html", "racebeam.wasm", "viewer.css", "viewer.js", "worker.js"]);
    page.on("request", (request) => requests.push(request.url()));
  });
  after(async () => {
    await tabs.close();
    folder.stop();
  });
  /** After the page, only its script for sound and its picture are loaded: requests of which none has anything of the image. */
  afterEach(() => {
    assert.deepEqual(tabs.problems(), []);
    assert.deepEqual(requests.splice(0).filter((url) => !allowed().includes(url)), []);
  });
  const allowed = () => ["sound.js", "favicon.svg"].map((name) => folder.address + name);

  const choose = (...files: string[]) => page.locator("#image-files").setInputFiles(files);

  /** Plays the image that is loaded until the condition holds. */
  async function play(condition: () => Promise<boolean>, what: string): Promise<void> {
    await page.locator("#start").click();
    await page.keyboard.down(" ");
    await page.keyboard.down("ArrowRight");
    await until(condition, what);
    await page.keyboard.up("ArrowRight");
    await page.keyboard.up(" ");
  }

  test("an image that no game file lists is played without score", async () => {
    await choose(folder.onDisk("Mine.bin", changedImage("updraft")));
    await page.getByRole("button", { name: "Play mine, your image" }).waitFor();
    await page.getByText("No rule is known for it").waitFor();
    await play(async () => await numberIn(page, "#frame") > 120, "120 frames");
    assert.equal(await numberIn(page, "#score"), 0);
  });

  test("its memory is inspected and searched", async () => {
    await page.keyboard.press("i");
    const ram = page.locator("#ram");
    const first = await ram.textContent();
    await until(async () => await ram.textContent() !== first, "other bytes");
    await page.keyboard.press("p");
    await page.locator("[data-compare=changed]").click();
    await until(async () => /^\d+ of 128 bytes/.test(await page.locator("#found").textContent() ?? ""), "bytes that changed");
    assert.ok(parseInt(await page.locator("#found").textContent() ?? "") < 128);
  });

  test("its episode is replayed", async () => {
    await page.getByRole("button", { name: "Replay this episode" }).click();
    await page.locator("#decks").getByText("mine, your image, played here").waitFor();
    await page.locator("#decks").getByText("score 0 of").waitFor();
    await page.getByRole("button", { name: "Close" }).click();
  });

  test("a log of it plays as logged", async () => {
    const bytes = changedImage("updraft");
    const wasm = source("build/viewer-static/racebeam.wasm");
    const game = await open({ source: wasm as BufferSource });
    const { md5 } = await addImage(Object.assign(new Blob([bytes as BlobPart]), { name: "mine.bin" }), { source: wasm as BufferSource });
    assert.equal(md5, createHash("md5").update(bytes).digest("hex"));
    await game.load(md5, { as: "updraft", seed: 3, max_episode_frames: 400 });
    await game.request("log", "inline");
    await game.reset();
    await game.act("RIGHT*400");
    const [{ data }] = await game.request("log", "last") as [{ data: string }];
    await page.locator("#log").setInputFiles(folder.onDisk("0.episode", Buffer.from(data, "base64")));
    await page.locator("#decks").getByText("plays as logged").waitFor();
    await page.locator('nav a[href="#play"]').click();
    await game.disconnect();
  });

  test("a game file that is dropped with an image scores it", async () => {
    const files = [["other.bin.gz", gzipSync(changedImage("beamfall"))], ["mine.toml", source("games/catalogue/beamfall.toml")]] as const;
    const packed = files.map(([name, bytes]) => [name, Array.from(bytes)] as const);
    const dataTransfer = await page.evaluateHandle((given) => {
      const dropped = new DataTransfer();
      given.forEach(([name, bytes]) => dropped.items.add(new File([Uint8Array.from(bytes)], name)));
      return dropped;
    }, packed);
    await page.locator("#play-view").dispatchEvent("drop", { dataTransfer });
    await page.getByRole("button", { name: "Play mine, your image" }).waitFor();
    await play(async () => await numberIn(page, "#score") > 0, "a score");
    assert.equal(await page.locator("#image-remark").textContent(), "");
  });

  test("a known image is recognised by its MD5", async () => {
    await choose(folder.onDisk("any.name", source("games/homebrew/updraft.bin")));
    await page.getByRole("button", { name: "Play Updraft, your image" }).waitFor();
  });

  test("what cannot be played is refused in a sentence, and the game stays", async () => {
    const title = await page.locator("#start").textContent();
    for (const [name, bytes, sentence] of REFUSED) {
      await choose(folder.onDisk(name, bytes));
      await page.locator("#image-problem", { hasText: sentence }).waitFor();
    }
    assert.equal(await page.locator("#start").textContent(), title);
  });
});
