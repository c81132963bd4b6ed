import type { Session } from "racebeam";
import { EmulatorWorker, type AddedImage, type Beside, type NamedBlob } from "racebeam/wasm";

const worker = new EmulatorWorker({
  source: new URL("racebeam.wasm", document.baseURI),
  script: new URL("worker.js", document.baseURI),
});

/** A session of the page's own emulator. */
export function open(): Promise<Session> {
  return worker.open();
}

/** Makes an image known to these sessions. */
export function addImage(file: NamedBlob, beside: Beside): Promise<AddedImage> {
  return worker.addImage(file, beside);
}
