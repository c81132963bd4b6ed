/** The server refused a request: `error CODE sentence`. The session continues. */
export class RefusedError extends Error {
  constructor(code, sentence) {
    super(`${code}: ${sentence}`);
    this.name = "RefusedError";
    this.code = code;
  }
}

/** The server is not there, has gone, or sent what is no reply. The session has ended. */
export class LostError extends Error {
  constructor(sentence, options) {
    super(sentence, options);
    this.name = "LostError";
  }
}

/** The server did not answer in time. The session has ended. */
export class TimeoutError extends LostError {
  constructor(sentence) {
    super(sentence);
    this.name = "TimeoutError";
  }
}
