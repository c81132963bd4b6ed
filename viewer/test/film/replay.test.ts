// The frames of docs/viewer/agent.gif: the view Replay, with an episode of an agent. They are written as PNGs into build/viewer/frames.

import { mkdirSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { Server, Tabs } from "../browser/harness.js";

const ROOT = path.join(path.dirname(new URL(import.meta.url).pathname), "../../..");
const LOG = path.join(ROOT, "docs/results/own-games/logs/beamfall-basic-1/1.episode");
const FRAMES = path.join(ROOT, "build/viewer/frames");
const EVERY = 4; // frames of the game between two pictures
const LAST = 480;

test("the view Replay with an episode of an agent", async () => {
  const [server, tabs] = [new Server(), new Tabs()];
  rmSync(FRAMES, { recursive: true, force: true });
  mkdirSync(FRAMES, { recursive: true });
  try {
    await server.start([]);
    const page = await tabs.open(`${server.address}#replay`, { viewport: { width: 800, height: 650 }, colorScheme: "dark" });
    await page.locator("#log").setInputFiles(LOG);
    await page.locator('[data-part="facts"]').filter({ hasText: "as logged" }).waitFor();
    for (let frame = 0; frame <= LAST; frame += EVERY) {
      await page.locator("#timeline").fill(String(frame));
      await page.locator('.deck[aria-busy="false"]').waitFor();
      writeFileSync(path.join(FRAMES, `${String(frame).padStart(5, "0")}.png`), await page.screenshot({ caret: "hide" }));
    }
  } finally {
    await tabs.close();
    await server.remove();
  }
});
