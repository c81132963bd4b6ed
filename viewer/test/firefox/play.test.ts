// The page in Firefox.

import assert from "node:assert/strict";
import { after, afterEach, before, describe, test } from "node:test";
import { Server, until } from "../browser/harness.js";
import { Firefox } from "./browser.js";

describe("the page in Firefox", () => {
  const server = new Server();
  let firefox: Firefox;

  before(async () => {
    await server.start();
    firefox = await Firefox.open(server.address);
  });
  after(async () => {
    await firefox?.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(firefox.problems(), []));

  test("beamfall is played to a score by keys", () => firefox.playToScore());

  test("the picture changes", async () => {
    const picture = () => firefox.page.$eval("#screen", (canvas) => (canvas as HTMLCanvasElement).toDataURL());
    const first = await picture();
    await until(async () => await picture() !== first, "another picture");
  });

  test("the game stops and goes on", async () => {
    await firefox.page.keyboard.press("p");
    await firefox.page.waitForSelector('#stage[data-motion="paused"]');
    await firefox.page.keyboard.press("p");
    const stopped = await firefox.number("#frame");
    await until(async () => await firefox.number("#frame") > stopped + 10, "more frames");
  });

  test("the other views open", async () => {
    for (const view of ["watch", "replay"]) {
      await firefox.page.locator(`a[href="#${view}"]`).click();
      await firefox.page.waitForSelector(`#${view}-view:not([hidden])`);
    }
  });
});
