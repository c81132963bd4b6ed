// The encodings of fields that are bytes. Each function takes a text, and returns a Uint8Array. It throws a RangeError if the text
// has another form.

import { fromBase64, inflate } from "#platform";

const DIGITS = new Int16Array(256).fill(-1);
for (const digit of "0123456789ABCDEFabcdef") {
  DIGITS[digit.charCodeAt(0)] = parseInt(digit, 16);
}

/** The byte of the two digits at `at`. */
function octet(text, at) {
  const high = DIGITS[text.charCodeAt(at)];
  const low = DIGITS[text.charCodeAt(at + 1)];
  if (!(high >= 0 && low >= 0)) { // undefined beyond the end, and for characters beyond 255
    throw new RangeError(`not a byte in hexadecimal: '${text.slice(at, at + 2)}'`);
  }
  return (high << 4) | low;
}

export function hex(text) {
  const bytes = new Uint8Array(Math.ceil(text.length / 2));
  for (let at = 0; at < bytes.length; ++at) {
    bytes[at] = octet(text, 2 * at);
  }
  return bytes;
}

export function rle(text) {
  const runs = hex(text);
  if (runs.length % 2) {
    throw new RangeError("half a run");
  }
  let size = 0;
  for (let at = 1; at < runs.length; at += 2) {
    size += runs[at];
  }
  const bytes = new Uint8Array(size);
  for (let at = 0, place = 0; at < runs.length; place += runs[at + 1], at += 2) {
    bytes.fill(runs[at], place, place + runs[at + 1]);
  }
  return bytes;
}

export function base64(text) {
  if (text.length % 4 || !/^[A-Za-z0-9+/]*={0,2}$/.test(text)) {
    throw new RangeError("not base64");
  }
  return fromBase64(text);
}

/** Throws the error of a damaged stream. */
function refuseStream(error) {
  throw new RangeError(`the zlib stream is damaged: ${error.message}`, { cause: error });
}

/** In a browser it returns a promise. */
export function zlib(text) {
  try {
    const inflated = inflate(base64(text));
    return inflated instanceof Promise ? inflated.catch(refuseStream) : inflated;
  } catch (error) {
    return refuseStream(error);
  }
}

/** Changes `array` by a delta. */
export function applyDelta(array, text) {
  let at = 0;
  let place = 0;
  while (at < text.length) {
    place += (octet(text, at) << 8) | octet(text, at + 2);
    const runs = octet(text, at + 4);
    at += 6;
    for (let run = 0; run < runs; ++run, at += 4) {
      const end = place + octet(text, at + 2);
      if (end > array.length) {
        throw new RangeError(`a delta reaches byte ${end} of ${array.length}`);
      }
      array.fill(octet(text, at), place, end);
      place = end;
    }
  }
}

/** A list from R,R*TIMES,... */
export function rewards(text) {
  return String(text).split(",").filter(Boolean).flatMap((run) => {
    const [reward, times = 1] = run.split("*");
    return new Array(Number(times)).fill(Number(reward));
  });
}
