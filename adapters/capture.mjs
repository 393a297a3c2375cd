// Draws a glTF scene with an engine and writes a capture for `gnomon judge`:
//   node adapters/capture.mjs ENGINE SCENE -o DIR [--size 640x360] [--light NAME] [--NAME VALUE ...]
// ENGINE is a file of adapters/engines: a page's module, run in headless Chromium with WebGL 2, or a script for Blender; or one of
// recorded.mjs, whose frames RenderDoc records: with -page after its name a module draws as a page does, and its map is captured, too.
// Every further option is one of that engine's own (see its head).
// Writes DIR/capture.json, the pictures that it names, and DIR/picture.png, what the engine itself shows.
import { spawnSync } from "node:child_process";
import { randomUUID } from "node:crypto";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { exr } from "./exr.mjs";
import { fileAt, html } from "./pages.mjs";
import { captureRecorded, isRecorded } from "./recorded.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const stop = (text) => {
  console.error(`capture: ${text}`);
  process.exit(2);
};

function readArguments() {
  const { values, positionals } = parseArgs({
    strict: false,
    allowPositionals: true,
    options: { output: { type: "string", short: "o" }, size: { type: "string", default: "640x360" }, light: { type: "string" } },
  });
  const known = new Set(["output", "size", "light"]),
    settings = {};
  const rest = [];
  // What follows an option that this script does not know is its value: parseArgs leaves it among the words.
  const words = process.argv.slice(2);
  for (let i = 0; i < words.length; ++i) {
    const name = words[i].replace(/^--/, "");
    if (words[i].startsWith("--") && !known.has(name))
      settings[name] = Number.isNaN(Number(words[i + 1])) ? words[++i] : Number(words[++i]);
    else if (words[i].startsWith("-")) ++i;
    else rest.push(words[i]);
  }
  const size = /^(\d+)x(\d+)$/.exec(values.size) || stop(`--size: got ${values.size}, allowed WxH`);
  if (rest.length !== 2 || !values.output || positionals.length === 0)
    stop("usage: ENGINE SCENE -o DIR [--size WxH] [--light NAME] [--NAME VALUE ...]");
  return {
    engine: rest[0],
    scene: resolve(rest[1]),
    folder: values.output,
    light: values.light,
    width: Number(size[1]),
    height: Number(size[2]),
    settings,
  };
}

