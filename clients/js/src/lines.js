import { LostError, TimeoutError } from "./errors.js";

/** Requests and replies over a connection: the replies come in the order of the requests. */
export class Lines {
  #connection;
  #timeout;
  #waiting = []; // { resolve, reject } of requests without a reply
  #farewell; // a reply without a request: the server says why it ends
  #ended; // an error
  #timer;
  #closed;
  #resolveLost;

  /** Resolves with the reason, once the connection has ended. */
  lost = new Promise((resolve) => (this.#resolveLost = resolve));

  constructor(connection, { timeout, longestReply }) {
    this.#connection = connection;
    this.#timeout = timeout;
    connection.listen({ reply: (line, bytes) => this.#answer({ line, bytes }), lost: (error) => this.#lose(error) }, longestReply);
  }

  /** Sends a line, and returns a promise of its reply: { line, bytes }. */
  ask(line) {
    return new Promise((resolve, reject) => {
      if (this.#farewell !== undefined) {
        resolve(this.#farewell);
        this.#farewell = undefined;
        return;
      }
      if (this.#ended) {
        reject(new LostError(`the session has ended: ${this.#ended.message}`, { cause: this.#ended }));
        return;
      }
      this.#waiting.push({ resolve, reject });
      if (this.#waiting.length === 1) {
        this.#restartTimer();
      }
      this.#connection.send(line);
    });
  }

  /** Ends the connection, and rejects what waits with `error`. */
  end(error = new LostError("the client closed the session")) {
    this.#farewell = undefined;
    this.#lose(error);
    return this.#closed;
  }

  #answer(reply) {
    const next = this.#waiting.shift();
    this.#restartTimer();
    if (next) {
      next.resolve(reply);
    } else if (!this.#ended) {
      this.#farewell = reply;
    }
  }

  /** Limits the time until the next reply, if a request waits for one. */
  #restartTimer() {
    clearTimeout(this.#timer);
    if (this.#timeout && this.#waiting.length) {
      this.#timer = setTimeout(() => this.#lose(new TimeoutError(`the server did not answer in ${this.#timeout} ms`)), this.#timeout);
    }
  }

  #lose(error) {
    if (this.#ended) {
      return;
    }
    this.#ended = error;
    this.#resolveLost(error);
    clearTimeout(this.#timer);
    this.#closed = Promise.resolve(this.#connection.end());
    for (const { reject } of this.#waiting.splice(0)) {
      reject(error);
    }
  }
}
