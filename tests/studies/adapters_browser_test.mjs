// The adapters of engines for the web, each run in headless Chromium on small scenes and judged.
//   node adapters_browser_test.mjs GNOMON FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { captured, isThere, judge, makeScenes, refused } from "../support/adapters.mjs";

const [gnomon, folder] = process.argv.slice(2);
const chromiumPath = ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium"].find(existsSync);
if (!isThere("playwright-core") || !chromiumPath) {
  console.log("skipped: the adapters' packages or Chromium are not installed: npm install --prefix adapters");
  process.exit(77);
}
makeScenes(gnomon, folder);
const only = process.env.GNOMON_ENGINE; // one engine instead of all

/** The ladder's V5 on an engine's own map is its picture: of 9,000 pixels a few lie on the border of two texels, where floats and
    doubles may look up either. */
function climbed(scene, ...options) {
  const result = judge(gnomon, captured(folder, "three", scene, "--type", "basic", ...options));
  assert.equal(result.judged.renderer.name, "three.js");
  assert.match(result.judged.renderer.version, /^r\d+$/);
  assert.ok(result.judged.biased_is_drawn > 0.998, `${scene}: ${result.judged.biased_is_drawn}`);
  assert.ok(result.judged.agreement.find(({ of }) => of === "positions").share > 0.99, scene);
  return result;
}

/** three.js hands over its map: of a spot, a cube of six layers, and a sun's, where the advice must keep its promise. */
function three() {
  climbed("spot-rim", "--bias", "-0.001");
  climbed("cube-seams", "--bias", "-0.001");
  const {
    instead,
    wrong_now: now,
    wrong_instead: promised,
  } = climbed("floating-box").judged.advice.find(({ setting }) => setting === "bias.constant_depth");
  assert.ok(now > 0.2 && promised < 0.01, `${now} ${promised}`);
  const { pixels, error } = climbed("floating-box", "--bias", String(-instead)).lights[0];
  // Within a tenth, or two pixels: those on borders again.
  assert.ok(
    Math.abs(error.wrong_fraction - promised) < Math.max(0.1 * promised, 2 / pixels.compared),
    `${error.wrong_fraction} for ${promised}`,
  );
  assert.match(refused(folder, "three", "floating-box", "--light", "moon"), /--light: no such light \(got moon/);
}

/** The boxes of floating-box through an orthographic camera, one that casts nothing and a floor that receives nothing being
    added or not. */
function makeFlagged(name, ...changes) {
  execFileSync(gnomon, ["export", "floating-box", "-o", join(folder, `${name}.gltf`), "--quiet"]);
  const gltf = JSON.parse(readFileSync(join(folder, `${name}.gltf`), "utf8"));
  gltf.cameras[0] = { type: "orthographic", orthographic: { xmag: 1.4, ymag: 0.8, znear: 0.01, zfar: 20 } };
  for (const change of changes) change(gltf);
  writeFileSync(join(folder, `${name}.gltf`), JSON.stringify(gltf));
}
const boxes = (gltf) => gltf.nodes.filter(({ mesh, name }) => mesh !== undefined && !/floor|ground/.test(name));

/** The camera's positions are the file's. What that says of casting and receiving holds in the engine's picture, which is then as right
    as that of the same scene without flags; were they ignored, the boxes' shadows would be wrong on a twentieth of the pixels. */
function flagged(engine, ...options) {
  const error = (name) => {
    const {
      judged,
      lights: [
        {
          pixels,
          error: { wrong },
        },
      ],
    } = judge(gnomon, captured(folder, engine, name, ...options));
    assert.ok(pixels.compared > 5000, `${engine} ${name}: ${pixels.compared}`);
    const positions = judged.agreement.find(({ of }) => of === "positions").share;
    assert.ok(positions > 0.99, `${engine} ${name}: ${positions}`);
    return wrong / pixels.compared;
  };
  const plainly = error("ortho");
  for (const name of ["casts-nothing", "receives-nothing"]) {
    const share = error(name);
    assert.ok(share < Math.min(plainly, 0.02), `${engine} ${name}: ${share}, with all flags ${plainly}`);
  }
}

/** The others are judged by their pictures: a sun's shadow at the engine's own settings is mostly right. */
function plain(engine, name, ...options) {
  const result = judge(gnomon, captured(folder, engine, "floating-box", ...options));
  assert.equal(result.judged.renderer.name, name);
  assert.ok(result.lights[0].pixels.compared > 8000, engine);
  assert.ok(result.lights[0].error.wrong_fraction < 0.05, `${engine}: ${result.lights[0].error.wrong_fraction}`);
}

/** The page of a picture whose map is not known: viewer and probe say what was drawn, and nothing of light space. */
async function openReport(engine) {
  const verdict = join(folder, `${engine}-floating-box`);
  judge(gnomon, verdict, "-o", join(verdict, "report"));
  const { chromium } = await import(new URL("../../adapters/node_modules/playwright-core/index.mjs", import.meta.url));
  const browser = await chromium.launch({ executablePath: chromiumPath });
  const page = await browser.newPage(),
    errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  await page.goto(`file://${resolve(verdict, "report", "report.html")}`);
  const words = await page.waitForSelector(".probe-words .story", { state: "attached" }).then((story) => story.textContent());
  assert.match(words, /^Drawn [\d.]+; the exact rays give|^Not compared/);
  assert.equal(await page.locator(".left-out").count(), 0);
  assert.equal(await page.locator(".section-bar").isVisible(), false);
  assert.deepEqual(errors, []);
  await browser.close();
}

/** The page of several verdicts, whose script finds no comparison to bring to life. */
async function openSeveral(scenes) {
  const verdicts = join(folder, "several");
  execFileSync(gnomon, ["judge", ...scenes.map((scene) => join(folder, `three-${scene}`, "capture.json")), "-o", verdicts, "--quiet"]);
  const { chromium } = await import(new URL("../../adapters/node_modules/playwright-core/index.mjs", import.meta.url));
  const browser = await chromium.launch({ executablePath: chromiumPath });
  const page = await browser.newPage(),
    errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  await page.goto(`file://${resolve(verdicts, "report.html")}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
  assert.equal(await page.locator("table.captures tbody tr").count(), scenes.length);
  assert.deepEqual(errors, []);
  await browser.close();
}

const engines = {
  three: [
    "three",
    async () => {
      three();
      await openSeveral(["spot-rim", "cube-seams"]);
    },
  ],
  filament: [
    "filament",
    async () => {
      plain("filament", "Filament");
      await openReport("filament");
    },
  ],
  babylon: ["babylonjs", () => plain("babylon", "Babylon.js", "--type", "pcf", "--bias", "0.001")],
  playcanvas: ["playcanvas", () => plain("playcanvas", "PlayCanvas")],
};
const flaggedOf = {
  three: () => flagged("three", "--type", "basic", "--bias", "-0.002"),
  babylon: () => flagged("babylon", "--type", "pcf", "--bias", "0.02"),
  playcanvas: () => flagged("playcanvas"),
};
makeFlagged("ortho");
makeFlagged("casts-nothing", (gltf) => boxes(gltf).forEach((node) => (node.extras = { casts_shadow: false })));
makeFlagged("receives-nothing", (gltf) =>
  gltf.materials.forEach((material) => (material.extras = { ...material.extras, receives_shadow: 0 })),
);
for (const [engine, [packageName, run]] of Object.entries(engines)) {
  if (only && engine !== only) continue;
  if (!isThere(packageName)) console.log(`skipped: adapter ${engine}: its npm package is not installed`);
  else (await run(), flaggedOf[engine]?.(), console.log(`${engine}: fine`));
}
