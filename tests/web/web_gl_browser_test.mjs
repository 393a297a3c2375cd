// Shadow maps that the program for the web draws in a browser's worker by WebGL 2, against the native program's: every technique
// on scenes of triangles and of exact shapes, and what the comparison makes of them. What WebGL 2 lacks is refused in words.
// Usage: web_gl_browser_test.mjs GNOMON FOLDER. Exit code 77 where the program for the web has not been built.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import path from "node:path";
import { readExr } from "../../adapters/exr.mjs";
import { isBuilt, openProgram, skip } from "./program_in_browser.mjs";

const [native, folder] = process.argv.slice(2);
if (!isBuilt) skip("the program for the web is not here (./gnomon web builds it)");
mkdirSync(folder, { recursive: true });
const web = await openProgram();
const small = ["--size", "160x90", "--quiet"];
let wrong = 0;
const say = (good, words) => { console.log(`${good ? "ok" : "WRONG"}: ${words}`); wrong += !good; };
const percent = (share) => `${(100 * share).toPrecision(2)} %`;

/** The channels that both programs write; null where both refuse the words with the same code. */
async function channels(...words) {
  const [command, ...rest] = words, file = path.join(folder, "native.exr"), option = command === "compare" ? "--aov" : "-o";
  const output = command === "compare" ? ["-o", folder] : [];
  const ours = spawnSync(native, [command, ...rest, ...small, ...output, option, file], { encoding: "utf8" });
  const theirs = await web.run([command, ...rest, ...small, ...(command === "compare" ? ["-o", "/out"] : []), option, "/web.exr"], "/web.exr", "/out/result.json");
  if (ours.status !== theirs.code) throw new Error(`${words.join(" ")}: exit codes ${ours.status} and ${theirs.code}: ${ours.stderr}${theirs.said}`);
  if (ours.status !== 0) return null;
  writeFileSync(path.join(folder, "web.exr"), theirs.files[0]);
  return { ours: readExr(file).channels, theirs: readExr(path.join(folder, "web.exr")).channels, result: theirs.files[1] };
}

/** Of pixels that see the same primitive: how far visibilities are apart in the mean; and how many pixels see another. */
function apart({ ours, theirs }) {
  let same = 0, sum = 0;
  const pixels = ours["drawn.V"].length;
  for (let i = 0; i < pixels; ++i) {
    if (ours["primitive.V"][i] !== theirs["primitive.V"][i]) continue;
    ++same;
    sum += Math.abs(ours["drawn.V"][i] - theirs["drawn.V"][i]);
  }
  return { others: 1 - same / pixels, mean: sum / same };
}

const listed = /--technique NAME\s+shadow test \[([^;]*);/.exec(execFileSync(native, ["raster", "--help"], { encoding: "utf8" }))[1];
const techniques = listed.split(/\s+or\s+/).filter((name) => name !== "izb");

async function drawsEveryTechnique() {
  // SwiftShader puts vertices onto sixteenths of a pixel or texel, the native program's Mesa onto 256ths: along edges another
  // triangle may be seen, or stored. Where each texel has one depth, exact shapes leave nothing to how a triangle is filled. Moments of floats keep some noise, and
  // of a light with size one of the samples may fall to either side.
  const exact = new Set(["hard", "pcf", "second-depth", "midpoint", "cube"]);
  for (const scene of ["sphere-plane", "acne-floor", "teapot", "fence"])
    for (const technique of techniques) {
      const both = await channels("raster", scene, "--technique", technique);
      if (!both) continue;  // no such light in this scene
      const { others, mean } = apart(both), analytic = scene === "sphere-plane" && exact.has(technique);
      const good = analytic ? others === 0 && mean === 0 : others <= 0.05 && mean <= 0.005;
      say(good, `${scene}, ${technique}: visibilities ${mean === 0 ? "the same" : `${percent(mean)} apart`}, another primitive in ${percent(others)}`);
    }
}

/** Fed the same, the ladder says the same: rungs of rays wherever neither sees a silhouette, all others where the map says the same
 *  of the pixel. */
async function climbsTheSameLadder() {
  const silhouette = -3;  // in the channel class (docs/manual/aov.md)
  for (const scene of ["acne-floor", "fence"]) {
    const { ours, theirs } = await channels("compare", scene);
    const alike = (i, ...names) => names.every((name) => Object.is(ours[`${name}.V`][i], theirs[`${name}.V`][i]));
    let rays = 0, ladders = 0, unlike = 0;
    for (let i = 0; i < ours["class.V"].length; ++i) {
      if (ours["class.V"][i] === silhouette || theirs["class.V"][i] === silhouette) continue;
      ++rays;
      unlike += !alike(i, "truth", "point");
      if (!alike(i, "drawn", "stored", "gap") || ours["texel_uv.U"][i] !== theirs["texel_uv.U"][i] || ours["texel_uv.V"][i] !== theirs["texel_uv.V"][i]) continue;
      ++ladders;
      unlike += !alike(i, "texel", "flat", "biased", "class", "cause");
    }
    say(unlike === 0 && ladders > rays / 10, `${scene}: ${unlike} of ${rays} rays and ${ladders} ladders unlike`);
  }
  const { result } = await channels("compare", "sphere-plane");
  const figures = (text) => {
    const { pixels, error: { wrong, false_shadow, missed_shadow, mean_absolute, rms }, budget, classes } = JSON.parse(text).lights[0];
    return JSON.stringify({ pixels, wrong, false_shadow, missed_shadow, mean_absolute, rms, budget, classes });
  };
  const ours = execFileSync(native, ["compare", "sphere-plane", ...small, "--json", "-"], { encoding: "utf8" });
  say(figures(ours) === figures(result), "sphere-plane: pixels, error, budget and labels");
}

async function refusesInWords() {
  for (const [words, expected] of [
    [["raster", "sphere-plane", "--technique", "izb"], /izb writes storage buffers, which WebGL 2 lacks/],
    [["raster", "orchard", "--instances", "keep"], /kept instances .* WebGL 2 lacks \(allowed: --instances flatten\)/],
  ]) {
    const { code, said } = await web.run([...words, ...small, "-o", "/web.exr"]);
    say(code === 5 && expected.test(said), `${words.join(" ")}: ${said.trim()}`);
  }
}

await drawsEveryTechnique();
await climbsTheSameLadder();
await refusesInWords();
await web.close();
process.exit(wrong === 0 ? 0 : 1);
