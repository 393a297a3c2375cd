// The npm package that `./gnomon web --pack` makes, installed from its tarball into an empty folder: each of its functions in Node and
// in a page against the native program, `npx gnomon judge` with its exit codes, and the types against what is asked by them. Usage:
// web_package_browser_test.mjs GNOMON FOLDER. Exit code 77 where the program for the web has not been built, or there is no npm.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath, pathToFileURL } from "node:url";
import path from "node:path";
import { exr, readExr } from "../../adapters/exr.mjs";
import { browser } from "../browser/open_page.mjs";
import { app, isBuilt, serveFolder, skip } from "./program_in_browser.mjs";

const [native, folder] = process.argv.slice(2).map((word) => path.resolve(word));
if (!isBuilt) skip("the program for the web is not here (./gnomon web builds it)");
if (spawnSync("npm", ["--version"]).status !== 0) skip("npm is not installed");
rmSync(folder, { recursive: true, force: true });
mkdirSync(path.join(folder, "empty"), { recursive: true });
const root = fileURLToPath(new URL("../../", import.meta.url)),
  empty = path.join(folder, "empty"),
  small = { size: "96x54" };
const tarball = execFileSync(process.execPath, [path.join(root, "platform/web/package/pack.mjs"), path.join(app, ".."), folder], {
  encoding: "utf8",
}).trim();
writeFileSync(path.join(empty, "package.json"), '{ "private": true, "type": "module" }\n');
execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", "--ignore-scripts", tarball], { cwd: empty, stdio: "inherit" });
const installed = path.join(empty, "node_modules/gnomon-web");

/** A capture of what the native program drew without a bias. */
function writeCapture() {
  const drawn = path.join(folder, "drawn.exr");
  execFileSync(native, ["raster", "acne-floor", "--bias", "0", "--size", small.size, "--quiet", "-o", drawn]);
  const { width, height, channels } = readExr(drawn);
  writeFileSync(path.join(empty, "shadow.exr"), exr(width, height, { V: channels["drawn.V"] }));
  writeFileSync(
    path.join(empty, "capture.json"),
    JSON.stringify({
      schema: "gnomon/capture/2",
      renderer: { name: "mine" },
      scene: "acne-floor",
      size: [width, height],
      visibility: "shadow.exr",
    }),
  );
}
const captured = () =>
  Object.fromEntries(["capture.json", "shadow.exr"].map((name) => [name, new Uint8Array(readFileSync(path.join(empty, name)))]));
const figures = ({
  lights: [
    {
      pixels,
      error: { wrong, false_shadow, missed_shadow },
      classes,
    },
  ],
}) => ({ pixels, wrong, false_shadow, missed_shadow, classes });
const asked = (...words) =>
  JSON.parse(execFileSync(native, [...words, "--json", "-", "--quiet"], { cwd: empty, encoding: "utf8", maxBuffer: 1 << 26 }));
const unlike = (a, b) =>
  Object.keys(a.channels).filter(
    (name) => Buffer.compare(Buffer.from(a.channels[name].buffer), Buffer.from(b.channels[name].buffer)) !== 0,
  );

function judgesOnTheCommandLine() {
  for (const words of [
    ["capture.json", "--fail-above", "1%"],
    ["capture.json"],
    ["capture.json", "--fail-above", "much"],
    ["nowhere.json"],
  ]) {
    const ours = spawnSync(native, ["judge", ...words, "-o", "native"], { cwd: empty, encoding: "utf8" });
    const theirs = spawnSync("npx", ["--offline", "gnomon", "judge", ...words, "-o", "web"], { cwd: empty, encoding: "utf8" });
    assert.equal(theirs.status, ours.status, `${words.join(" ")}: ${theirs.stderr}`);
    if (ours.status < 2)
      assert.deepEqual(
        figures(JSON.parse(readFileSync(path.join(empty, "web/result.json")))),
        figures(JSON.parse(readFileSync(path.join(empty, "native/result.json")))),
      );
    console.log(`npx gnomon judge ${words.join(" ")}: exit code ${theirs.status}`);
  }
}

