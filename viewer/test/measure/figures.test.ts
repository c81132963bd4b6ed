// Prints the table of docs/viewer.md, "Figures". SECONDS: of each column.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { Agent } from "../browser/agent.js";
import { Server, Tabs, until } from "../browser/harness.js";

const SECONDS = Number(process.env.SECONDS ?? 20);
const MANY = 16;
const PAUSE = 1000 / 60; // milliseconds of an agent between two frames

interface Column {
  title: string;
  figures: Record<string, string>;
}

declare global {
  interface Window {
    pictures: number;
  }
}

/** Counts the pictures that a page draws, and the bytes of its WebSockets without their frames' heads. */
class Counter {
  received = 0;
  sent = 0;

  static async of(page: Page): Promise<Counter> {
    const counter = new Counter();
    const size = ({ opcode, payloadData }: { opcode: number; payloadData: string }) =>
      Buffer.byteLength(payloadData, opcode === 2 ? "base64" : "utf8");
    const devtools = await page.context().newCDPSession(page);
    await devtools.send("Network.enable");
    devtools.on("Network.webSocketFrameReceived", ({ response }) => (counter.received += size(response)));
    devtools.on("Network.webSocketFrameSent", ({ response }) => (counter.sent += size(response)));
    await page.evaluate(() => {
      window.pictures = 0;
      const draw = CanvasRenderingContext2D.prototype.putImageData;
      CanvasRenderingContext2D.prototype.putImageData = function (this: CanvasRenderingContext2D, ...words: unknown[]) {
        ++window.pictures;
        (draw as (...words: unknown[]) => void).apply(this, words);
      };
    });
    return counter;
  }
}

/** What pages take while `act` goes on, which is repeated. */
async function measure(title: string, server: Server, tabs: Tabs, pages: readonly Page[], act: () => Promise<void>): Promise<Column> {
  const counters = await Promise.all(pages.map((page) => Counter.of(page)));
  const spent = async () => [server.processorSeconds, await tabs.processorSeconds()] as const;
  const drawn = async () => (await Promise.all(pages.map((page) => page.evaluate(() => window.pictures)))).reduce((sum, one) => sum + one, 0);
  const sum = (of: (counter: Counter) => number) => counters.reduce((total, counter) => total + of(counter), 0);
  const [first, began, pictures, bytes, sent] = [await spent(), performance.now(), await drawn(), sum((one) => one.received), sum((one) => one.sent)];
  while (performance.now() - began < 1000 * SECONDS) {
    await act();
  }
  const [last, seconds] = [await spent(), (performance.now() - began) / 1000];
  return { title, figures: {
    "pictures a second, of all": ((await drawn() - pictures) / seconds).toFixed(0),
    "kB a second to the browser": ((sum((one) => one.received) - bytes) / seconds / 1000).toFixed(0),
    "bytes a second to the server": ((sum((one) => one.sent) - sent) / seconds).toFixed(0),
    "processor share of the server, of a core": `${(100 * (last[0] - first[0]) / seconds).toFixed(1)} %`,
    "processor share of the browser, of a core": `${(100 * (last[1] - first[1]) / seconds).toFixed(0)} %`,
    "key to picture, ms: middle, worst": "-",
  } };
}

/** Begins with a server, agents that share their sessions, and pages; ends with none of them. */
async function column(title: string, agents: number, pages: number): Promise<Column> {
  const server = new Server();
  const tabs = new Tabs();
  const playing: Agent[] = [];
  try {
    await server.start(["--listen", "tcp://127.0.0.1:0"]);
    for (let agent = 0; agent < agents; ++agent) {
      playing.push(await Agent.start(server.agents, "beamfall", `room${agent}`, PAUSE));
    }
    const opened: Page[] = [];
    for (let page = 0; page < pages; ++page) {
      opened.push(await tabs.open(agents ? `${server.address}#watch` : server.address));
    }
    if (agents) {
      await Promise.all(opened.map((page) => until(async () => await page.locator("#wall li").count() === agents, "all tiles")));
      return await measure(title, server, tabs, opened, () => opened[0]!.waitForTimeout(500));
    }
    const [page] = opened as [Page];
    await page.getByRole("button", { name: "Play beamfall" }).click();
    let press = 0;
    const found = await measure(title, server, tabs, opened, () =>
      page.keyboard.press(++press % 2 ? "ArrowLeft" : "ArrowRight", { delay: 50 }).then(() => page.waitForTimeout(150)));
    const latency = /key to picture ([\d.]+) ms .* at most ([\d.]+) ms/.exec(await page.locator("#figures").textContent() ?? "");
    assert.ok(latency, "the page tells no latency");
    found.figures["key to picture, ms: middle, worst"] = `${latency[1]}, ${latency[2]}`;
    return found;
  } finally {
    await Promise.all(playing.map((agent) => agent.stop()));
    await tabs.close();
    await server.remove();
  }
}

test("figures", async () => {
  const columns = [await column("one player of Beamfall", 0, 1), await column(`a wall of ${MANY} sessions`, MANY, 1),
    await column(`${MANY} pages that watch a session`, 1, MANY)];
  const row = (words: readonly string[]) => `| ${words.join(" | ")} |`;
  console.log([row(["what", ...columns.map(({ title }) => title)]), `|---|${"---:|".repeat(columns.length)}`,
    ...Object.keys(columns[0]!.figures).map((name) => row([name, ...columns.map(({ figures }) => figures[name]!)]))].join("\n"));
});
