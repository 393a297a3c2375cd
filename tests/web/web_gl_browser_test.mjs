// Shadow maps that the program for the web draws in a browser's worker by WebGL 2, against the native program's: every technique
// on scenes of triangles and of exact shapes, and what the comparison makes of them. What WebGL 2 lacks is refused in words.
// Usage: web_gl_browser_test.mjs GNOMON FOLDER. Exit code 77 where the program for the web has not been built.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { readExr } from "../../adapters/exr.mjs";
import { browser } from "../browser/open_page.mjs";
import { isBuilt, openProgram, skip } from "./program_in_browser.mjs";

const [native, folder] = process.argv.slice(2);
if (!isBuilt) skip("the program for the web is not here (./gnomon web builds it)");
mkdirSync(folder, { recursive: true });
/** The scene sphere-plane with a second lamp: what both give adds up. */
const twoLights = path.resolve(folder, "two-lights.json");
const scene = readFileSync(new URL("../../scene/builtin/sphere-plane.json", import.meta.url), "utf8");
writeFileSync(
  twoLights,
  scene.replace('"lights": [', '"lights": [{ "name": "second", "type": "point", "position": [3, 2.6, 0.5], "intensity": [3, 5, 9] }, '),
);
const web = await openProgram([], { [twoLights]: readFileSync(twoLights, "utf8") });
const small = ["--size", "160x90", "--quiet"];
let wrong = 0;
const say = (good, words) => {
  console.log(`${good ? "ok" : "WRONG"}: ${words}`);
  wrong += !good;
};
const percent = (share) => `${(100 * share).toPrecision(2)} %`;

/** The channels that both programs write; null where both refuse the words with the same code. */
const channels = (...words) => channelsOf(web, ...words);
async function channelsOf(web, ...words) {
  const [command, ...rest] = words,
    file = path.join(folder, "native.exr"),
    option = command === "compare" ? "--aov" : "-o";
  const output = command === "compare" ? ["-o", folder] : [];
  const ours = spawnSync(native, [command, ...rest, ...small, ...output, option, file], { encoding: "utf8" });
  const theirs = await web.run(
    [command, ...rest, ...small, ...(command === "compare" ? ["-o", "/out"] : []), option, "/web.exr"],
    "/web.exr",
    "/out/result.json",
  );
  if (ours.status !== theirs.code)
    throw new Error(`${words.join(" ")}: exit codes ${ours.status} and ${theirs.code}: ${ours.stderr}${theirs.said}`);
  if (ours.status !== 0) return null;
  writeFileSync(path.join(folder, "web.exr"), theirs.files[0]);
  return { ours: readExr(file).channels, theirs: readExr(path.join(folder, "web.exr")).channels, result: theirs.files[1] };
}

/** Of pixels that see the same primitive: how far visibilities are apart in the mean; and how many pixels see another, and the most that a colour is. */
function apart({ ours, theirs }) {
  let same = 0,
    sum = 0,
    colours = 0;
  const pixels = ours["primitive.V"].length,
    lights = Object.keys(ours).filter((name) => name.endsWith("drawn.V"));
  for (let i = 0; i < pixels; ++i) {
    if (ours["primitive.V"][i] !== theirs["primitive.V"][i]) continue;
    ++same;
    for (const light of lights) sum += Math.abs(ours[light][i] - theirs[light][i]);
    for (const colour of "RGB") colours = Math.max(colours, Math.abs(ours[colour][i] - theirs[colour][i]));
  }
  return { others: 1 - same / pixels, mean: sum / same, colours };
}

