import { connect, RefusedError, type Group, type Session } from "racebeam";
import { byId, tell } from "./elements.js";

declare const WITHOUT_SERVER: boolean; // build.mjs --static: the page has the emulator

const PATIENCE = 30_000; // milliseconds until a reply
const PICTURES = "pictures"; // sessions of any page that make small pictures
const WAITS = [250, 500, 1000, 2000]; // milliseconds between attempts to reach a server that has gone

/** A session and what the server says of itself. */
interface Opened {
  session: Session;
  limits: Group;
}

/** The server that the page came from. It may ask for a token, which the user then gives once. */
export class Server {
  readonly #claimed = new WeakSet<Session>();
  readonly #own = new Set<string>(); // names of this page's sessions, where the server shares all sessions
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
    const session = WITHOUT_SERVER ? await (await import("./emulator.js")).open() : await connect(undefined, { timeout: PATIENCE });
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

  /** Names a session that has loaded a game, so that the page knows it among the shared ones, where the server shares all. */
  async claim(session: Session, purpose: "player" | "replay" | typeof PICTURES): Promise<void> {
    if (!this.#claimed.has(session)) {
      this.#claimed.add(session);
      if (await sharesAll(session)) {
        const name = `${purpose}-${crypto.getRandomValues(new Uint32Array(1))[0]!.toString(36)}`;
        await session.share(name);
        this.#own.add(name);
      }
    }
  }

  /** Whether a shared session is this page's own, or only makes some page's pictures. */
  owns(name: string): boolean {
    return this.#own.has(name) || name.startsWith(`${PICTURES}-`);
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

/** What failed, for people: a refusal without its code. */
export function sentenceOf(error: unknown): string {
  if (error instanceof RefusedError) {
    return error.message.slice(`${error.code}: `.length);
  }
  return error instanceof Error ? error.message : String(error);
}

/** The same, without the advice for authors of clients after the semicolon. */
export function reasonOf(error: unknown): string {
  return error instanceof RefusedError ? sentenceOf(error).split(";")[0]! : sentenceOf(error);
}

/** Whether the server shares all sessions: it then refuses to unshare one. */
async function sharesAll(session: Session): Promise<boolean> {
  try {
    await session.unshare();
    return false;
  } catch (error) {
    if (error instanceof RefusedError) {
      return true;
    }
    throw error;
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
