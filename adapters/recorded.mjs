// Engines of this machine whose frames RenderDoc records: adapters/renderdoc makes the captures, with map.
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { serve } from "./pages.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const python = "/usr/bin/python3";

/** An engine's program and words for a job of capture.mjs. */
const programs = {
  godot: ({ scene, width, height, settings }) => [
    "godot3",
    "--path",
    join(here, "godot"),
    "--stay=1",
    `--scene=${scene}`,
    `--size=${width}x${height}`,
    ...Object.entries(settings).map(([name, value]) => `--${name}=${value}`),
  ],
  quick3d: ({ scene, width, height }) => {
    if (!scene.endsWith("floating-box.glb")) throw new Error("quick3d draws the boxes of floating-box alone");
    return ["/usr/lib/qt6/bin/qml", join(here, "quick3d", "draw.qml"), "--", `--size=${width}x${height}`];
  },
};
const names = { godot: "Godot 3", quick3d: "Qt Quick 3D" };
/** Modules of engines/ that show a page, by the engine's word, and what they are called. */
const pages = { "three-page": "three.js", "babylon-page": "Babylon.js", "playcanvas-page": "PlayCanvas", "filament-page": "Filament" };
const software = {
  LIBGL_ALWAYS_SOFTWARE: "1",
  VK_ICD_FILENAMES: "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
  QSG_RHI_BACKEND: "vulkan",
  QSG_RENDER_LOOP: "basic",
};

export const isRecorded = (engine) => engine in programs || engine in pages;

/** Runs a program to its end, and returns what it said; a server of this process answers meanwhile. */
async function run([program, ...words]) {
  const child = spawn(program, words, { env: { ...process.env, ...software }, stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (said += text));
  const status = await new Promise((done, failed) => {
    child.on("error", (error) => failed(new Error(`${program} cannot be run: ${error.message}`)));
    child.on("close", done);
  });
  if (status === 0) return said;
  const lines = said.trim().split("\n");
  throw new Error(lines.findLast((line) => /^(error|record): /.test(line)) || `${words.join(" ")} ended with ${status}`);
}

const recorder = ["-B", join(here, "renderdoc", "record.py"), "-o"];
const onDisplay = ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x1024x24", python];

async function record(job, frame) {
  if (job.engine in programs) return run([...onDisplay, ...recorder, frame, ...programs[job.engine](job)]);
  const { address, close } = await serve(job.engine.replace("-page", ""), job);
  const size = `${job.width}x${job.height}`;
  return run([python, ...recorder, frame, "--size", size, "--page", address]).finally(close);
}

/** Writes the capture's folder of a job. */
export async function captureRecorded(job) {
  mkdirSync(job.folder, { recursive: true });
  const folder = mkdtempSync(join(tmpdir(), "gnomon-frame-")),
    frame = join(folder, "frame.rdc");
  try {
    const said = await record(job, frame);
    const name = names[job.engine] ?? /^engine: (.*)$/m.exec(said)?.[1].replace(" v", " ") ?? pages[job.engine];
    await run([...onDisplay, "-B", join(here, "renderdoc"), frame, "-o", job.folder, "--name", name]);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
