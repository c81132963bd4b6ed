// The line protocol over a MessagePort: a message is a request's line or an image to add, or a reply's line and bytes.

import { LostError } from "../errors.js";

/** A connection to the session that serve() has at the other end. `failed`: a promise that the failure of a worker rejects. */
export class PortConnection {
  #port;
  #failed;

  constructor(port, failed) {
    this.#port = port;
    this.#failed = failed;
  }

  /** Gives each reply to `receiver`: reply(line, bytes), and lost(error) at the end. */
  listen(receiver) {
    this.#port.onmessage = ({ data: { line, bytes, lost } }) => {
      if (lost === undefined) {
        receiver.reply(line, bytes);
      } else {
        receiver.lost(new LostError(lost));
      }
    };
    this.#failed.catch((error) => receiver.lost(new LostError(`the worker has failed: ${error.message}`, { cause: error })));
  }

  send(request) {
    this.#port.postMessage(request);
  }

  end() {
    this.#port.postMessage(null);
    this.#port.close();
  }
}

/** Lets the other end of a port use a connection. `connecting` is a promise of it. */
export async function serve(port, connecting) {
  try {
    const connection = await connecting;
    connection.listen({
      reply: (line, bytes) => port.postMessage({ line, bytes }, [bytes.buffer]),
      lost: (error) => port.postMessage({ lost: error.message }),
    });
    port.onmessage = ({ data: request }) => {
      if (request === null) {
        connection.end();
        port.close();
      } else {
        connection.send(request);
      }
    };
  } catch (error) {
    port.postMessage({ lost: error.message });
  }
}
