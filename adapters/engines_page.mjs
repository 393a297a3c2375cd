// docs/engines.md: engines' shadows at their default settings and at those that their documents advise, judged on four scenes.
//   node adapters/engines_page.mjs GNOMON FOLDER > docs/engines.md      (docs/make_engines.sh)
//   node adapters/engines_page.mjs GNOMON FOLDER courtyard godot default      that row alone
// FOLDER keeps the scenes, captures and reports; a capture that is there is not made again.
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { differences, explanation } from "./second_truth.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const [gnomon, folder] = process.argv.slice(2, 4).map((path) => resolve(path));
const wanted = process.argv.slice(4);
const scenes = ["floating-box", "wires", "thin-wall", "courtyard"],
  size = "640x360";
// The second row of an engine: a finer map, its best filter for a sun, and biases in the range of its documents' examples.
const rows = [
  ["three", "default", ""],
  ["three", "advised", "--type pcf --mapSize 2048 --bias -0.0001 --normalBias 0.02"],
  ["three", "basic", "--type basic --mapSize 1024 --bias -0.002"],
  ["babylon", "default", ""],
  ["babylon-page", "advised", "--type pcf --mapSize 2048 --bias 0.001 --normalBias 0.02"],
  ["playcanvas-page", "default", ""],
  ["playcanvas-page", "advised", "--shadowType PCF5_32F --shadowResolution 2048 --shadowBias 0.2 --normalOffsetBias 0.05"],
  ["filament", "default", ""],
  ["eevee", "default", ""],
  ["eevee", "advised", "--cascadeSize 4096 --highBitDepth true"],
  ["godot", "default", "--mode pssm4"],
  ["godot", "one map", "--mode orthogonal"],
  ["quick3d", "default", ""],
];
const cycles = ["cycles", "rays", ""],
  cyclesAsShipped = ["cycles", "offset", "--shadowTerminatorOffset 0.1"];

function judged(scene, [engine, name, options]) {
  const capture = join(folder, `${engine}-${name}-${scene}`);
  if (!existsSync(join(capture, "capture.json"))) {
    const words = [
      join(here, "capture.mjs"),
      engine,
      join(folder, `${scene}.glb`),
      "-o",
      capture,
      "--size",
      size,
      ...options.split(" ").filter(Boolean),
    ];
    const drawn = spawnSync("node", words, { encoding: "utf8", timeout: 1800000 });
    console.error(drawn.stderr.trim());
    if (drawn.status !== 0) return { refused: drawn.stderr.trim().split("\n")[0] || "not drawn within half an hour" };
  }
  const report = join(capture, "report"),
    json = join(capture, "result.json");
  const run = spawnSync(
    gnomon,
    ["judge", join(capture, "capture.json"), "-o", report, "--json", json, "--aov", join(capture, "verdict.exr"), "--quiet"],
    { encoding: "utf8" },
  );
  if (run.status !== 0) return { refused: run.stderr.trim().replace(/^.*?capture.json: /, "") };
  return JSON.parse(readFileSync(json, "utf8"));
}

const percent = (share) => (share === 0 ? "0" : share < 0.0001 ? "< 0.01 %" : `${Number((100 * share).toPrecision(2))} %`);
const percent3 = (share) => `${Number((100 * share).toPrecision(3))} %`;
const number = (value) => Number(value.toPrecision(2)).toString();

function labels({ classes, error }) {
  const found = Object.entries(classes)
    .filter(([, count]) => count > 0)
    .sort((a, b) => b[1] - a[1])
    .slice(0, 2);
  return found.map(([label, count]) => `${label.replace("_", " ")} ${percent(count / error.wrong)}`).join(", ") || "-";
}

function advice({ advice: list }) {
  return (
    (list || [])
      .map(
        (a) =>
          `\`${a.setting}\` ${a.instead === a.now ? `stays ${number(a.now)}` : `${number(a.instead)} instead of ${number(a.now)}: ${percent(a.wrong_instead)}`}`,
      )
      .join("; ") || "-"
  );
}

function row(scene, result, [engine, name]) {
  if (result.refused) return `| ${scene} | ${engine}, ${name} | not judged: ${result.refused} | | | | | |`;
  const light = result.lights[0],
    { renderer } = result.judged;
  const away = light.detachment?.pixels > 0 ? number(light.detachment.mean_world) : "-";
  return `| ${scene} | ${renderer.name} ${renderer.version}, ${name} | ${percent(light.error.wrong_fraction)} | ${percent(light.error.mean_absolute)} | ${labels(light)} | ${number(light.edges.rms_pixels)} | ${away} | ${advice(result.judged)} |`;
}

/** The basic row again with the bias that its verdict advises. */
function withAdvice(scene, result) {
  const { instead, wrong_now: before, wrong_instead: promised } = result.judged.advice.find((a) => a.setting === "bias.constant_depth");
  const again = judged(scene, ["three", "taken-at-its-word", `--type basic --mapSize 1024 --bias ${-instead}`]);
  if (again.refused) throw new Error(`${scene}: ${again.refused}`);
  return `| ${scene} | ${number(-instead)} | ${percent(before)} | ${percent3(promised)} | ${percent3(again.lights[0].error.wrong_fraction)} |`;
}

/** A scene's row of the second truth. */
function secondTruth(scene) {
  const result = judged(scene, cycles);
  if (result.refused) throw new Error(`${scene}: ${result.refused}`);
  const { pixels, error } = result.lights[0],
    capture = join(folder, `cycles-rays-${scene}`);
  const found = error.wrong === 0 ? [] : differences(join(folder, `${scene}.glb`), join(capture, "verdict.exr"), capture);
  return `| ${scene} | ${pixels.compared} | ${error.wrong} | ${found.filter(explanation).length} |`;
}

