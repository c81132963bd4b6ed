// Accessibility, and screens of all sizes.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, afterEach, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { recordedEpisodes, Server, Tabs, until } from "./harness.js";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

interface Axe {
  run(options: { runOnly?: string[] }): Promise<{ violations: { id: string; impact: string; nodes: { target: string[] }[] }[] }>;
}

describe("accessibility", () => {
  const server = new Server();
  const tabs = new Tabs();
  let log: string;

  before(async () => {
    log = recordedEpisodes(server.folder, 0, 1)[0]!;
    await server.start();
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  /** What axe finds on the page by these rules, or by all: impact, rule and place. */
  async function findings(page: Page, rules?: string[]): Promise<string[]> {
    await page.evaluate(AXE);
    return page.evaluate(async (only) => {
      const { violations } = await (window as unknown as { axe: Axe }).axe.run(only ? { runOnly: only } : {});
      return violations.map(({ id, impact, nodes }) => `${impact}: ${id} at ${nodes.map(({ target }) => target.join(" ")).join(", ")}`);
    }, rules);
  }

  for (const [colorScheme, rules] of [["dark", undefined], ["light", ["color-contrast"]]] as const) {
    test(`axe finds nothing in any view, ${colorScheme}`, async () => {
      const page = await tabs.open(server.address, { colorScheme });
      await page.getByRole("button", { name: "Play beamfall" }).waitFor();
      assert.deepEqual(await findings(page, rules && [...rules]), []);
      await page.getByRole("button", { name: "Play beamfall" }).click();
      await page.keyboard.press("KeyI");
      await page.locator("#ram .changed").first().waitFor();
      await page.keyboard.press("KeyP");
      await page.getByRole("button", { name: "Unchanged" }).click();
      assert.deepEqual(await findings(page, rules && [...rules]), []);
      await page.getByRole("link", { name: "Replay" }).click();
      await page.locator("#log").setInputFiles(log);
      await page.locator("#transport").waitFor();
      assert.deepEqual(await findings(page, rules && [...rules]), []);
      await page.getByRole("link", { name: "Watch" }).click();
      await page.getByRole("heading", { name: "No session is shared" }).waitFor();
      assert.deepEqual(await findings(page, rules && [...rules]), []);
      await page.context().close();
    });
  }

  test("Tab visits everything, and leaves the game", async () => {
    const page = await tabs.open(server.address);
    await page.getByRole("button", { name: "Play beamfall" }).waitFor();
    const visited = new Set<string>();
    for (let press = 0; press < 40; ++press) {
      await page.keyboard.press("Tab");
      visited.add(await page.evaluate(() => document.activeElement?.id || document.activeElement?.textContent?.trim() || "none"));
    }
    for (const each of ["Skip to the content", "Play", "Watch", "Replay", "stage", "start", "pause", "inspect", "Beamfall", "Updraft", "left-switch", "picture", "replay-this"]) {
      assert.ok(visited.has(each), `${each} is not among ${[...visited]}`);
    }
    await page.context().close();
  });

  test("the link that skips leads to the content of the same view", async () => {
    const page = await tabs.open(`${server.address}#replay`);
    await page.getByRole("heading", { name: "Replay an episode" }).waitFor();
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.activeElement?.id), "main");
    assert.ok(await page.getByRole("heading", { name: "Replay an episode" }).isVisible());
    await page.context().close();
  });

  test("on a phone the games come first, and nothing covers the picture", async () => {
    const page = await tabs.open(server.address, PHONE);
    const start = page.getByRole("button", { name: "Play beamfall" });
    await start.waitFor();
    const [list, picture, button] = await Promise.all([page.locator("#games"), page.locator("#screen"), start].map((each) => each.boundingBox()));
    assert.ok(list!.y + list!.height <= picture!.y, "the list is above the picture");
    assert.ok(picture!.y + picture!.height <= button!.y, "the button is below the picture");
    assert.ok(button!.y + button!.height <= PHONE.viewport.height, "the button is seen");
    assert.equal(await page.locator("kbd:visible").count(), 0); // a phone has no keys
    await page.context().close();
  });

  test("on a phone on its side, the picture and the controls beside it are seen at once", async () => {
    for (const viewport of [{ width: 844, height: 390 }, { width: 568, height: 320 }]) {
      const page = await tabs.open(server.address, { ...PHONE, viewport });
      await page.getByRole("button", { name: "Play beamfall" }).tap();
      const [picture, pad, fire] = (await Promise.all(["#screen", "#pad", "#fire"].map((each) => page.locator(each).boundingBox())));
      assert.ok(pad!.x + pad!.width <= picture!.x && picture!.x + picture!.width <= fire!.x, "a control covers the picture");
      const bottom = pad!.y + pad!.height; // a page scrolls by whole pixels, so that both may be off by less than one
      assert.ok(picture!.y > -1 && bottom < viewport.height + 1, `the picture begins at ${picture!.y}, the pad ends at ${bottom}`);
      await page.context().close();
    }
  });

  test("on a phone everything fits, and fingers play", async () => {
    const page = await tabs.open(server.address, PHONE);
    await page.getByRole("button", { name: "Play beamfall" }).tap();
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), PHONE.viewport.width);
    const fire = (await page.locator("#fire").boundingBox())!;
    const touch = await page.context().newCDPSession(page);
    const at = { x: fire.x + fire.width / 2, y: fire.y + fire.height / 2 };
    await touch.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [at] });
    await until(async () => Number(await page.locator("#score").textContent()) > 0, "a score by touch");
    await touch.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await page.getByRole("button", { name: "Inspect" }).tap();
    await page.locator("#inspector").waitFor();
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), PHONE.viewport.width);
    await page.context().close();
  });

  for (const viewport of [{ width: 1280, height: 800 }, { width: 960, height: 640 }, PHONE.viewport]) {
    test(`the panels open where they are seen beside the game, ${viewport.width} pixels wide`, async () => {
      const page = await tabs.open(server.address, { viewport });
      await page.getByRole("button", { name: "Play beamfall" }).click();
      await page.keyboard.press("KeyI");
      for (const part of ["#screen", "#ram"]) {
        const { x, y, width } = (await page.locator(part).boundingBox())!;
        assert.ok(y >= 0 && y < viewport.height - 60, `${part} is at ${y}`);
        assert.ok(x >= 0 && x + width <= viewport.width + 1, `${part} ends at ${x + width}`);
      }
      await page.context().close();
    });
  }

  test("the picture has the shape of a television's", async () => {
    const page = await tabs.open(server.address);
    await page.getByRole("button", { name: "Play beamfall" }).click();
    const shape = async () => {
      const { width, height } = (await page.locator("#screen").boundingBox())!;
      return width / height;
    };
    const right = async () => Math.abs(await shape() - (160 * 12) / 7 / 210) < 0.01;
    await until(right, "the shape");
    await page.keyboard.press("KeyF");
    await until(async () => page.evaluate(() => document.fullscreenElement?.id === "stage"), "full screen");
    await until(right, "the shape in full screen");
    await page.context().close();
  });
});