const listed = /--technique NAME\s+shadow test \[([^;]*);/.exec(execFileSync(native, ["raster", "--help"], { encoding: "utf8" }))[1];
const techniques = listed.split(/\s+or\s+/).filter((name) => name !== "izb");

// SwiftShader puts vertices onto sixteenths of a pixel or texel, the native program's Mesa onto 256ths: along edges another
// triangle may be seen, or stored. Where each texel has one depth, exact shapes leave nothing to how a triangle is filled. Moments of floats keep some noise, and
// of a light with size one of the samples may fall to either side.
const exact = new Set(["hard", "pcf", "second-depth", "midpoint", "cube"]);
async function drawsLikeTheNative(web, words, begin = "") {
  const [scene, ...options] = words;
  // Of the usual map most texels would be drawn and never seen. Where many edges of triangles are in the picture a texel that is
  // filled otherwise counts by its size, so that these scenes keep it.
  const map = ["fence", "acne-floor"].includes(scene) ? [] : ["--map-size", "256"];
  const both = await channelsOf(web, "raster", scene, ...map, ...options);
  if (!both) return; // no such light in this scene
  const { others, mean, colours } = apart(both),
    analytic = words[0] === twoLights || (words[0] === "sphere-plane" && exact.has(words[2]));
  const good = analytic ? others === 0 && mean === 0 && colours < 1e-5 : others <= 0.05 && mean <= 0.005;
  say(
    good,
    `${begin}${words.map((word) => path.basename(word)).join(" ")}: visibilities ${mean === 0 ? "the same" : `${percent(mean)} apart`}, another primitive in ${percent(others)}`,
  );
}
async function drawsEveryTechnique() {
  for (const scene of ["sphere-plane", "acne-floor", "teapot", "fence"])
    for (const technique of techniques) await drawsLikeTheNative(web, [scene, "--technique", technique]);
  await drawsLikeTheNative(web, [twoLights]);
}

/** Fed the same, the ladder says the same: rungs of rays wherever neither sees a silhouette, all others where the map says the same
 *  of the pixel. */
async function climbsTheSameLadder() {
  const silhouette = -3; // in the channel class (docs/manual/aov.md)
  for (const scene of ["acne-floor", "fence"]) {
    const { ours, theirs } = await channels("compare", scene);
    const alike = (i, ...names) => names.every((name) => Object.is(ours[`${name}.V`][i], theirs[`${name}.V`][i]));
    let rays = 0,
      ladders = 0,
      unlike = 0;
    for (let i = 0; i < ours["class.V"].length; ++i) {
      if (ours["class.V"][i] === silhouette || theirs["class.V"][i] === silhouette) continue;
      ++rays;
      unlike += !alike(i, "truth", "point");
      if (
        !alike(i, "drawn", "stored", "gap") ||
        ours["texel_uv.U"][i] !== theirs["texel_uv.U"][i] ||
        ours["texel_uv.V"][i] !== theirs["texel_uv.V"][i]
      )
        continue;
      ++ladders;
      unlike += !alike(i, "texel", "flat", "biased", "class", "cause");
    }
    say(unlike === 0 && ladders > rays / 10, `${scene}: ${unlike} of ${rays} rays and ${ladders} ladders unlike`);
  }
  const { result } = await channels("compare", "sphere-plane");
  const figures = (text) => {
    const {
      pixels,
      error: { wrong, false_shadow, missed_shadow, mean_absolute, rms },
      budget,
      classes,
    } = JSON.parse(text).lights[0];
    return JSON.stringify({ pixels, wrong, false_shadow, missed_shadow, mean_absolute, rms, budget, classes });
  };
  const ours = execFileSync(native, ["compare", "sphere-plane", ...small, "--json", "-"], { encoding: "utf8" });
  say(figures(ours) === figures(result), "sphere-plane: pixels, error, budget and labels");
}

/** Without the extensions that other browsers lack: by the same limits. */
async function doesWithoutExtensions() {
  const others = await openProgram(
    ["EXT_clip_control", "EXT_depth_clamp", "EXT_float_blend", "OES_draw_buffers_indexed", "OES_texture_float_linear"],
    { [twoLights]: readFileSync(twoLights, "utf8") },
  );
  for (const words of [
    ...["hard", "vsm", "evsm", "midpoint", "cube"].map((technique) => ["sphere-plane", "--technique", technique]),
    ["sphere-plane", "--technique", "vsm", "--map-size", "250", "--mipmaps", "on"],
    [twoLights],
    ...["pcf", "second-depth", "csm", "lispsm", "msm"].map((technique) => ["fence", "--technique", technique]),
    ["teapot", "--depth-format", "d32f-reversed"],
    ["fence", "--camera-height", "6"],
    ["fence", "--caster-bias", "0.01", "--caster-slope-bias", "1"],
  ])
    await drawsLikeTheNative(others, words, "without extensions, ");
  await others.close();
  const none = await openProgram(["EXT_color_buffer_float"]),
    { code, said } = await none.run(["raster", "sphere-plane", ...small, "-o", "/web.exr"]);
  say(code === 5 && /lacks EXT_color_buffer_float, without which no shadow map/.test(said), said.trim());
  await none.close();
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

await doesWithoutExtensions();
await drawsEveryTechnique();
await climbsTheSameLadder();
await refusesInWords();
await web.close();
await browser.close();
process.exit(wrong === 0 ? 0 : 1);
