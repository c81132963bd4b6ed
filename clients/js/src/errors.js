/** The server refused a request: `error CODE sentence`. The session continues. */
export class RefusedError extends Error {
  constructor(code, sentence) {
    super(`${code}: ${sentence}`);
    this.name = "RefusedError";
    this.code = code;
  }
}

/** The server is not there, has gone, or sent an invalid reply. The session has ended. */
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

/** What a server sent, for people: a terminal would execute some of its characters. */
export function printable(text) {
  return text.replace(/[^ -~]/gu, (character) => {
    const code = character.codePointAt(0).toString(16);
    return code.length <= 2 ? `\\x${code.padStart(2, "0")}` : `\\u{${code}}`;
  });
}
