import { connect, RefusedError, type Group, type Session } from "racebeam";
import { byId, tell } from "./elements.js";

const PATIENCE = 30_000; // milliseconds until a reply
const WAITS = [250, 500, 1000, 2000]; // milliseconds between attempts to reach a server that has gone

/** A session and what the server says of itself. */
interface Opened {
  session: Session;
  limits: Group;
}

/** The server that the page came from. It may ask for a token, which the user then gives once. */
export class Server {
  #token: string | undefined;
  #asking: Promise<string> | undefined;

  /** Takes a token from the address of the page, `#token=...`, and hides it there. */
  constructor() {
    const [, token] = /^#token=([\x21-\x7e]+)$/.exec(location.hash) ?? [];
    if (token) {
      history.replaceState(null, "", location.pathname + location.search);
      this.#token = token;
    }
  }

  /** A new session that is admitted. Rejects if the server does not answer. */
  async open(): Promise<Opened> {
    const session = await connect(undefined, { timeout: PATIENCE });
    let limits = await session.hello();
    for (let problem = ""; limits.admitted === 0;) {
      const token = this.#token ?? await (this.#asking ??= askForToken(problem));
      this.#asking = undefined;
      try {
        limits = await session.hello(token);
        this.#token = token;
      } catch (error) {
        if (!(error instanceof RefusedError)) {
          return this.open(); // the server closes after some wrong tokens
        }
        this.#token = undefined;
        problem = "The server refused this token.";
      }
    }
    return { session, limits };
  }

  /** A new session, as soon as the server answers. `waiting` is called before each pause. */
  async reopen(waiting: (error: unknown) => void): Promise<Opened> {
    for (let attempt = 0; ; ++attempt) {
      try {
        return await this.open();
      } catch (error) {
        waiting(error);
        await new Promise((resolve) => setTimeout(resolve, WAITS[Math.min(attempt, WAITS.length - 1)]));
      }
    }
  }
}

/** Asks the user for a token. `problem`: why the last one did not do. */
function askForToken(problem: string): Promise<string> {
  const dialog = byId("token-dialog", HTMLDialogElement);
  const input = byId("token", HTMLInputElement);
  tell(byId("token-problem", HTMLElement), problem);
  input.value = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.onclose = () => (input.value ? resolve(input.value.trim()) : dialog.showModal());
  });
}
