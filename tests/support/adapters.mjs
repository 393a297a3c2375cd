// What the tests of the adapters share: small scenes, a capture, its verdict.
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const adapters = fileURLToPath(new URL("../../adapters/", import.meta.url));
const size = ["--size", "160x90"];

export const isThere = (name) => existsSync(join(adapters, "node_modules", name));

/** The conformance suite, in a folder made again. */
export function makeScenes(gnomon, folder) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  execFileSync(gnomon, ["export", "--suite", folder, ...size, "--quiet"]);
}

const run = (folder, engine, scene, options) =>
  spawnSync(
    "node",
    [
      join(adapters, "capture.mjs"),
      engine,
      join(folder, `${scene}${existsSync(join(folder, `${scene}.gltf`)) ? ".gltf" : ".glb"}`),
      "-o",
      join(folder, `${engine}-${scene}`),
      ...size,
      ...options,
    ],
    { encoding: "utf8" },
  );

/** The folder of a capture that an adapter made. */
export function captured(folder, engine, scene, ...options) {
  const { status, stderr } = run(folder, engine, scene, options);
  if (status !== 0) throw new Error(`${engine}: ${stderr}`);
  return join(folder, `${engine}-${scene}`);
}

/** What an adapter says that refuses. */
export function refused(folder, engine, scene, ...options) {
  const { status, stderr } = run(folder, engine, scene, options);
  if (status === 0) throw new Error(`${engine} accepts ${options.join(" ")}`);
  return stderr;
}

/** The result of gnomon judge. */
export function judge(gnomon, folder, ...options) {
  return JSON.parse(
    execFileSync(gnomon, ["judge", join(folder, "capture.json"), "--json", "-", "--quiet", ...options], { maxBuffer: 1 << 26 }),
  );
}
