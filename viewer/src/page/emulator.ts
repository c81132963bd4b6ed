import type { Session } from "racebeam";
import { EmulatorWorker } from "racebeam/wasm";

const worker = new EmulatorWorker({
  source: new URL("racebeam.wasm", document.baseURI),
  script: new URL("worker.js", document.baseURI),
});

/** A session of the page's own emulator. */
export function open(): Promise<Session> {
  return worker.open();
}
