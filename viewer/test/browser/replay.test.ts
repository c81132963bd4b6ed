import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, describe, test } from "node:test";
import { deflateSync, inflateSync } from "node:zlib";
import type { Page } from "playwright-core";
import { crc32 } from "../../src/replay/log.js";
import { measured, paused, recordedEpisodes, Server, Tabs, until } from "./harness.js";

const HEADER = 24; // bytes of a log before its contents

/** A log whose first hash of a state has another bit. */
function withAnotherHash(log: Buffer): Buffer {
  const contents = inflateSync(log.subarray(HEADER));
  contents[contents.indexOf("\n\n") + 2]! ^= 1;
  return sealed(log, contents);
}

/** A log with other contents, sealed anew. */
function sealed(log: Buffer, contents: Buffer): Buffer {
  const header = Buffer.from(log.subarray(0, HEADER));
  const packed = deflateSync(contents);
  header.writeBigUInt64LE(BigInt(contents.length), 12);
  header.writeUInt32LE(crc32(header.subarray(0, HEADER - 4), packed), HEADER - 4);
  return Buffer.concat([header, packed]);
}

describe("the view Replay", () => {
  const server = new Server();
  const tabs = new Tabs();
  let page: Page;
  let logs: string[];

  before(async () => {
    logs = [...recordedEpisodes(server.folder, 0, 2), ...recordedEpisodes(server.folder, 0.25, 1)];
    await server.start(["--record-dir", server.folder]);
    page = await tabs.open(`${server.address}#replay`);
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  const facts = (deck = 0) => page.locator('[data-part="facts"]').nth(deck).textContent();
  const screen = (deck = 0) => page.locator('.deck [data-part="screen"]').nth(deck).evaluate((canvas: HTMLCanvasElement) => canvas.toDataURL());
  const place = async () => Number(/frame (\d+) of/.exec(await page.locator("#place").textContent() ?? "")?.[1]);
  const scrub = (frame: number) => page.locator("#timeline").fill(String(frame));

  /** Waits until the deck shows the frame of its place. Returns what it says, and the picture. */
  async function settled(deck = 0): Promise<string> {
    await page.locator(".deck").nth(deck).and(page.locator('[aria-busy="false"]')).waitFor();
    return `${await facts(deck)} ${await screen(deck)}`;
  }

  test("a log plays as it says, frame by frame", async () => {
    await page.locator("#log").setInputFiles(logs[0]!);
    await until(async () => / plays as logged$/.test(await facts() ?? ""), "the episode");
    const [, frames = ""] = / frames=(\d{3,}) /.exec(inflateSync(readFileSync(logs[0]!).subarray(HEADER)).toString("latin1")) ?? [];
    assert.equal(await page.locator("#place").textContent(), `frame 0 of ${frames}`);
  });

  test("any frame is shown at once, and always looks the same", async () => {
    await scrub(500);
    const seen = await settled();
    await scrub(37);
    assert.notEqual(await settled(), seen);
    for (let frame = 495; frame < 500; ++frame) {
      await scrub(frame);
    }
    await page.getByRole("button", { name: "Forward" }).last().click();
    assert.equal(await place(), 500);
    assert.equal(await settled(), seen);
  });

  test("the end has the score of the log", async () => {
    await page.locator("#timeline").press("End");
    await until(async () => /^score (\d+) of \1 · /.test(await facts() ?? ""), "the score of the log");
  });

  test("a film is made on the server", async () => {
    await page.getByRole("button", { name: "Make it on the server" }).click();
    const note = page.locator("#link-status");
    await until(async () => /recordings: /.test(await note.textContent() ?? ""), "the film");
    const [, name, frames] = /: (beamfall-\d{14}\.gif): (\d+) frames\.$/.exec(await note.textContent() ?? "")!;
    assert.match(await page.locator("#place").textContent() ?? "", new RegExp(` of ${frames}$`));
    assert.equal(readFileSync(path.join(server.folder, name!)).subarray(0, 6).toString(), "GIF89a");
    await page.locator("#film-kind").selectOption("webm");
    await page.getByRole("button", { name: "Make it on the server" }).click();
    await until(async () => /\.webm: |ffmpeg is not installed/.test(
      `${await note.textContent()} ${await page.locator("#transport-problem").textContent()}`), "a film, or the reason against one");
  });

  test("it runs at the speed that is chosen", async () => {
    await page.locator("#speed").selectOption("2");
    const rate = await measured(async () => {
      await scrub(0);
      const start = Date.now();
      assert.equal(await page.locator("#run").textContent(), "Play");
      await page.locator("#run").click();
      assert.equal(await page.locator("#run").textContent(), "Pause");
      await until(async () => await place() >= 180, "180 frames");
      const found = (1000 * await place()) / (Date.now() - start);
      await page.locator("#run").click();
      return found;
    }, 90, 135);
    assert.ok(rate > 90 && rate < 135, `${rate} frames a second`);
  });

  test("the buttons go from reward to reward", async () => {
    await scrub(0);
    await page.getByRole("button", { name: "Next reward" }).click();
    const first = await place();
    assert.ok(first > 0);
    await until(async () => /^score [1-9]/.test(await facts() ?? ""), "a score");
    await page.getByRole("button", { name: "Next reward" }).click();
    assert.ok(await place() > first);
    await page.getByRole("button", { name: "Reward before" }).click();
    assert.equal(await place(), first);
  });

  test("a link leads to the frame, in another tab", async () => {
    await scrub(321);
    await settled();
    const seen = await screen();
    await page.getByRole("button", { name: "Copy a link" }).click();
    await page.locator("#link-status").filter({ hasText: "The link is" }).waitFor();
    const other = await tabs.open(page.url());
    await until(async () => /^frame 321 /.test(await other.locator("#place").textContent() ?? ""), "the frame of the link");
    await until(async () => await other.locator('.deck [data-part="screen"]').evaluate((canvas: HTMLCanvasElement) => canvas.toDataURL()) === seen,
      "the picture of the link");
    await other.context().close();
  });

  test("an episode with sticky actions stands beside the other", async () => {
    await page.locator("#log").setInputFiles(logs[2]!);
    await until(async () => / plays as logged$/.test(await facts(1) ?? ""), "the second episode");
    await scrub(400);
    await Promise.all([settled(0), settled(1)]);
    assert.notEqual(await screen(0), await screen(1));
    await page.locator("#log").setInputFiles(logs[1]!);
    await page.locator("#log-problem").filter({ hasText: "close one first" }).waitFor();
    await page.getByRole("button", { name: "Close" }).first().click();
    assert.equal(await page.locator(".deck").count(), 1);
  });

  test("a log that was cut is refused in a sentence", async () => {
    const whole = readFileSync(logs[0]!);
    await page.locator("#log").setInputFiles({ name: "cut.episode", mimeType: "", buffer: whole.subarray(0, whole.length - 9) });
    await page.locator("#log-problem").filter({ hasText: "altered or cut off" }).waitFor();
  });

  test("a log of other states does not play as logged, although its score does", async () => {
    await page.getByRole("button", { name: "Close" }).click();
    await page.locator("#log").setInputFiles({ name: "other.episode", mimeType: "", buffer: withAnotherHash(readFileSync(logs[0]!)) });
    await until(async () => / does not play as logged: the state in decisions 1 to 256$/.test(await facts() ?? ""), "what differs");
  });

  test("the episode that was just played is replayed", async () => {
    await page.getByRole("button", { name: "Close" }).click();
    await page.getByRole("link", { name: "Play", exact: true }).click();
    await page.getByRole("button", { name: "Play beamfall" }).click();
    await page.keyboard.down("Space");
    await until(async () => Number(await page.locator("#score").textContent()) > 0, "a score");
    await page.keyboard.up("Space");
    await page.keyboard.press("KeyP");
    await paused(page);
    const [score, frame] = [await page.locator("#score").textContent(), await page.locator("#frame").textContent()];
    await page.getByRole("button", { name: "Replay this episode" }).click();
    await page.locator("#place").filter({ hasText: `of ${frame}` }).waitFor();
    await until(async () => (await facts() ?? "").startsWith(`score 0 of ${score} `), "the score of the episode");
  });

  test("a third episode is refused in a sentence", async () => {
    for (const answer of [page.locator(".deck").nth(1), page.locator("#log-problem").filter({ hasText: "close one first" })]) {
      await page.getByRole("link", { name: "Play", exact: true }).click();
      await page.getByRole("button", { name: "Replay this episode" }).click();
      await answer.waitFor();
    }
  });

  test("the page says that the connection is lost, and shows the episode again when the server is back", async () => {
    const { port } = server;
    await server.stop();
    await scrub(1);
    await page.locator(".deck").first().getByText("The connection is lost. Trying again.").waitFor();
    await server.start(["--record-dir", server.folder], port);
    await until(async () => (await facts() ?? "").startsWith("score 0 of "), "the episode");
    tabs.problems(); // the browser tells of connections that were refused
  });

  test("a game that the server lacks is named", async () => {
    const contents = inflateSync(readFileSync(logs[0]!).subarray(HEADER));
    const other = sealed(readFileSync(logs[0]!), Buffer.concat([Buffer.from("load pong"), contents.subarray("load beamfall".length)]));
    await page.getByRole("button", { name: "Close" }).first().click();
    await page.locator("#log").setInputFiles({ name: "pong.episode", mimeType: "", buffer: other });
    await page.locator("#log-problem").getByText("pong.episode: the image of pong is missing.", { exact: true }).waitFor();
  });
});

test("a server that does not record offers no film", async () => {
  const [server, tabs] = [new Server(), new Tabs()];
  try {
    const [log] = recordedEpisodes(server.folder, 0, 1);
    await server.start();
    const page = await tabs.open(`${server.address}#replay`);
    await page.locator("#log").setInputFiles(log!);
    await page.locator("#link-status").filter({ hasText: "started without --record-dir" }).waitFor();
    assert.ok(await page.locator("#film").isDisabled());
  } finally {
    await tabs.close();
    await server.remove();
  }
});
