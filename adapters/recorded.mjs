// Engines of this machine whose frames RenderDoc records: adapters/renderdoc makes the captures, with map.
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

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
const software = {
  LIBGL_ALWAYS_SOFTWARE: "1",
  VK_ICD_FILENAMES: "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
  QSG_RHI_BACKEND: "vulkan",
  QSG_RENDER_LOOP: "basic",
};

export const isRecorded = (engine) => engine in programs;

function run(words) {
  const [program, ...rest] = ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x1024x24", ...words];
  const done = spawnSync(program, rest, { encoding: "utf8", env: { ...process.env, ...software } });
  if (done.error) throw new Error(`${program} cannot be run: ${done.error.message}`);
  if (done.status !== 0)
    throw new Error(
      `${done.stdout}${done.stderr}`
        .trim()
        .split("\n")
        .findLast((line) => /^(error|record): /.test(line)) || `${words[1]} ended with ${done.status}`,
    );
}

/** Writes the capture's folder of a job. */
export function captureRecorded(job) {
  mkdirSync(job.folder, { recursive: true });
  const folder = mkdtempSync(join(tmpdir(), "gnomon-frame-")),
    frame = join(folder, "frame.rdc");
  try {
    run([python, "-B", join(here, "renderdoc", "record.py"), "-o", frame, ...programs[job.engine](job)]);
    run([python, "-B", join(here, "renderdoc"), frame, "-o", job.folder, "--name", names[job.engine]]);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
