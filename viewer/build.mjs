// Bundles the page into dist/, or into the folder that is given. `--static FOLDER`: the page without a server, which needs
// racebeam.wasm beside it. `--tests KIND [NAME]`: bundles the tests in test/KIND, or those whose files begin with NAME, for Node,
// into build/viewer/KIND/all.test.js.

import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, symlinkSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = path.dirname(fileURLToPath(import.meta.url));
const catalogue = path.join(here, "../games/catalogue");

/** The titles of the catalogue's games, by their names. */
function titles() {
  const files = readdirSync(catalogue).filter((file) => file.endsWith(".toml")).sort();
  return Object.fromEntries(files.map((file) => {
    const [, title] = /^title\s*=\s*(".*")/m.exec(readFileSync(path.join(catalogue, file), "utf8"));
    return [path.basename(file, ".toml"), JSON.parse(title)];
  }));
}

const common = {
  absWorkingDir: here, bundle: true, format: "esm", target: "es2022", logLevel: "warning", charset: "utf8",
};

function defined(withoutServer) {
  return { TITLES: JSON.stringify(titles()), WITHOUT_SERVER: String(withoutServer) };
}

async function page(folder, withoutServer = false) {
  const small = { ...common, outdir: folder, minify: true, legalComments: "none", define: defined(withoutServer) };
  const worker = withoutServer ? { worker: "racebeam/wasm/worker" } : {};
  await build({ ...small, entryPoints: { viewer: "src/main.ts", sound: "src/sound/worklet.ts", ...worker } });
  await build({ ...small, entryPoints: ["src/viewer.css"] });
  for (const name of ["index.html", "favicon.svg"]) {
    copyFileSync(path.join(here, "src", name), path.join(folder, name));
  }
}

async function tests(kind, named) {
  const folder = path.join(here, "../build/viewer", kind);
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  symlinkSync(path.join(here, "node_modules"), path.join(folder, "node_modules"));
  const files = readdirSync(path.join(here, "test", kind)).filter((name) => name.endsWith(".test.ts") && name.startsWith(named));
  const contents = files.map((name) => `import "./${name}";`).join("\n");
  const stdin = { contents, resolveDir: path.join(here, "test", kind) };
  await build({ ...common, define: defined(false), stdin, outfile: path.join(folder, "all.test.js"), platform: "node", packages: "external" });
}

const [, , option, argument, named = ""] = process.argv;
switch (option) {
  case "--tests":
    await tests(argument, named);
    break;
  case "--static":
    await page(path.resolve(argument), true);
    break;
  default:
    await page(path.resolve(option ?? path.join(here, "dist")));
}
