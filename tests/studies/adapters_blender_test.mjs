// The adapters that run in Blender, on a small scene, and judged. node adapters_blender_test.mjs GNOMON FOLDER
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { captured, judge, makeScenes, refused } from "../support/adapters.mjs";
import { differences } from "../../adapters/second_truth.mjs";

const [gnomon, folder] = process.argv.slice(2);
if (spawnSync("blender", ["--version"]).error) {
  console.log("skipped: adapters cycles and eevee: Blender is not installed");
  process.exit(77);
}
makeScenes(gnomon, folder);

// A second truth: not one pixel of 9,000 differs.
const cycles = captured(folder, "cycles", "floating-box"),
  verdict = judge(gnomon, cycles, "-o", `${cycles}/verdict`, "--aov", `${cycles}/judged.exr`);
assert.equal(verdict.judged.renderer.name, "Cycles");
assert.ok(verdict.lights[0].pixels.compared > 8000);
assert.equal(verdict.lights[0].error.wrong, 0);
assert.deepEqual(differences(`${folder}/floating-box.glb`, `${cycles}/judged.exr`, cycles), []);
assert.match(refused(folder, "cycles", "floating-box", "--samples", "4"), /--samples: no such option/);

if (spawnSync("xvfb-run", ["--help"]).error) console.log("skipped: adapter eevee: xvfb-run is not installed");
else {
  const eevee = judge(gnomon, captured(folder, "eevee", "floating-box", "--samples", "8"));
  assert.equal(eevee.judged.renderer.name, "EEVEE");
  assert.ok(eevee.lights[0].error.wrong_fraction < 0.01, String(eevee.lights[0].error.wrong_fraction));
}
console.log("cycles and eevee: fine");
