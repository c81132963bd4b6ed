import { applyDelta, base64, hex, rle, zlib } from "./decode.js";
import { PIXELS, SIZES, USUAL } from "./field_table.js";

const DECODERS = { hex, rle, base64, zlib };
const WIDTH = 160;
const NUMBER = /^-?(0|[1-9]\d{0,14})(\.\d+)?$/;

/** The bytes of fields such as grey84x84x4 and rgb40x30x2; undefined for others. */
function sizeOfSmall(field) {
  const stack = /^grey84(?:x(\d+))?$/.exec(field);
  if (stack) {
    return 84 * 84 * Number(stack[1] ?? 1);
  }
  const any = /^(grey|rgb)(\d+)x(\d+)x(\d+)$/.exec(field);
  return any ? any[2] * any[3] * any[4] * (any[1] === "rgb" ? 3 : 1) : undefined;
}

function encodings(fields) {
  const found = new Map();
  for (const field of fields) {
    const [name, chosen] = field.split(":");
    const encoding = chosen ?? USUAL[name] ?? (sizeOfSmall(name) && "zlib");
    if (encoding) {
      found.set(name, encoding);
    }
  }
  return found;
}

/** The bytes of a field of screens of this height. */
function sizeOf(field, height) {
  return sizeOfSmall(field) ?? SIZES[field] ?? height * WIDTH * PIXELS[field];
}

/** The machine of the first group: 0 is that of load, 1 the first of open, which `machine=0` restores. */
function firstMachine([command, , ...rest]) {
  const restored = command === "restore" && rest.find((word) => word.startsWith("machine="));
  return restored ? Number(restored.slice("machine=".length)) + 1 : 0;
}

/** Applies a delta to the array of a field, which the last ones have changed. Returns a copy. */
function changeArray({ arrays, height }, field, text) {
  const array = arrays.get(field) ?? new Uint8Array(sizeOf(field, height));
  arrays.set(field, array);
  applyDelta(array, text);
  return array.slice();
}

/** Decodes the fields of replies. It follows what requests that were granted change about later replies. */
export class Fields {
  #chosen = new Map(); // encodings, by field
  #arrays = new Map(); // what deltas have made, by machine and field; machine 0 is that of load
  #watched = new Map(); // the same of sessions that are watched, by name: { fields, height, arrays }
  #height = 0;
  #raw; // bytes that followed the line, and belong to fields that are still to come

  /**
   * The groups of a reply. `request`: its line; `bytes`: what followed the reply's line. A value that needs time to be decoded is
   * a promise.
   */
  groups(request, line, bytes) {
    this.#raw = bytes;
    const words = request.split(" ").filter(Boolean);
    this.#follow(words, line);
    const chosen = this.#encodingsOf(words);
    const watched = words[0] === "watch" ? this.#watch(words, line) : undefined;
    const groups = [{}];
    const first = firstMachine(words);
    let source = watched ?? this.#machine(first);
    for (const word of line.split(" ").slice(1)) {
      const equals = word.indexOf("=");
      if (word === "|") {
        source = watched ?? this.#machine(first + groups.length);
        groups.push({});
      } else if (equals >= 0 && !word.startsWith("raw=")) {
        const key = word.slice(0, equals);
        groups.at(-1)[key] = this.#value(source, key.replace(/^final_/, ""), word.slice(equals + 1), chosen);
      }
    }
    return groups;
  }

  /** The encodings of the fields that a request asks for itself, or else of those that `observe` selected. */
  #encodingsOf([command, ...rest]) {
    if (command === "watch") {
      return encodings(rest.slice(1));
    }
    return command === "look" && rest.length ? encodings(rest) : this.#chosen;
  }

  /** Remembers what a request that was granted changes: the encodings of fields, and the height of screens. */
  #follow([command, ...fields], line) {
    if (command === "observe" && fields.length) {
      this.#chosen = encodings(fields);
      this.#arrays.clear();
    } else if (command === "load") {
      this.#height = Number(/ height=(\d+)/.exec(line)[1]);
      this.#arrays.clear();
    } else if (command === "open") {
      this.#arrays = new Map([[0, this.#arrays.get(0) ?? new Map()]]);
    }
  }

  /** The arrays of a machine, and the height of its screen. */
  #machine(number) {
    const arrays = this.#arrays.get(number) ?? new Map();
    this.#arrays.set(number, arrays);
    return { arrays, height: this.#height };
  }

  /** The arrays of a watched session, and the height of its screen. They begin anew with other fields. */
  #watch([, name, ...words], line) {
    const fields = words.filter((word) => !word.includes("=")).join(" ");
    const height = Number(/ height=(\d+)/.exec(line)?.[1] ?? this.#height);
    const kept = this.#watched.get(name);
    const watched = kept?.fields === fields && kept.height === height ? kept : { fields, height, arrays: new Map() };
    this.#watched.set(name, watched);
    return watched;
  }

  #value(source, field, text, chosen) {
    const encoding = chosen.get(field);
    if (encoding === undefined) {
      return NUMBER.test(text) ? Number(text) : text; // an MD5 is not a number, nor are bytes such as 0046
    }
    switch (encoding) {
      case "delta":
        return changeArray(source, field, text);
      case "raw":
        return this.#takeRaw(Number(text));
      default:
        return DECODERS[encoding](text);
    }
  }

  /** Takes the next bytes of those that followed the line. */
  #takeRaw(size) {
    if (!(size <= this.#raw.length)) {
      throw new RangeError(`${size} bytes do not follow the line`);
    }
    const bytes = new Uint8Array(this.#raw.subarray(0, size)); // their own memory
    this.#raw = this.#raw.subarray(size);
    return bytes;
  }
}
