import { LostError, printable } from "../errors.js";
import { rawSize } from "../raw.js";

const NEWLINE = 10;
const NOTHING = new Uint8Array(0);

/** Why a connection ended: an error that says so itself, or the end of the server. */
function reasonOf(error) {
  return error instanceof LostError ? error : new LostError("the server has closed the connection", { cause: error });
}

/** A connection over two streams of Node, such as those of a socket. */
export class Streams {
  #streams;
  #receiver;
  #longest;
  #pieces = []; // of a line or of its bytes, which have begun
  #length = 0;
  #line; // a line whose bytes are still to come
  #size = 0; // how many bytes

  /** `streams`: { input, output, end() }; end() may return a promise. */
  constructor(streams) {
    this.#streams = streams;
  }

  /** Gives each reply to `receiver`: reply(line, bytes), and lost(error) at the end. */
  listen(receiver, longest) {
    this.#receiver = receiver;
    this.#longest = longest;
    const { input, output } = this.#streams;
    input.on("data", (data) => this.#read(data));
    for (const event of ["end", "close", "error"]) {
      input.on(event, (error) => receiver.lost(reasonOf(error)));
    }
    output.on("error", () => {}); // the end of the input tells more
  }

  send(line) {
    this.#streams.output.write(`${line}\n`, "latin1");
  }

  end() {
    this.#pieces = [];
    this.#length = 0;
    return this.#streams.end();
  }

  #read(data) {
    for (let rest = data; rest.length;) {
      rest = this.#line === undefined ? this.#readLine(rest) : this.#readBytes(rest);
    }
    if (Math.max(this.#length, this.#size) > this.#longest) {
      this.#receiver.lost(new LostError(`the server's reply is longer than ${this.#longest} bytes`));
    }
  }

  /** Takes a line or a part of one. Returns what is left. */
  #readLine(data) {
    const end = data.indexOf(NEWLINE);
    if (end < 0) {
      this.#keep(data);
      return NOTHING;
    }
    this.#keep(data.subarray(0, end));
    const line = this.#takePieces().toString("latin1");
    this.#size = rawSize(line);
    if (Number.isNaN(this.#size)) {
      this.#size = 0;
      this.#receiver.lost(new LostError(`the server's reply ends in 'raw=' without a number of bytes: ${printable(line.slice(-40))}`));
    } else if (this.#size) {
      this.#line = line;
    } else {
      this.#receiver.reply(line, NOTHING);
    }
    return data.subarray(end + 1);
  }

  /** Takes bytes that follow a line, or a part of them. Returns what is left. */
  #readBytes(data) {
    const missing = this.#size - this.#length;
    this.#keep(data.subarray(0, missing));
    if (data.length >= missing) {
      const line = this.#line;
      this.#line = undefined;
      this.#size = 0;
      this.#receiver.reply(line, this.#takePieces());
    }
    return data.subarray(missing);
  }

  #keep(piece) {
    this.#pieces.push(piece);
    this.#length += piece.length;
  }

  #takePieces() {
    const whole = this.#pieces.length === 1 ? this.#pieces[0] : Buffer.concat(this.#pieces, this.#length);
    this.#pieces = [];
    this.#length = 0;
    return whole;
  }
}
