import { LostError, TimeoutError } from "./errors.js";

const NEWLINE = 10;

/** Requests and replies over a connection: the replies come in the order of the requests. */
export class Lines {
  #connection;
  #timeout;
  #longest;
  #waiting = []; // { resolve, reject } of requests without a reply
  #pieces = []; // of a line that has begun
  #length = 0;
  #farewell; // a line without a request: the server says why it ends
  #ended; // an error
  #timer;
  #closed;

  constructor(connection, { timeout, longestReply }) {
    this.#connection = connection;
    this.#timeout = timeout;
    this.#longest = longestReply;
    connection.input.on("data", (data) => this.#read(data));
    for (const event of ["end", "close", "error"]) {
      connection.input.on(event, (error) => this.#lose(new LostError("the server has closed the connection", { cause: error })));
    }
    connection.output.on("error", () => {}); // the end of the input tells more
  }

  /** Sends a line, and returns a promise of its reply. */
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
        this.#watch();
      }
      this.#connection.output.write(`${line}\n`, "latin1");
    });
  }

  /** Ends the connection, and rejects what waits with `error`. */
  end(error = new LostError("the session has ended")) {
    this.#farewell = undefined;
    this.#lose(error);
    return this.#closed;
  }

  #read(data) {
    let begin = 0;
    for (let end; (end = data.indexOf(NEWLINE, begin)) >= 0; begin = end + 1) {
      this.#pieces.push(data.subarray(begin, end));
      const line = Buffer.concat(this.#pieces).toString("latin1");
      this.#pieces = [];
      this.#length = 0;
      this.#answer(line);
    }
    this.#pieces.push(data.subarray(begin));
    this.#length += data.length - begin;
    if (this.#length > this.#longest) {
      this.#lose(new LostError(`the server's reply is longer than ${this.#longest} bytes`));
    }
  }

  #answer(line) {
    const next = this.#waiting.shift();
    this.#watch();
    if (next) {
      next.resolve(line);
    } else if (!this.#ended) {
      this.#farewell = line;
    }
  }

  /** Limits the time until the next reply. */
  #watch() {
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
    clearTimeout(this.#timer);
    this.#pieces = [];
    this.#closed = Promise.resolve(this.#connection.end());
    for (const { reject } of this.#waiting.splice(0)) {
      reject(error);
    }
  }
}
