// The client as a browser gets it, in a process of Node under the condition "browser".

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import test from "node:test";
import { deflateSync } from "node:zlib";

/** What a program of a module prints as JSON, where "racebeam" is the package for browsers. */
function printed(program) {
  const text = execFileSync(process.execPath, ["--conditions=browser", "--input-type=module", "-e", program], { cwd: new URL("..", import.meta.url) });
  return JSON.parse(text);
}

test("it has what the client for Node has, but what only Node can", () => {
  const here = printed('import * as racebeam from "racebeam"; console.log(JSON.stringify(Object.keys(racebeam)))');
  const there = printed('import * as racebeam from "./src/index.js"; console.log(JSON.stringify(Object.keys(racebeam)))');
  assert.deepEqual(there.filter((name) => !here.includes(name)), ["launch", "zlib"]);
});

test("it decodes as the client for Node does", () => {
  const packed = deflateSync(Uint8Array.of(1, 2, 3)).toString("base64");
  const shown = printed(`
    import { connect } from "racebeam";
    const replies = { hello: "ok protocol=1", observe: "ok fields=ram,grey,audio", act: "ok ram=${packed} grey=AQID audio=01FF" };
    const answer = (line) => replies[line.split(" ")[0]];
    class Socket extends EventTarget {
      constructor(url) { super(); this.url = url; setImmediate(() => this.dispatchEvent(new Event("open"))); }
      send(line) { setImmediate(() => this.dispatchEvent(Object.assign(new Event("message"), { data: answer(line) }))); }
      close() {}
    }
    globalThis.location = { protocol: "https:", host: "here:1" };
    const session = await connect(undefined, { WebSocket: Socket });
    await session.observe("ram:zlib", "grey:base64", "audio:hex");
    const { ram, grey, audio } = await session.act("FIRE");
    const damaged = await session.act("FIRE").then(() => "fine", (error) => error.name);
    console.log(JSON.stringify([[...ram], [...grey], [...audio], damaged]));
  `.replace('const answer = (line) => replies[line.split(" ")[0]];', `let acts = 0;
    const answer = (line) => (line.startsWith("act") && ++acts === 2 ? "ok ram=AAAA" : replies[line.split(" ")[0]]);`));
  assert.deepEqual(shown, [[1, 2, 3], [1, 2, 3], [1, 255], "LostError"]);
});

test("an invalid address is refused", () => {
  assert.deepEqual(printed(`
    import { connect } from "racebeam";
    console.log(JSON.stringify(await connect("tcp://127.0.0.1:1").catch((error) => error.name)));`), "TypeError");
});
