// A client of the racebeam line protocol. index.d.ts describes it, and README.md is its page.

import { LostError } from "./errors.js";
import { Session } from "./session.js";
import { openAddress, processOf } from "./transports.js";

export { applyDelta, base64, hex, rle, zlib } from "./decode.js";
export { LostError, RefusedError, TimeoutError } from "./errors.js";
export { Session } from "./session.js";
export { ScreenStack } from "./stack.js";

export const PROTOCOL = 1;

export async function connect(address = process.env.RACEBEAM_ADDRESS ?? "", options = {}) {
  const connection = await openAddress(address, options);
  const session = new Session(connection, options);
  try {
    const { protocol } = await session.hello(options.token ?? connection.token);
    if (protocol !== PROTOCOL) {
      throw new LostError(`${address} speaks version ${protocol} of the protocol; this client speaks ${PROTOCOL}`);
    }
    return session;
  } catch (error) {
    await session.disconnect();
    throw error;
  }
}

export function launch({ program = process.env.RACEBEAM_PROGRAM ?? "racebeam", options = [], ...rest } = {}) {
  return new Session(processOf(program, options), rest);
}
