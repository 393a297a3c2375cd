// What adapters/open_in_lab.mjs takes from a running page of three.js: the program draws the shadows that three.js draws.
//   node adapters_lab_browser_test.mjs GNOMON FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import path from "node:path";
import { readExr } from "../../adapters/exr.mjs";
import { browser, skip } from "../browser/open_page.mjs";
import { hasThree, serveThree } from "../support/three_page.mjs";

const [native, folder] = process.argv.slice(2);
if (!hasThree) skip("three is not installed: npm install --prefix adapters");
mkdirSync(folder, { recursive: true });
const host = await serveThree();

async function openThree(query) {
  const page = await browser.newPage();
  page.on("pageerror", (error) => {
    throw error;
  });
  await page.goto(`${host.url}?${query}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
  return page;
}

/** The exported scene as a file, with the options as words. */
async function exported(page, name) {
  const { bytes, options, notes } = await page.evaluate(async () => {
    const { exportForLab } = await import("/open_in_lab.mjs");
    const { glb, ...rest } = await exportForLab(globalThis.scene);
    return { ...rest, bytes: [...new Uint8Array(glb)] };
  });
  const file = path.join(folder, `${name}.glb`);
  writeFileSync(file, Buffer.from(bytes));
  return { file, notes, options, words: Object.entries({ ...options, size: "320x180" }).map(([option, value]) => `--${option}=${value}`) };
}

/** The share of the pixels facing the light that three.js and the program shadow unlike. */
async function apart(query, name) {
  const page = await openThree(query),
    { file, words, notes, options } = await exported(page, name),
    theirs = await page.evaluate(() => globalThis.shadows());
  await page.close();
  const exr = path.join(folder, `${name}.exr`);
  execFileSync(native, ["raster", file, ...words, "-o", exr, "--quiet"]);
  const { channels } = readExr(exr),
    ours = channels[Object.keys(channels).find((channel) => channel.endsWith("drawn.V"))];
  let unlike = 0,
    facing = 0,
    dark = 0;
  theirs.forEach((shadow, i) => {
    if (shadow === 2) return;
    ++facing;
    dark += shadow === 0;
    unlike += Math.abs(ours[i] - shadow) > 0.5;
  });
  assert.ok(dark > 0.01 * facing && dark < 0.8 * facing, `${name}: ${dark} of ${facing} in shadow`);
  return { share: unlike / facing, notes, options };
}

/** Borders of triangles, and of texels where floats and doubles look up either of two; where a bias is right at one depth alone, the rims
    of shadows beside it. */
for (const [light, bias, most, cull] of [
  ["sun", -0.004, 0.002, "none"],
  ["spot", -0.002, 0.006, "none"],
  ["point", -0.002, 0.006, "front"],
]) {
  const { share, options, notes } = await apart(`light=${light}&bias=${bias}&type=0${cull === "front" ? "&side=0" : ""}`, light);
  console.log(`${light}: ${(100 * share).toFixed(2)} % of the pixels shadowed unlike`);
  assert.ok(share <= most, `${light}: ${share} are shadowed unlike`);
  assert.deepEqual(
    [options["map-size"], options.technique, options.cull, notes.length],
    ["256", "hard", cull, light === "sun" ? 0 : 1],
    light,
  );
}
// Filters are the lab's own: what is dark is dark, and what is lit is lit.
for (const [type, technique] of [
  [1, "pcf"],
  [3, "vsm"],
]) {
  const { share, options } = await apart(`light=sun&bias=-0.004&type=${type}`, technique);
  console.log(`${technique}: ${(100 * share).toFixed(2)} % of the pixels on the other side of one half`);
  assert.equal(options.technique, technique);
  assert.ok(share <= 0.01, `${technique}: ${share}`);
}

/** Without a scene: the one that is drawn next, which nothing names; and nothing is left behind. */
const hidden = await openThree("light=sun&hidden");
const found = await hidden.evaluate(async () => {
  const { nextScene, exportForLab } = await import("/open_in_lab.mjs");
  const { options } = await exportForLab(await nextScene());
  return { options, left: "isLOD" in Object.prototype };
});
assert.equal(found.options["window-depths"], "1,9");
assert.equal(found.left, false);
await browser.close();
host.stop();
