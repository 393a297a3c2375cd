// Every built-in scene and the conformance suite as glTF: the Khronos validator finds no error and no warning in them.
//   node gltf_validator_test.mjs GNOMON FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(new URL("../browser/package.json", import.meta.url));
let validator;
try {
  validator = require("gltf-validator");
} catch {
  console.log("skipped: gltf-validator is not installed: npm install --no-save --prefix tests/browser");
  process.exit(77);
}

async function messages(bytes) {
  const { issues } = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 100 });
  return issues.messages.filter((m) => m.severity <= 1).map((m) => `${m.code} ${m.pointer}: ${m.message}`);
}

const [gnomon, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const { scenes } = JSON.parse(execFileSync(gnomon, ["scenes", "--json", "-"]));
for (const { name } of scenes)
  execFileSync(gnomon, [
    "export",
    name,
    "--tessellate",
    "16",
    "--quiet",
    "-o",
    join(folder, `${name}.${name === "teapot" ? "gltf" : "glb"}`),
  ]);
execFileSync(gnomon, ["export", "--suite", join(folder, "suite"), "--size", "16x9", "--quiet"]);
const files = readdirSync(folder, { recursive: true }).filter((name) => /\.gl(b|tf)$/.test(name));
assert.equal(files.length, scenes.length + 12);
for (const name of files) assert.deepEqual(await messages(readFileSync(join(folder, name))), [], name);

// It can fail: a light that does not exist.
const json = JSON.parse(readFileSync(join(folder, "teapot.gltf"), "utf8"));
json.nodes.find((node) => node.extensions).extensions.KHR_lights_punctual.light = 99;
assert.notDeepEqual(await messages(Buffer.from(JSON.stringify(json))), []);
console.log(`${files.length} files, 0 errors, 0 warnings`);
