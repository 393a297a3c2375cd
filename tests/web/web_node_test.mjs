// The program for the web, in Node, against the native program of the same sources: rays of eight scenes, and two of them by
// exact arithmetic, are the same to the last bit. Usage: web_node_test.mjs GNOMON FOLDER. Exit code 77 where the web's has not been built.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, statSync } from "node:fs";
import { fileURLToPath } from "node:url";
import path from "node:path";
import { readExr } from "../../adapters/exr.mjs";

const [native, folder] = process.argv.slice(2);
const web = fileURLToPath(new URL("../../build/web/app/gnomon.js", import.meta.url));
const wasm = path.join(path.dirname(web), "gnomon.wasm");
if (!existsSync(wasm)) {
  console.log("skipped: the program for the web is not here (./gnomon web builds it)");
  process.exit(77);
}
mkdirSync(folder, { recursive: true });

const runs = [
  ["acne-floor"],
  ["sphere-plane"],
  ["whitted"],
  ["teapot"],
  ["far-away"],
  ["fence"],
  ["shapes"],
  ["courtyard"],
  ["acne-floor", "--precision", "exact"],
  ["thin-wall", "--precision", "exact"],
];

function trace(program, words, file) {
  const done = spawnSync(program[0], [...program.slice(1), "raytrace", ...words, "--size", "160x90", "-o", file], { encoding: "utf8" });
  if (done.stderr.includes("\r")) throw new Error(`${program.join(" ")} writes a progress bar into a log: ${JSON.stringify(done.stderr)}`);
  if (done.status !== 0) throw new Error(`${program.join(" ")} raytrace ${words.join(" ")}: exit code ${done.status}: ${done.stderr}`);
  return readExr(file);
}

const bits = (values) => new Uint32Array(values.buffer, values.byteOffset, values.length);
function unlike(a, b) {
  const x = bits(a),
    y = bits(b);
  let count = 0;
  for (let i = 0; i < x.length; ++i) count += x[i] !== y[i];
  return count;
}

let wrong = 0;
for (const words of runs) {
  const name = words.join("_").replaceAll("-", "");
  const ours = trace([native], words, path.join(folder, `${name}_native.exr`));
  const theirs = trace([process.execPath, web], words, path.join(folder, `${name}_web.exr`));
  const names = Object.keys(ours.channels);
  if (String(names) !== String(Object.keys(theirs.channels))) throw new Error(`${name}: other channels: ${Object.keys(theirs.channels)}`);
  const differs = names.map((channel) => [channel, unlike(ours.channels[channel], theirs.channels[channel])]).filter(([, n]) => n > 0);
  const good = differs.length === 0;
  console.log(
    `${words.join(" ")}: ${good ? "ok" : "WRONG"}, ${differs.length === 0 ? "the same bits in all channels" : `pixels unlike: ${differs.map(([channel, n]) => `${channel} ${n}`).join(", ")}`}`,
  );
  wrong += !good;
}
console.log(`gnomon.wasm: ${statSync(wasm).size} bytes`);
process.exit(wrong === 0 ? 0 : 1);