/** A page that may read this folder and the scene's, as http://capture/, and nothing else. */
async function openPage(job) {
  const { chromium } = await import("playwright-core").catch(() => stop("the packages are missing: npm install --prefix adapters"));
  const executablePath =
    ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium"].find(existsSync) ||
    stop("no chromium-headless-shell or chromium in /usr/bin");
  const browser = await chromium.launch({
    executablePath,
    args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  const page = await browser.newPage({ viewport: { width: job.width, height: job.height } });
  page.on("pageerror", (error) => stop(`the page failed: ${error.message}`));
  page.on("console", (message) => message.type() === "error" && console.error(`${job.engine}: ${message.text()}`));
  await page.route("**/*", (route) => {
    const path = decodeURIComponent(new URL(route.request().url()).pathname);
    if (path === "/") return route.fulfill({ contentType: "text/html", body: html() });
    return route.fulfill(fileAt(path, job.scene) ?? { status: 404 });
  });
  await page.goto("http://capture/");
  return { browser, page };
}

/** Runs the engine's module in the page. Its arrays come back as base64 text. */
async function drawInPage(job) {
  const { browser, page } = await openPage(job);
  const task = {
    scene: `http://capture/scene/${basename(job.scene)}`,
    light: job.light,
    width: job.width,
    height: job.height,
    settings: job.settings,
  };
  const result = await page
    .evaluate(
      async ({ engine, task }) => {
        const module = await import(`http://capture/engines/${engine}.js`);
        const result = await module.capture(document.querySelector("canvas"), task);
        const encode = (value) => {
          if (!(value instanceof Float32Array)) return value;
          const bytes = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
          let text = "";
          for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
          return { floats: btoa(text) };
        };
        return JSON.parse(JSON.stringify(result, (key, value) => encode(value)));
      },
      { engine: job.engine, task },
    )
    .finally(() => browser.close());
  return result;
}

function drawInBlender(job) {
  const folder = mkdtempSync(join(tmpdir(), "capture-")),
    task = join(folder, "task.json"),
    result = join(folder, "result.json");
  writeFileSync(task, JSON.stringify(job));
  const script = join(here, "engines", `${job.engine}.py`);
  // EEVEE draws with OpenGL, which Blender has on a display alone: Xvfb's, with Mesa's software.
  const display = job.engine === "eevee" ? ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 640x480x24"] : [];
  const [program, ...words] = [
    ...display,
    "blender",
    "--background",
    "--factory-startup",
    "--python-exit-code",
    "1",
    "--python",
    script,
    "--",
    task,
    result,
  ];
  const run = spawnSync(program, words, {
    encoding: "utf8",
    env: { ...process.env, ...(display.length > 0 && { LIBGL_ALWAYS_SOFTWARE: "1" }) },
  });
  if (run.error) throw new Error(`${program} cannot be run: ${run.error.message}`);
  if (run.status !== 0) throw new Error(`blender failed: ${`${run.stdout}${run.stderr}`.trim().split("\n").slice(-3).join(" | ")}`);
  const drawn = JSON.parse(readFileSync(result, "utf8"));
  rmSync(folder, { recursive: true });
  return drawn;
}

const floats = ({ floats: text }) => {
  const bytes = Buffer.from(text, "base64");
  return new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
};

/** Writes a file of the folder whole; a link that has its name is replaced, not followed. */
function writeWhole(path, bytes) {
  const part = `${path}.${randomUUID()}.part`;
  writeFileSync(part, bytes, { flag: "wx" });
  renameSync(part, path);
}

/** result: {renderer, light, visibility | shadowed and unshadowed, covered and position [x, y, z] or neither, map [{texels, size, ...}],
    bias, filter, picture}. */
function write(job, result) {
  mkdirSync(job.folder, { recursive: true });
  const put = (name, width, height, channels) => {
    writeWhole(
      join(job.folder, name),
      exr(width, height, Object.fromEntries(Object.entries(channels).map(([c, values]) => [c, floats(values)]))),
    );
    return name;
  };
  const { covered: A, position: [X, Y, Z] = [] } = result;
  const capture = {
    schema: "gnomon/capture/1",
    renderer: result.renderer,
    scene: relative(job.folder, job.scene),
    light: result.light,
    size: [job.width, job.height],
    ...(result.visibility
      ? { visibility: put("visibility.exr", job.width, job.height, { V: result.visibility, A }) }
      : {
          shadowed: put("shadowed.exr", job.width, job.height, { Y: result.shadowed }),
          unshadowed: put("unshadowed.exr", job.width, job.height, { Y: result.unshadowed }),
        }),
    ...(X && { position: put("position.exr", job.width, job.height, { X, Y, Z, A }) }),
    ...(result.depth && {
      depth: { file: put("depth.exr", job.width, job.height, { Z: result.depth.values }), convention: result.depth.convention },
    }),
  };
  if (result.map) {
    capture.map = result.map.map(({ texels, size, ...layer }, i) => ({ depth: put(`map-${i}.exr`, size, size, { Z: texels }), ...layer }));
    Object.assign(capture, { bias: result.bias, filter: result.filter });
  }
  writeWhole(join(job.folder, "capture.json"), JSON.stringify(capture, null, 1) + "\n");
  if (result.picture) writeWhole(join(job.folder, "picture.png"), Buffer.from(result.picture.split(",")[1], "base64"));
}

const job = readArguments();
if (!existsSync(job.scene)) stop(`${job.scene}: no such file`);
const isIn = (extension) => job.engine !== "common" && existsSync(join(here, "engines", `${job.engine}.${extension}`));
if (!isIn("js") && !isIn("py") && !isRecorded(job.engine)) stop(`no such engine (got ${job.engine}): see adapters/engines`);
if (isRecorded(job.engine) && job.light !== undefined)
  stop("--light: a frame's lights are numbered, --light NUMBER of adapters/renderdoc takes one");
try {
  if (isRecorded(job.engine)) {
    await captureRecorded(job);
    console.error(`${job.engine}: ${join(job.folder, "capture.json")}`);
    process.exit(0);
  }
  const result = isIn("py") ? drawInBlender(job) : await drawInPage(job);
  write(job, result);
  console.error(`${result.renderer.name} ${result.renderer.version}: ${join(job.folder, "capture.json")}`);
} catch (error) {
  console.error(`capture: ${error.message.split("\n")[0]}`);
  process.exitCode = 1;
}
