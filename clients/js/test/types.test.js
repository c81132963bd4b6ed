// Each index.d.ts declares what its index.js has.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import * as racebeam from "../src/index.js";
import * as wasm from "../src/wasm/index.js";

const read = (name) => readFileSync(new URL(`../src/${name}`, import.meta.url), "utf8");
const declared = read("index.d.ts"), declaredWasm = read("wasm/index.d.ts");

const names = (pattern, text) => [...text.matchAll(pattern)].map((found) => found[1]).sort();

test("the exports are declared", () => {
  for (const [text, module] of [[declared, racebeam], [declaredWasm, wasm]]) {
    assert.deepEqual(names(/^export (?:const|function|class) (\w+)/gm, text), Object.keys(module).sort());
  }
});

/** The methods of a class and of those that it extends. */
function methodsOf(prototype) {
  return prototype === Object.prototype ? [] : [...Object.getOwnPropertyNames(prototype), ...methodsOf(Object.getPrototypeOf(prototype))];
}

test("the methods are declared", () => {
  const classes = { Session: [declared, racebeam], ScreenStack: [declared, racebeam], EmulatorWorker: [declaredWasm, wasm] };
  for (const [name, [text, module]] of Object.entries(classes)) {
    const body = new RegExp(`^export class ${name} \\{(.*?)^\\}`, "ms").exec(text)[1];
    const methods = names(/^ {2}(?:readonly )?(\w+)[(:]/gm, body);
    const own = methodsOf(module[name].prototype);
    assert.deepEqual(methods.filter((method) => method !== "constructor"), own.filter((method) => method !== "constructor").sort());
  }
});
