// Firefox, driven by WebDriver BiDi. FIREFOX names the browser.

import puppeteer, { type Browser, type Page } from "puppeteer-core";
import { until } from "../browser/harness.js";

/** A page in its own Firefox. Errors on its console and requests to other servers are problems. */
export class Firefox {
  readonly page: Page;
  readonly #browser: Browser;
  readonly #problems: string[] = [];

  static async open(address: string): Promise<Firefox> {
    const browser = await puppeteer.launch({ browser: "firefox", executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr" });
    console.log(await browser.version());
    const firefox = new Firefox(browser, await browser.newPage(), new URL(address).host);
    await firefox.page.goto(address);
    return firefox;
  }

  private constructor(browser: Browser, page: Page, host: string) {
    this.#browser = browser;
    this.page = page;
    page.on("console", (message) => message.type() === "error" && this.#problems.push(message.text()));
    page.on("pageerror", (error) => this.#problems.push(String(error)));
    page.on("request", (request) => {
      const url = new URL(request.url());
      if (url.host !== host && !["blob:", "data:"].includes(url.protocol)) {
        this.#problems.push(`a request to ${url}`);
      }
    });
  }

  text(selector: string): Promise<string> {
    return this.page.$eval(selector, (element) => element.textContent ?? "");
  }

  async number(selector: string): Promise<number> {
    return Number(await this.text(selector));
  }

  /** Clicks on the button over the picture once it has this text. Other ways to find it wait for Firefox's tree of accessibility. */
  async press(name: string): Promise<void> {
    await until(async () => await this.text("#start") === name, `the button ${name}`);
    await (await this.page.$("#start"))!.click();
  }

  async playToScore(): Promise<void> {
    await this.press("Play Beamfall");
    await this.page.keyboard.down(" ");
    await this.page.keyboard.down("ArrowRight");
    await until(async () => await this.number("#score") > 0, "a score");
    await this.page.keyboard.up("ArrowRight");
    await this.page.keyboard.up(" ");
  }

  /** The problems since the last call. */
  problems(): string[] {
    return this.#problems.splice(0);
  }

  close(): Promise<void> {
    return this.#browser.close();
  }
}
