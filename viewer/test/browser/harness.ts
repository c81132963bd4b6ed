// A browser, and a server that serves the page. RACEBEAM_BINARY names the program, CHROMIUM the browser.

import assert from "node:assert/strict";
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { after } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { chromium, type Browser, type BrowserContext, type BrowserContextOptions, type Page } from "playwright-core";

const PATIENCE = 1000 * Number(process.env.RACEBEAM_PATIENCE ?? 20); // milliseconds
const OPTIONS = ["--no-sandbox", "--disable-gpu", "--autoplay-policy=user-gesture-required"];

const ENVIRONMENT = { ...process.env };
delete ENVIRONMENT.RACEBEAM_ROMS; // so that the page begins with a game of our own

/** The program racebeam as a server of the page. */
export class Server {
  readonly folder = mkdtempSync(path.join(os.tmpdir(), "racebeam-"));
  readonly #ready = path.join(this.folder, "ready");
  #process: ChildProcess | undefined;
  /** Of the page. */
  address = "";
  /** For programs, if the server has a listener for them. */
  agents = "";

  /** Starts the server. `port`: 0 for any that is free. */
  async start(options: readonly string[] = [], port: number | string = 0): Promise<void> {
    rmSync(this.#ready, { force: true });
    const words = ["serve", "--listen", `ws://127.0.0.1:${port}`, "--ready-file", this.#ready, "--log-level", "warning", ...options];
    this.#process = spawn(process.env.RACEBEAM_BINARY!, words, { stdio: ["ignore", "ignore", "inherit"], cwd: this.folder, env: ENVIRONMENT });
    for (const until = Date.now() + PATIENCE; !existsSync(this.#ready); await sleep(20)) {
      assert.ok(Date.now() < until, "the server does not start");
    }
    const addresses = readFileSync(this.#ready, "utf8").split("\n");
    this.address = addresses.find((line) => line.startsWith("ws://"))!.replace("ws://", "http://");
    this.agents = addresses.find((line) => line.startsWith("tcp://")) ?? "";
  }

  /** Seconds of processor time so far. */
  get processorSeconds(): number {
    const fields = readFileSync(`/proc/${this.#process!.pid}/stat`, "utf8").split(") ").at(-1)!.split(" ");
    return (Number(fields[11]) + Number(fields[12])) / 100;
  }

  get port(): string {
    return new URL(this.address).port;
  }

  async stop(): Promise<void> {
    if (this.#process) {
      const ended = once(this.#process, "exit");
      this.#process.kill();
      await ended;
      this.#process = undefined;
    }
  }

  async remove(): Promise<void> {
    await this.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

let browser: Promise<Browser> | undefined;
after(async () => (await browser)?.close());

/** The pages of some tests, in the one browser of all. */
export class Tabs {
  readonly #contexts: BrowserContext[] = [];
  readonly #problems: string[] = [];

  /** A new page. Errors on its console and requests to other servers are problems. */
  async open(address: string, options: BrowserContextOptions = {}): Promise<Page> {
    browser ??= chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: OPTIONS });
    const context = await (await browser).newContext({ viewport: { width: 960, height: 640 }, ...options });
    this.#contexts.push(context);
    const page = await context.newPage();
    page.setDefaultTimeout(PATIENCE);
    page.on("console", (message) => message.type() === "error" && this.#problems.push(message.text()));
    page.on("pageerror", (error) => this.#problems.push(String(error)));
    page.on("request", (request) => {
      const url = new URL(request.url());
      if (url.host !== new URL(address).host && !["blob:", "data:"].includes(url.protocol)) {
        this.#problems.push(`a request to ${url}`);
      }
    });
    await page.goto(address);
    return page;
  }

  /** Seconds of processor time of all processes of the browser so far, but for those that have ended. */
  async processorSeconds(): Promise<number> {
    const devtools = await (await browser!).newBrowserCDPSession();
    const { processInfo } = await devtools.send("SystemInfo.getProcessInfo");
    await devtools.detach();
    return processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
  }

  /** Closes all pages. */
  async close(): Promise<void> {
    await Promise.all(this.#contexts.map((context) => context.close()));
  }

  /** The problems since the last call. */
  problems(): string[] {
    return this.#problems.splice(0);
  }
}

/** The number that an element shows. */
export async function numberIn(page: Page, selector: string): Promise<number> {
  return Number(await page.locator(selector).textContent());
}

/** Waits until a condition holds. */
export async function until(condition: () => Promise<boolean>, what: string): Promise<void> {
  for (const end = Date.now() + PATIENCE; !await condition(); await sleep(30)) {
    assert.ok(Date.now() < end, `in vain: ${what}`);
  }
}

/** Waits until the game is paused, and the frame that the page shows stays. */
export async function paused(page: Page): Promise<void> {
  await page.locator('#stage[data-motion="paused"]').waitFor();
  await until(async () => await numberIn(page, "#frame") === (await page.waitForTimeout(200), await numberIn(page, "#frame")), "a stop");
}

/** The first measurement between the bounds, or the last of several: a busy machine disturbs some, a fault all. */
export async function measured(measure: () => Promise<number>, least: number, most: number): Promise<number> {
  let found = NaN;
  for (let attempt = 0; attempt < 10 && !(found > least && found < most); ++attempt) {
    found = await measure();
  }
  return found;
}

/** Logs of episodes of Beamfall that a random agent played: how often actions stick is a setting. Returns the files' paths. */
export function recordedEpisodes(folder: string, sticky: number, count: number): string[] {
  const plan = path.join(folder, `plan${sticky}.toml`);
  const results = path.join(folder, `results${sticky}`);
  writeFileSync(plan, `name = "replay"\ngames = ["beamfall"]\nagents = ["random"]\nevaluation_episodes = ${count}\n`
    + `environment = "max_episode_frames=3000 sticky=${sticky}"\n`);
  execFileSync(process.env.RACEBEAM_BINARY!, ["experiment", plan, "--into", results, "--threads", "1"], { stdio: "ignore" });
  const logs = path.join(results, "logs/beamfall-random-1");
  return readdirSync(logs).sort().map((name) => path.join(logs, name));
}
