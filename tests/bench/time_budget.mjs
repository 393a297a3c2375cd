// What `gnomon compare` lists of its time against the clock of whoever starts it, on six scenes from a few
// triangles to five million, as a Markdown table: node tests/bench/time_budget.mjs [PROGRAM] [SHARED_DATA]
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const program = process.argv[2] ?? "build/release/app/gnomon";
const data = process.argv[3] ?? "../shared/data";
const folder = mkdtempSync(join(tmpdir(), "gnomon-time-budget-"));

/// A terrain of 2 (side - 1)^2 triangles, as binary PLY.
function terrain(side) {
  const path = join(folder, `terrain-${side}.ply`);
  const faces = 2 * (side - 1) ** 2;
  const head = Buffer.from(
    `ply\nformat binary_little_endian 1.0\nelement vertex ${side * side}\nproperty float x\nproperty float y\n` +
      `property float z\nelement face ${faces}\nproperty list uchar int vertex_indices\nend_header\n`,
  );
  const vertices = Buffer.alloc(12 * side * side),
    indices = Buffer.alloc(13 * faces);
  for (let i = 0; i < side * side; ++i) {
    const x = i % side,
      y = Math.floor(i / side);
    const height = 0.03 * Math.sin(0.37 * x) * Math.cos(0.29 * y) + 0.2 * Math.sin(0.011 * x + 0.017 * y);
    [(10 * x) / side, height, (10 * y) / side].forEach((v, k) => vertices.writeFloatLE(v, 12 * i + 4 * k));
  }
  let at = 0;
  const face = (...corners) => {
    at = indices.writeUInt8(3, at);
    for (const corner of corners) at = indices.writeInt32LE(corner, at);
  };
  for (let y = 0; y + 1 < side; ++y)
    for (let x = 0; x + 1 < side; ++x) {
      const a = y * side + x;
      face(a, a + side, a + 1);
      face(a + 1, a + side, a + side + 1);
    }
  writeFileSync(path, Buffer.concat([head, vertices, indices]));
  return path;
}

const scenes = ["acne-floor", "fence", "whitted", join(data, "common_organic/stanford-bunny.obj")].filter(
  (scene) => !scene.includes("/") || existsSync(scene),
);
scenes.push(terrain(708), terrain(1582));

console.log("| scene | triangles | listed, ms | from outside, ms | difference | largest stages |");
console.log("|---|---:|---:|---:|---:|---|");
for (const scene of scenes) {
  const out = join(folder, "out");
  const start = process.hrtime.bigint();
  execFileSync(program, ["compare", scene, "-o", out, "--quiet"], { stdio: "ignore" });
  const outside = Number(process.hrtime.bigint() - start) / 1e6;
  const result = JSON.parse(readFileSync(join(out, "result.json"), "utf8"));
  const listed = result.time_budget.reduce((sum, stage) => sum + stage.wall_ms, 0);
  const largest = [...result.time_budget]
    .sort((a, b) => b.wall_ms - a.wall_ms)
    .slice(0, 4)
    .map((stage) => `${stage.stage} ${stage.wall_ms.toFixed(0)}`)
    .join(", ");
  console.log(
    `| ${result.scene.name} | ${result.scene.triangles} | ${listed.toFixed(0)} | ${outside.toFixed(0)} | ` +
      `${((100 * (outside - listed)) / outside).toFixed(2)} % | ${largest} |`,
  );
}
rmSync(folder, { recursive: true });
