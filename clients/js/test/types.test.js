// index.d.ts declares what index.js has.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import * as racebeam from "../src/index.js";

const declared = readFileSync(new URL("../src/index.d.ts", import.meta.url), "utf8");

const names = (pattern, text) => [...text.matchAll(pattern)].map((found) => found[1]).sort();

test("the exports are declared", () => {
  assert.deepEqual(names(/^export (?:const|function|class) (\w+)/gm, declared), Object.keys(racebeam).sort());
});

/** The methods of a class and of those that it extends. */
function methodsOf(prototype) {
  return prototype === Object.prototype ? [] : [...Object.getOwnPropertyNames(prototype), ...methodsOf(Object.getPrototypeOf(prototype))];
}

test("the methods are declared", () => {
  for (const name of ["Session", "ScreenStack"]) {
    const body = new RegExp(`^export class ${name} \\{(.*?)^\\}`, "ms").exec(declared)[1];
    const methods = names(/^ {2}(?:readonly )?(\w+)[(:]/gm, body);
    const own = methodsOf(racebeam[name].prototype);
    assert.deepEqual(methods.filter((method) => method !== "constructor"), own.filter((method) => method !== "constructor").sort());
  }
});
