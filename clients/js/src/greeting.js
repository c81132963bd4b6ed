import { LostError, printable } from "./errors.js";
import { Session } from "./session.js";

export const PROTOCOL = 1;

/** A session over a connection whose server speaks this client's version of the protocol. */
export async function greet(connection, address, options, token = options.token) {
  const session = new Session(connection, options);
  try {
    const { protocol } = await session.hello(token);
    if (protocol !== PROTOCOL) {
      throw new LostError(`${address} speaks version ${printable(String(protocol))} of the protocol; this client speaks ${PROTOCOL}`);
    }
    return session;
  } catch (error) {
    await session.disconnect();
    throw error;
  }
}