async function tracesAndJudgesInNode() {
  const { load, judge, close, GnomonError } = await import(pathToFileURL(path.join(installed, "index.mjs")));
  const scene = await load("teapot"),
    file = path.join(folder, "traced.exr");
  assert.ok(scene.plan.effects.length > 0);
  execFileSync(native, ["raytrace", "teapot", "--size", small.size, "--quiet", "-o", file]);
  assert.deepEqual(unlike(await scene.trace(small), readExr(file)), [], "channels");
  assert.equal(Buffer.from(await scene.tracePicture(small)).toString("latin1", 1, 4), "PNG");
  const { code, result, report } = await judge("capture.json", captured(), { fail_above: "1%", report: true });
  assert.equal(code, 1);
  assert.deepEqual(figures(result), figures(asked("judge", "capture.json")));
  assert.match(report, /<!doctype html>/i);
  const refused = (call, wanted, said) =>
    assert.rejects(call, (error) => error instanceof GnomonError && error.code === wanted && said.test(error.message));
  await refused(scene.draw(small), 5, /no WebGL 2 here to draw with/);
  await refused(scene.trace({ size: "large" }), 2, /--size/);
  await refused(judge("capture.json", { ...captured(), "shadow.exr": new Uint8Array(9) }), 3, /shadow\.exr: not read here/);
  const files = { "models/a.obj": "mtllib a.mtl\nv -1 0 -1\nv 1 0 -1\nv 0 0 1\nf 1 2 3\n", "models/a.mtl": "newmtl a\n" };
  assert.ok((await (await load("models/a.obj", files)).trace(small)).channels.R.length === 96 * 54);
  await refused(load("models/a.obj"), 3, /models\/a\.obj/); // files are gone after their call
  const unfinished = scene.trace(small);
  await Promise.all([refused(unfinished, 6, /closed/), close()]);
  assert.equal((await scene.trace(small)).width, 96, "another program begins");
  // A program that has nothing left to do ends.
  writeFileSync(
    path.join(empty, "once.mjs"),
    'import { load } from "gnomon-web";\nconsole.log(Object.keys((await (await load("acne-floor")).trace({ size: "8x8" })).channels).length);\n',
  );
  assert.ok(Number(execFileSync(process.execPath, ["once.mjs"], { cwd: empty, encoding: "utf8", timeout: 120000 })) > 5);
  console.log("in Node: load, trace, judge");
  await close();
}

async function doesAllInAPage() {
  const host = await serveFolder(installed, { "/": ["text/html", "<!doctype html><title>Package</title>"] }),
    page = await browser.newPage();
  await page.goto(host.url);
  const done = await page.evaluate(
    async ([options, files]) => {
      const { load, judge, close } = await import("./index.mjs");
      const scene = await load("sphere-plane"),
        drawn = await scene.draw(options),
        traced = await scene.trace(options);
      const { code, result, frame, report } = await scene.compare({ ...options, map_size: 128, bias: 0, channels: true, report: true });
      const judged = await judge(
        "capture.json",
        Object.fromEntries(Object.entries(files).map(([name, bytes]) => [name, Uint8Array.from(bytes)])),
      );
      const png = await scene.drawPicture(options);
      await close();
      return {
        lit: drawn.channels["drawn.V"].reduce((sum, value) => sum + value, 0),
        pixels: traced.channels.R.length,
        code,
        result,
        judged: judged.result,
        wrong: frame.channels["class.V"].filter((label) => label > 0).length,
        page: report.length,
        png: [...png.subarray(1, 4)],
      };
    },
    [small, Object.fromEntries(Object.entries(captured()).map(([name, bytes]) => [name, [...bytes]]))],
  );
  const file = path.join(folder, "drawn_here.exr");
  execFileSync(native, ["raster", "sphere-plane", "--size", small.size, "--quiet", "-o", file]);
  assert.equal(
    done.lit,
    readExr(file).channels["drawn.V"].reduce((sum, value) => sum + value, 0),
    "visibilities drawn",
  );
  assert.equal(done.pixels, 96 * 54);
  assert.equal(done.code, 0);
  assert.deepEqual(
    figures(done.result),
    figures(asked("compare", "sphere-plane", "--size", small.size, "--map-size", "128", "--bias", "0")),
  );
  assert.equal(
    done.wrong,
    Object.values(done.result.lights[0].classes).reduce((sum, count) => sum + count, 0),
    "labels in the channels",
  );
  assert.deepEqual(figures(done.judged), figures(asked("judge", "capture.json")));
  assert.ok(done.page > 10000);
  assert.deepEqual(
    done.png,
    [..."PNG"].map((letter) => letter.charCodeAt(0)),
  );
  console.log("in a page: load, draw, trace, compare, judge");
  await page.close();
  host.stop();
}

/** TypeScript takes what the program takes, and refuses what it refuses. */
function hasTypes() {
  const tsc = path.join(root, "report/page/node_modules/typescript/bin/tsc");
  if (!existsSync(tsc)) return console.log("types are not tried: TypeScript is not installed (report/page)");
  writeFileSync(
    path.join(empty, "typed.ts"),
    `import { load, judge, type Result } from "gnomon-web";
const scene = await load("fence");
const { result } = await scene.compare({ technique: "pcf", map_size: 512, mipmaps: "on", no_snap: true, light: ["sun"], channels: true });
export const wrong: number = result.lights[0].error.wrong + result.lights[0].classes.acne, schema: "gnomon/result/1" = result.schema;
export const judged: Result = (await judge("capture.json", {}, { fix: true, engine: "godot" })).result;
export const depth: Float32Array = (await scene.trace({ samples: 4 })).channels["depth.Z"];
// @ts-expect-error no such technique
await scene.draw({ technique: "pfc" });
// @ts-expect-error an option of the rays alone
await scene.draw({ accel: "grid" });
// @ts-expect-error no such key
void result.light;
`,
  );
  execFileSync(process.execPath, [tsc, "--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "typed.ts"], {
    cwd: empty,
    stdio: "inherit",
  });
  console.log("types");
}

writeCapture();
judgesOnTheCommandLine();
hasTypes();
await tracesAndJudgesInNode();
await doesAllInAPage();
await browser.close();
console.log("the package");
