// The built pages that are checked in (report/page/dist) are what their sources build, byte for byte, and weigh
// under 400 kB each. Needs node and report/page (npm install); skipped (exit 77) without. Usage: node
// report_built_page_test.mjs PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const sources = fileURLToPath(new URL("../../report/page", import.meta.url));
const folder = resolve(process.argv[3]),
  vite = join(sources, "node_modules/vite/bin/vite.js");
if (!existsSync(vite)) {
  console.log("skipped: vite is not installed: npm install --no-save --prefix report/page");
  process.exit(77);
}
rmSync(folder, { recursive: true, force: true });
execFileSync(process.execPath, [join(sources, "result_types.mjs")], {
  env: { ...process.env, GNOMON: resolve(process.argv[2]) },
  stdio: "inherit",
});
execFileSync(process.execPath, [join(sources, "node_modules/typescript/bin/tsc"), "--noEmit", "-p", sources], { stdio: "inherit" });
for (const [name, ...mode] of [["page.html"], ["lesson.html", "--mode", "lesson"], ["lab.html", "--mode", "lab"]]) {
  execFileSync(process.execPath, [vite, "build", sources, "--outDir", folder, ...mode], { stdio: "inherit" });
  const built = readFileSync(join(folder, name)),
    kept = readFileSync(join(sources, "dist", name));
  assert.ok(built.equals(kept), `dist/${name} is not what the sources build: npm run build in report/page`);
  assert.ok(kept.length < 400_000, `${name} weighs ${kept.length} bytes`);
  console.log(`${name} is as its sources: ${kept.length} bytes`);
}
