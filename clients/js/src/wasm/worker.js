// What an EmulatorWorker runs: sessions of the ports that it receives after the source.

import { whenReceived } from "#system";
import { connectionTo } from "./local.js";
import { serve } from "./port.js";

let source;

whenReceived((message) => {
  if (message.port) {
    serve(message.port, connectionTo(source));
  } else {
    source = message.source;
  }
});
