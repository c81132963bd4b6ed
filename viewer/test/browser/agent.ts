import { connect, type Session } from "racebeam";

/** Plays in a session of its own until stop() is called, and waits `pause` milliseconds after each frame. */
export class Agent {
  readonly #session: Session;
  readonly #pause: number;
  #runs = true;

  private constructor(session: Session, pause: number) {
    this.#session = session;
    this.#pause = pause;
  }

  static async start(address: string, game: string, name: string, pause = 10): Promise<Agent> {
    const session = await connect(address);
    await session.load(game, { seed: 7, sticky: 0 });
    await session.share(name);
    const agent = new Agent(session, pause);
    void agent.#play().catch(() => {}); // until the session ends
    return agent;
  }

  async #play(): Promise<void> {
    while (this.#runs) {
      const { terminated } = await this.#session.act("UPFIRE");
      await (terminated ? this.#session.reset() : new Promise((resolve) => setTimeout(resolve, this.#pause)));
    }
  }

  async stop(): Promise<void> {
    this.#runs = false;
    await this.#session.disconnect();
  }
}
