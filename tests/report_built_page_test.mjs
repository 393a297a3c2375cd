// The built page that is checked in (compare/report/page/dist/page.html) is what its sources build, byte for byte, and
// weighs under 400 kB. Needs node and compare/report/page (npm install); skipped (exit 77) without. Usage: node
// report_built_page_test.mjs WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const sources = fileURLToPath(new URL("../compare/report/page", import.meta.url));
const folder = resolve(process.argv[2]), vite = join(sources, "node_modules/vite/bin/vite.js");
if (!existsSync(vite)) {
  console.log("skipped: vite is not installed: npm install --no-save --prefix compare/report/page");
  process.exit(77);
}
rmSync(folder, { recursive: true, force: true });
execFileSync(process.execPath, [join(sources, "node_modules/typescript/bin/tsc"), "--noEmit", "-p", sources], { stdio: "inherit" });
execFileSync(process.execPath, [vite, "build", sources, "--outDir", folder], { stdio: "inherit" });
const built = readFileSync(join(folder, "page.html")), kept = readFileSync(join(sources, "dist/page.html"));
assert.ok(built.equals(kept), "dist/page.html is not what the sources build: npm run build in compare/report/page");
assert.ok(kept.length < 400_000, `the page weighs ${kept.length} bytes`);
console.log(`the built page is as its sources: ${kept.length} bytes`);
