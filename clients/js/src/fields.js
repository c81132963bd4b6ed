import { applyDelta, base64, hex, rle, zlib } from "./decode.js";

const DECODERS = { hex, rle, base64, zlib };
const USUAL = { ram: "hex", screen: "rle", rgb: "zlib", grey: "zlib", palette: "hex", audio: "hex" };
const SIZES = { ram: 128, palette: 768, audio: 512 };
const WIDTH = 160;
const NUMBER = /^-?(0|[1-9]\d{0,14})(\.\d+)?$/;

/** The bytes of fields such as grey84x4 and rgb40x30x2; undefined for others. */
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
    const [name, told] = field.split(":");
    const encoding = told ?? USUAL[name] ?? (sizeOfSmall(name) && "zlib");
    if (encoding) {
      found.set(name, encoding);
    }
  }
  return found;
}

/** Decodes the fields of replies. It follows what requests that were granted change about later replies. */
export class Fields {
  #chosen = new Map();
  #arrays = new Map(); // what deltas have made, by machine and field; machine 0 is that of load
  #height = 0;

  /** The groups of a reply. `request`: its line. */
  groups(request, line) {
    const words = request.split(" ").filter(Boolean);
    this.#follow(words, line);
    const chosen = words[0] === "look" && words.length > 1 ? encodings(words.slice(1)) : this.#chosen;
    const groups = [{}];
    for (const word of line.split(" ").slice(1)) {
      const equals = word.indexOf("=");
      if (word === "|") {
        groups.push({});
      } else if (equals >= 0) {
        const key = word.slice(0, equals);
        groups.at(-1)[key] = this.#value(groups.length - 1, key.replace(/^final_/, ""), word.slice(equals + 1), chosen);
      }
    }
    return groups;
  }

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

  #value(machine, field, text, chosen) {
    const encoding = chosen.get(field);
    if (encoding === undefined) {
      return NUMBER.test(text) ? Number(text) : text; // an MD5 is no number, nor are bytes such as 0046
    }
    return encoding === "delta" ? this.#changed(machine, field, text) : DECODERS[encoding](text);
  }

  #changed(machine, field, text) {
    const kept = this.#arrays.get(machine) ?? new Map();
    this.#arrays.set(machine, kept);
    const array = kept.get(field) ?? new Uint8Array(this.#size(field));
    kept.set(field, array);
    applyDelta(array, text);
    return array.slice();
  }

  #size(field) {
    return sizeOfSmall(field) ?? SIZES[field] ?? this.#height * WIDTH * (field === "rgb" ? 3 : 1);
  }
}