function printRow(scene, engine, name) {
  mkdirSync(folder, { recursive: true });
  execFileSync(gnomon, ["export", scene, "--quiet", "-o", join(folder, `${scene}.glb`)]);
  const entry = rows.find((one) => one[0] === engine && one[1] === name);
  console.log(row(scene, judged(scene, entry), entry));
}

function main() {
  mkdirSync(folder, { recursive: true });
  for (const scene of scenes) execFileSync(gnomon, ["export", scene, "--quiet", "-o", join(folder, `${scene}.glb`)]);
  execFileSync(gnomon, ["export", "--suite", join(folder, "suite"), "--size", size, "--quiet"]);
  copyFileSync(join(folder, "suite", "far-from-origin.glb"), join(folder, "far-from-origin.glb"));
  const results = scenes.map((scene) => rows.map((entry) => judged(scene, entry)));
  const asShipped = judged("courtyard", cyclesAsShipped).lights[0];
  const truths = [...scenes, "far-from-origin"].map(secondTruth);
  const drawn = results
    .flatMap((list) => rows.map((entry, r) => [entry, list[r]]))
    .filter(([, result]) => !result.refused && result.judged.biased_is_drawn != null && result.lights[0].map.filter.kind === "none")
    .map(([entry, result]) => ({ name: `${result.judged.renderer.name} ${entry[1]}`, share: result.judged.biased_is_drawn }));
  const least = (name) => (100 * Math.min(...drawn.filter((d) => d.name === name).map((d) => d.share))).toFixed(3);
  console.log(`# Engines, judged

For whoever asks what engines draw: four of Gnomon's scenes, each with a sun, drawn at ${size} and judged by \`gnomon judge\`.
The engines are those of the web in headless Chromium, Blender's EEVEE and Cycles, and Godot and Qt Quick 3D. Of these two,
of PlayCanvas and of Babylon.js where it filters, RenderDoc recorded a frame. \`docs/make_engines.sh\` wrote this page with the [adapters](../adapters/README.md); versions and
options stand in each row.

One picture of one light is compared in each scene, at settings that nobody has tuned for it. *Default* is what the engine
takes by itself. *Advised* is a finer map, its best filter for such a light, and biases in the range that its documents'
examples show. Much depends on what the engine fits its map to; no number here says that one engine is better than another.

| scene | engine | wrong pixels | mean error | labels | edges off by, pixels (RMS) | shadows detached by, world units (mean) | Gnomon's advice |
|---|---|---|---|---|---|---|---|
${scenes.map((scene, s) => rows.map((entry, r) => row(scene, results[s][r], entry)).join("\n")).join("\n")}

*unexplained*: the adapter hands over no depth map of this technique, so that Gnomon can say where the shadow is wrong and
not why. Filament warps its map (its matrix is no symmetric perspective), and EEVEE's cannot be read. A bias that an engine gives to the casters lies in its map; what is advised then comes on top of it.

## To repeat a row

\`\`\`sh
gnomon export wires -o wires.glb
node adapters/capture.mjs ENGINE wires.glb -o captured --size ${size} OPTIONS
gnomon judge captured/capture.json -o verdict
\`\`\`

| row | ENGINE | OPTIONS |
|---|---|---|
${[...rows, cycles, cyclesAsShipped].map(([engine, name, options]) => `| ${engine}, ${name} | \`${engine}\` | ${options ? `\`${options}\`` : "-"} |`).join("\n")}

## The ladder on another renderer's map

Where a capture has a map and one comparison for each pixel, V5, worked out from its map, matrix and bias, must be V6, its
picture. In every scene it is on at least ${[...new Set(drawn.map((d) => d.name))].map((name) => `${least(name)} % of the pixels (${name})`).join(" and ")}.
Some of the others lie on the boundaries of texels, where the engine's 32-bit coordinates and Gnomon's 64-bit ones
round to either side. On the rest the engine offsets along interpolated normals and Gnomon does not.

## The advice, taken

three.js, \`basic\`, drawn again with the \`bias\` that its verdict advises, where that is another one:

| scene | bias | wrong with -0.002 | promised | drawn |
|---|---|---|---|---|
${scenes
  .map((scene, s) => [scene, results[s][2]])
  .filter(([, result]) => result.judged.advice.some((a) => a.setting === "bias.constant_depth" && a.instead !== a.now))
  .map(([scene, result]) => withAdvice(scene, result))
  .join("\n")}

## Cycles, a second truth

Cycles traces the same hard shadows with its own code: one ray through each pixel's centre, lights without size. Its *shadow
terminator geometry offset*, which starts the rays of smooth surfaces off the surface where the light grazes, is 0. With
Blender's default of 0.1, ${asShipped.error.wrong} pixels of courtyard differ. The last scene is the conformance suite's.

| scene | pixels compared | different | explained |
|---|---|---|---|
${truths.join("\n")}

Cycles keeps places in 32-bit floats. Each differing pixel was computed again in 64-bit floats from the file's numbers,
against every triangle (\`adapters/second_truth.mjs\` lists them). A difference is explained by either of these:

- Cycles is right about the place that it found (its position pass).
- The edge of the shadow is nearer to the receiver, in its plane, than one step of those floats.

${readFileSync(new URL("programs/page.md", import.meta.url), "utf8").trimEnd()}
`);
}

if (wanted.length === 3) printRow(...wanted);
else main();
