// What the page does about the server: tokens, an end, a beginning.

import assert from "node:assert/strict";
import { once } from "node:events";
import { writeFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import path from "node:path";
import { after, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { isDeepStrictEqual } from "node:util";
import { numberIn, paused, Server, Tabs, until } from "./harness.js";

const TOKEN = "a-token-of-the-tests-0123456789";

describe("the server", () => {
  const server = new Server();
  const tabs = new Tabs();
  const tokens = path.join(server.folder, "tokens");

  before(async () => {
    writeFileSync(tokens, `${TOKEN}\n`, { mode: 0o600 });
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });

  async function answer(page: Page, token: string): Promise<void> {
    await page.getByLabel("Token", { exact: true }).fill(token);
    await page.getByRole("button", { name: "Connect" }).click();
  }

  test("a token is asked for, and a wrong one refused", async () => {
    await server.start(["--token-file", tokens]);
    const page = await tabs.open(server.address);
    await answer(page, "wrong");
    await page.getByText("The server refused this token.").waitFor();
    await answer(page, TOKEN);
    await page.getByRole("button", { name: "Play beamfall" }).waitFor();
    assert.deepEqual(tabs.problems(), []);
    await page.context().close();
  });

  test("three wrong tokens end the session, and the page asks again", async () => {
    const page = await tabs.open(server.address);
    for (let attempt = 0; attempt < 4; ++attempt) {
      await answer(page, `wrong${attempt}`);
      await page.getByLabel("Token", { exact: true }).waitFor();
    }
    await answer(page, TOKEN);
    await page.getByRole("button", { name: "Play beamfall" }).waitFor();
    await page.context().close();
    tabs.problems();
  });

  test("the address may have the game, and the token, which then vanishes from it", async () => {
    const page = await tabs.open(`${server.address}?game=updraft#token=${TOKEN}`);
    await page.getByRole("button", { name: "Play updraft" }).waitFor();
    assert.ok(!page.url().includes(TOKEN));
    assert.ok(page.url().endsWith("?game=updraft"));
    assert.deepEqual(tabs.problems(), []);
    await page.context().close();
  });

  test("a game in the address that the server does not have is named", async () => {
    const page = await tabs.open(`${server.address}?game=<b>nothing#token=${TOKEN}`);
    await page.getByText('This server has no game "<b>nothing".').waitFor();
    await page.getByRole("button", { name: "Play beamfall" }).waitFor();
    assert.deepEqual(tabs.problems(), []);
    await page.context().close();
    await server.stop();
  });

  test("a page of another origin gets no session, unless the server allows its origin", async () => {
    const stranger = createServer((_, response) => response.setHeader("content-type", "text/html").end("<!doctype html><title>x</title>"));
    stranger.listen(0, "127.0.0.1");
    await once(stranger, "listening");
    const origin = `http://127.0.0.1:${(stranger.address() as AddressInfo).port}`;
    /** What a WebSocket to the server tells the stranger's page first: "open", or how it was closed. */
    const attempt = (page: Page) => page.evaluate((url) => new Promise<string>((resolve) => {
      const socket = new WebSocket(url);
      socket.onopen = () => resolve("open");
      socket.onclose = ({ code }) => resolve(`closed: ${code}`);
    }), `${server.address.replace("http", "ws")}/session`);
    for (const [options, found] of [[[], "closed: 1006"], [["--allow-origin", origin], "open"]] as const) {
      await server.start(options);
      const page = await tabs.open(origin);
      assert.equal(await attempt(page), found);
      await page.context().close();
      const refused = tabs.problems().filter((problem) => !problem.includes("favicon"));
      assert.equal(refused.length, options.length ? 0 : 1);
      assert.ok(options.length || refused[0]!.includes("Unexpected response code: 403"), refused[0]);
      await server.stop();
    }
    stranger.close();
  });

  test("a server that stops and comes back finds the game where it was", async () => {
    await server.start();
    const page = await tabs.open(server.address);
    await page.getByRole("button", { name: "Play beamfall" }).click();
    await page.keyboard.down("Space");
    await until(async () => await numberIn(page, "#score") > 0 && await numberIn(page, "#frame") > 90, "a score");
    await page.keyboard.press("KeyP");
    await page.keyboard.up("Space");
    await paused(page);
    const seen = async () => [await numberIn(page, "#frame"), await numberIn(page, "#score"), await numberIn(page, "#lives"),
      await page.locator("#screen").evaluate((canvas: HTMLCanvasElement) => canvas.toDataURL())];
    const before = await seen();
    const { port } = server;
    await server.stop();
    await page.locator("#status").getByText("Trying again").waitFor();
    await server.start([], port);
    await page.getByRole("button", { name: "Continue" }).waitFor();
    await until(async () => isDeepStrictEqual(await seen(), before), "the game where it was");
    await until(async () => await page.locator("#status").textContent() === "", "no more to be told");
    await page.getByRole("button", { name: "Continue" }).click();
    await until(async () => await numberIn(page, "#frame") > Number(before[0]) + 10, "more frames");
    await page.context().close();
    tabs.problems(); // the browser tells of connections that were refused
  });
});
