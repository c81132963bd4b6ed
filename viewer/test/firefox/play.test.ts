// The page in Firefox, which is driven by WebDriver BiDi. FIREFOX names the browser.

import assert from "node:assert/strict";
import { after, afterEach, before, describe, test } from "node:test";
import puppeteer, { type Browser, type Page } from "puppeteer-core";
import { Server, until } from "../browser/harness.js";

describe("the page in Firefox", () => {
  const server = new Server();
  const problems: string[] = [];
  let browser: Browser;
  let page: Page;

  before(async () => {
    await server.start();
    browser = await puppeteer.launch({ browser: "firefox", executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr" });
    console.log(await browser.version());
    page = await browser.newPage();
    page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => {
      const url = new URL(request.url());
      if (url.host !== new URL(server.address).host && !["blob:", "data:"].includes(url.protocol)) {
        problems.push(`a request to ${url}`);
      }
    });
    await page.goto(server.address);
  });
  after(async () => {
    await browser?.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(problems.splice(0), []));

  const text = (selector: string) => page.$eval(selector, (element) => element.textContent ?? "");
  const number = async (selector: string) => Number(await text(selector));
  const press = (name: string) => page.locator(`::-p-aria(${name})`).click();

  test("beamfall is played to a score by keys", async () => {
    await press("Play Beamfall");
    await page.keyboard.down(" ");
    await page.keyboard.down("ArrowRight");
    await until(async () => await number("#score") > 0, "a score");
    await page.keyboard.up("ArrowRight");
    await page.keyboard.up(" ");
  });

  test("the picture changes", async () => {
    const picture = () => page.$eval("#screen", (canvas) => (canvas as HTMLCanvasElement).toDataURL());
    const first = await picture();
    await until(async () => await picture() !== first, "another picture");
  });

  test("the game stops and goes on", async () => {
    await page.keyboard.press("p");
    await page.waitForSelector('#stage[data-motion="paused"]');
    await page.keyboard.press("p");
    const stopped = await number("#frame");
    await until(async () => await number("#frame") > stopped + 10, "more frames");
  });

  test("the other views open", async () => {
    for (const view of ["watch", "replay"]) {
      await page.locator(`a[href="#${view}"]`).click();
      await page.waitForSelector(`#${view}-view:not([hidden])`);
    }
  });
});
