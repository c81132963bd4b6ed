// A client of the racebeam line protocol. index.d.ts describes it, and README.md is its page.

import { openAddress, processOf } from "./connections/addresses.js";
import { greet } from "./greeting.js";
import { Session } from "./session.js";

export { applyDelta, base64, hex, rle, zlib } from "./decode.js";
export { LostError, RefusedError, TimeoutError } from "./errors.js";
export { PROTOCOL } from "./greeting.js";
export { Session } from "./session.js";
export { ScreenStack } from "./stack.js";

export async function connect(address = process.env.RACEBEAM_ADDRESS ?? "", options = {}) {
  const { connection, token } = await openAddress(address, options);
  return greet(connection, address, options, options.token ?? token);
}

export function launch({ program = process.env.RACEBEAM_PROGRAM ?? "racebeam", options = [], ...rest } = {}) {
  return new Session(processOf(program, options), rest);
}
