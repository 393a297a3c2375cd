// What `./gnomon web --pack` makes of the program for the web: an npm package, as a folder and as the tarball that npm installs.
// Usage: pack.mjs BUILD [FOLDER]. BUILD/app has the program; the package comes into FOLDER/package and FOLDER/gnomon-web-VERSION.tgz,
// whose path is printed [default BUILD].
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import path from "node:path";
import { schemaTypes } from "../../../report/page/schema_types.mjs";
import { optionTypes } from "./types.mjs";

const [build, out = build] = process.argv.slice(2).map((word) => path.resolve(word));
const app = path.join(build, "app"),
  folder = path.join(out, "package");
const root = fileURLToPath(new URL("../../../", import.meta.url)),
  here = fileURLToPath(new URL("./", import.meta.url));
const gnomon = (...words) =>
  execFileSync(process.execPath, [path.join(app, "gnomon.js"), ...words], { encoding: "utf8", maxBuffer: 1 << 26 });

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const files = [
  ...["gnomon.js", "gnomon.mjs", "gnomon.wasm", "gnomon_worker.mjs"].map((name) => path.join(app, name)),
  path.join(here, "index.mjs"),
  path.join(here, "README.md"),
  path.join(root, "adapters/exr_blocks.mjs"),
  path.join(root, "LICENSE"),
];
for (const file of files) copyFileSync(file, path.join(folder, path.basename(file)));

const manual = gnomon("--manual", "options");
const commands = [
  ["raster", "DrawOptions"],
  ["raytrace", "TraceOptions"],
  ["compare", "CompareOptions"],
  ["judge", "JudgeOptions"],
];
writeFileSync(
  path.join(folder, "index.d.ts"),
  [
    "// Made by ./gnomon web --pack: options are those of the command line, results those of the JSON schemas.",
    readFileSync(path.join(here, "functions.d.ts"), "utf8"),
    ...commands.map(([command, name]) => optionTypes(manual, command, name)),
    schemaTypes(JSON.parse(gnomon("--manual", "schema")), "Result"),
  ].join("\n"),
);

const version = /\d+\.\d+\.\d+/.exec(gnomon("--version"))[0];
writeFileSync(
  path.join(folder, "package.json"),
  `${JSON.stringify(
    {
      name: "gnomon-web",
      version,
      private: true, // it is installed from its file, and no registry has it by this name
      description: "Where a shadow map's shadows are wrong, and why: draw, trace, compare and judge, in a page or in Node.",
      license: "MIT",
      type: "module",
      exports: { ".": { types: "./index.d.ts", default: "./index.mjs" } },
      types: "./index.d.ts",
      bin: { gnomon: "gnomon.js" },
      engines: { node: ">=18" },
    },
    null,
    2,
  )}\n`,
);

const tarball = path.join(out, `gnomon-web-${version}.tgz`);
execFileSync("tar", ["--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--mtime=@0", "-czf", tarball, "-C", out, "package"]);
console.log(tarball);
