import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { after, afterEach, before, describe, test } from "node:test";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { connect } from "racebeam";
import type { Page } from "playwright-core";
import { numberIn, paused, Server, Tabs, until } from "./harness.js";

describe("the panels of Inspect", () => {
  const server = new Server();
  const tabs = new Tabs();
  let page: Page;

  before(async () => {
    await server.start(["--listen", "tcp://127.0.0.1:0"]);
    page = await tabs.open(server.address);
    await page.getByRole("button", { name: "Play beamfall" }).click();
    await page.keyboard.press("KeyI");
  });
  after(async () => {
    await tabs.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  /** The byte that the grid shows for an address. */
  async function byte(address: number, where = page): Promise<number> {
    return parseInt(await where.locator("#ram td").nth(1 + address - 0x80).textContent() ?? "", 16);
  }

  /** Flies and fires until the score has changed, and pauses. If the game is over, a new one begins. */
  async function score(): Promise<void> {
    await page.locator("#stage").focus();
    if (await page.locator("#stage").getAttribute("data-motion") === "paused") {
      await page.keyboard.press("KeyP");
    }
    const before = await numberIn(page, "#score");
    await page.keyboard.down("Space");
    await page.keyboard.down("ArrowRight");
    await until(async () => await numberIn(page, "#score") !== before && await numberIn(page, "#score") > 0, "a score");
    await page.keyboard.press("KeyP");
    await page.keyboard.up("ArrowRight");
    await page.keyboard.up("Space");
    await paused(page);
  }

  test("the grid shows RAM, where the score is", async () => {
    await score();
    const bcd = (value: number) => 10 * (value >> 4) + (value & 15);
    await until(async () => 100 * bcd(await byte(0x83)) + bcd(await byte(0x84)) === await numberIn(page, "#score"), "the score in RAM");
    await until(async () => await byte(0x81) === await numberIn(page, "#lives"), "the lives in RAM");
  });

  test("the panels show a game that has not begun to run", async () => {
    const other = await tabs.open(server.address);
    await other.getByRole("button", { name: "Play beamfall" }).waitFor();
    await other.locator("#inspect").click();
    await until(async () => await byte(0x81, other) === await numberIn(other, "#lives"), "the lives in RAM");
    await until(async () => /[0-9A-F]{2}/.test(await other.locator("#tia dd").first().textContent() ?? ""), "a register");
    await until(async () => await numberIn(other, "#lives-now") === await numberIn(other, "#lives"), "the plot of the lives");
    assert.equal(await numberIn(other, "#frame"), 0);
    await other.context().close();
  });

  test("the bytes that the rule reads have names", async () => {
    assert.equal(await page.locator("#ram-names").textContent(), "The game's rule reads: $81 lives, $82 score, $83 score, $84 score.");
    assert.equal(await page.locator("#ram td.named").count(), 4);
    assert.equal(await page.locator("#ram td").nth(1 + 1).getAttribute("title"), "lives");
  });

  test("the registers of the TIA and the collision latches are shown", async () => {
    const session = await connect(server.agents);
    await session.load("beamfall");
    const { tia } = await session.names();
    await session.disconnect();
    assert.deepEqual(await page.locator("#tia dt").allTextContents(), tia);
    const value = async (name: string) => parseInt(await page.locator("#tia dd").nth(tia.indexOf(name)).textContent() ?? "", 16);
    assert.ok((await value("RESP0")) < 160);
    const before = await page.locator("#tia dd").allTextContents();
    await score();
    assert.notDeepEqual(await page.locator("#tia dd").allTextContents(), before);
  });

  test("the search finds the score", async () => {
    await page.getByRole("button", { name: "New search" }).click();
    for (let round = 0; round < 3; ++round) {
      await score();
      await page.getByRole("button", { name: "Changed", exact: true }).click();
      await page.keyboard.press("Tab");
    }
    const found = Number(/^(\d+) of 128/.exec(await page.locator("#found").textContent() ?? "")?.[1]);
    assert.ok(found > 0 && found < 80, `${found} bytes`);
    await page.locator("#value").fill(`$${(await byte(0x84)).toString(16)}`);
    await page.getByRole("button", { name: "Search", exact: true }).click();
    await page.locator("#candidates").getByText("$84").waitFor();
    await page.locator("#value").fill("999");
    await page.getByRole("button", { name: "Search", exact: true }).click();
    await page.getByText("A byte is a number from 0 to 255").waitFor();
  });

  test("nothing is saved before something was found", async () => {
    await page.getByRole("button", { name: "Save a draft" }).click();
    await page.getByText("There is nothing to save.").waitFor();
  });

  test("values of the list, and what the draft's rule gives, follow the game", async () => {
    await page.getByLabel("Part of the rule of $84").selectOption("score0");
    const given = async () => Number(/gives now: score (\d+)\.$/.exec(await page.locator("#preview").textContent() ?? "")?.[1]);
    const listed = async () => parseInt(/\$([0-9A-F]{2}) = /.exec(await page.locator("#candidates tr").filter({ hasText: "$84" }).textContent() ?? "")![1]!, 16);
    for (let round = 0; round < 2; ++round) {
      await until(async () => await given() === await numberIn(page, "#score") % 100, "the score of the draft");
      await until(async () => await listed() === await byte(0x84), "the value of the list");
      await score();
    }
  });

  test("the other digits of the score are beside it, and a search for the lives leaves them", async () => {
    await page.getByLabel("Part of the rule of $83").selectOption("score1");
    await page.getByRole("button", { name: "New search" }).click();
    await page.locator("#value").fill(`$${(await byte(0x81)).toString(16)}`);
    await page.getByRole("button", { name: "Search", exact: true }).click();
    await page.getByLabel("Part of the rule of $81").selectOption("lives");
    const both = async () => `The draft's rule gives now: score ${await numberIn(page, "#score")}, lives ${await byte(0x81)}, the game goes on.`;
    await until(async () => await page.locator("#preview").textContent() === await both(), "the score and the lives of the draft");
  });

  test("the draft is a game file that the program takes", async () => {
    const download = page.waitForEvent("download");
    await page.getByRole("button", { name: "Save a draft" }).click();
    const file = path.join(server.folder, "draft.toml");
    await (await download).saveAs(file);
    assert.match(readFileSync(file, "utf8"), /bcd\(0x84, 0x83\)/);
    const image = path.join(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), "../../../games/homebrew/beamfall.bin");
    const actions = path.join(server.folder, "actions");
    writeFileSync(actions, "1\n".repeat(300));
    const printed = execFileSync(process.env.RACEBEAM_BINARY!, ["serve", "--stdio", "--game-file", file, "--rom", image],
      { input: "load draft sticky=0 seed=1\nact FIRE*600\n", encoding: "utf8" });
    assert.match(printed, /^ok reward=[1-9]\d* /m, printed);
  });

  test("the panels show what the agent sees, the action, the colours and the plots", async () => {
    await page.locator("#stage").focus();
    await page.keyboard.press("KeyP");
    await page.keyboard.down("ArrowUp");
    await page.locator("#action").getByText("UP", { exact: true }).waitFor();
    await page.keyboard.up("ArrowUp");
    const colours = (selector: string) => page.locator(selector).evaluate((canvas: HTMLCanvasElement) =>
      new Set(new Uint32Array(canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size);
    for (const oldest of [0, 3]) {
      await until(async () => await colours(`#agent canvas >> nth=${oldest}`) > 3, `what the agent sees, ${oldest}`);
    }
    await until(async () => await colours("#palette") > 100, "the palette");
    await until(async () => await page.locator("#used li").count() > 3, "the colours that are used");
    for (const plot of ["#score-plot", "#reward-plot", "#lives-plot", "#wave"]) {
      await until(async () => await colours(plot) > 1, plot);
    }
  });
});
