// The page without a server, in Firefox. FIREFOX names the browser.

import assert from "node:assert/strict";
import { after, afterEach, before, describe, test } from "node:test";
import { Firefox } from "../firefox/browser.js";
import { until } from "../browser/harness.js";
import { changedImage, Folder } from "./folder.js";

describe("the page without a server in Firefox", () => {
  const folder = new Folder();
  let firefox: Firefox;

  before(async () => {
    await folder.start();
    firefox = await Firefox.open(folder.address);
  });
  after(async () => {
    await firefox?.close();
    folder.stop();
  });
  afterEach(() => assert.deepEqual(firefox.problems(), []));

  test("beamfall is played to a score by keys", () => firefox.playToScore());

  test("an image from disk is played, and nothing is sent", async () => {
    const before = folder.asked.length;
    const input = await (await firefox.page.$("#image-files"))!.toElement("input");
    await input.uploadFile(folder.onDisk("mine.bin", changedImage("updraft")));
    await firefox.press("Play mine, your image");
    await until(async () => await firefox.number("#frame") > 60, "60 frames");
    assert.equal(folder.asked.length, before);
  });

  test("its memory is inspected and searched", async () => {
    await firefox.page.keyboard.press("i");
    const first = await firefox.text("#ram");
    await until(async () => await firefox.text("#ram") !== first, "other bytes");
    await firefox.page.keyboard.press("p");
    await (await firefox.page.$("[data-compare=changed]"))!.click();
    await until(async () => parseInt(await firefox.text("#found")) < 128, "bytes that changed");
  });
});
