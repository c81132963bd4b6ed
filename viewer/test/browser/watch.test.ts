import assert from "node:assert/strict";
import { after, afterEach, before, describe, test } from "node:test";
import type { Page } from "playwright-core";
import { Agent } from "./agent.js";
import { numberIn, Server, Tabs, until } from "./harness.js";

describe("the view Watch", () => {
  const server = new Server();
  const tabs = new Tabs();
  let page: Page;
  let agents: Agent[] = [];

  before(async () => {
    await server.start(["--listen", "tcp://127.0.0.1:0"]);
    page = await tabs.open(`${server.address}#watch`);
  });
  after(async () => {
    await Promise.all(agents.map((agent) => agent.stop()));
    await tabs.close();
    await server.remove();
  });
  afterEach(() => assert.deepEqual(tabs.problems(), []));

  const picture = (canvas: string) => page.locator(canvas).evaluate((element: HTMLCanvasElement) => element.toDataURL());

  /** Waits until a canvas shows another picture. */
  async function moves(canvas: string): Promise<void> {
    const before = await picture(canvas);
    await until(async () => await picture(canvas) !== before, `another picture in ${canvas}`);
  }

  test("says what to do if no session is shared", async () => {
    await page.getByText("No session is shared").waitFor();
  });

  test("shows two sessions at once, and one of them large", async () => {
    agents = [await Agent.start(server.agents, "beamfall", "left"), await Agent.start(server.agents, "updraft", "right")];
    await page.getByRole("button", { name: /right Updraft/ }).waitFor();
    await moves("#wall canvas >> nth=0");
    await moves("#wall canvas >> nth=1");
    await moves("#watched-screen");
    await page.getByRole("button", { name: /right Updraft/ }).click();
    await page.locator("#watched-title").filter({ hasText: "right: Updraft" }).waitFor();
    await moves("#watched-screen");
    assert.ok(await page.getByText("No session is shared").isHidden());
  });

  test("what the page says of the large session is seen without scrolling", async () => {
    const { y, height } = (await page.locator("#watched-facts").boundingBox())!;
    assert.ok(height > 0 && y + height < page.viewportSize()!.height / 3, `the facts end at ${y + height}`);
  });

  test("on a phone, the session that was chosen comes into sight", async () => {
    const phone = await tabs.open(`${server.address}#watch`, { viewport: { width: 390, height: 400 }, hasTouch: true, isMobile: true });
    await phone.locator("#watched-facts").getByText("frame").waitFor();
    await phone.getByRole("button", { name: /right Updraft/ }).tap();
    await until(async () => (await phone.locator("#watched").boundingBox())!.y > -1, "the large session");
    await phone.context().close();
  });

  test("tells score, episode and speed", async () => {
    await until(async () => /score [1-9]\d* · episode \d+ · [1-9]\d* frames\/s/.test(
      await page.getByRole("button", { name: /left Beamfall/ }).textContent() ?? ""), "a score");
    await page.locator("#watched-facts").getByText("action").waitFor();
  });

  test("a session that ends leaves the wall", async () => {
    await agents[1]!.stop();
    await until(async () => await page.locator("#wall li").count() === 1, "one tile");
    await page.locator("#watched-title").filter({ hasText: "left: Beamfall" }).waitFor();
    await moves("#watched-screen");
  });

  test("a hidden view asks for nothing", async () => {
    await page.getByRole("link", { name: "Play", exact: true }).click();
    let sent = 0;
    const devtools = await page.context().newCDPSession(page);
    await devtools.send("Network.enable");
    devtools.on("Network.webSocketFrameSent", ({ response }) => (sent += Number(response.payloadData.startsWith("watch"))));
    await until(async () => (sent = 0, await page.waitForTimeout(500), sent === 0), "a half second without requests");
    await page.getByRole("link", { name: "Watch" }).click();
    await until(() => Promise.resolve(sent > 10), "requests");
  });
});

test("a page does not watch itself, nor the sessions that make pictures", async () => {
  const [server, tabs] = [new Server(), new Tabs()];
  try {
    await server.start(["--listen", "tcp://127.0.0.1:0", "--watch", "all"]);
    const page = await tabs.open(`${server.address}#watch`);
    const none = page.getByText("No session is shared");
    await none.waitFor();
    await page.getByRole("link", { name: "Play", exact: true }).click();
    await page.getByRole("button", { name: "Play beamfall" }).click();
    await until(async () => await numberIn(page, "#frame") > 10, "frames");
    await page.getByRole("link", { name: "Watch" }).click();
    await none.waitFor();
    const agent = await Agent.start(server.agents, "updraft", "agent");
    await page.locator("#watched-title").filter({ hasText: "agent: Updraft" }).waitFor();
    assert.equal(await page.locator("#wall li").count(), 1);
    const other = await tabs.open(`${server.address}#watch`);
    await other.getByRole("button", { name: /^player-\w+ Beamfall/ }).waitFor(); // others see it
    await agent.stop();
    assert.deepEqual(tabs.problems(), []);
  } finally {
    await tabs.close();
    await server.remove();
  }
});
