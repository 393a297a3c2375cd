// The pages write numbers as the program does: its texts (numbers.json) against report/page/src/number_text.ts. Needs node
// and report/page (npm install); skipped (exit 77) without. Usage: node report_numbers_test.mjs SAMPLE_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const [sampleProgram, folder] = process.argv.slice(2),
  sources = fileURLToPath(new URL("../../report/page", import.meta.url));
if (!existsSync(join(sources, "node_modules/esbuild"))) {
  console.log("skipped: esbuild is not installed: npm install --no-save --prefix report/page");
  process.exit(77);
}
const { transformSync } = createRequire(join(sources, "package.json"))("esbuild");
const { code } = transformSync(readFileSync(join(sources, "src/number_text.ts"), "utf8"), { loader: "ts", format: "esm" });
const written = await import(`data:text/javascript;base64,${Buffer.from(code).toString("base64")}`);
execFileSync(sampleProgram, [folder], { stdio: "inherit" });
const numbers = JSON.parse(readFileSync(join(folder, "numbers.json"), "utf8"));
assert.ok(numbers.length > 100);
for (const { value, ...texts } of numbers)
  for (const [name, text] of Object.entries(texts)) {
    const given = { signedNumber: -value, byteCount: Math.floor(value), grouped: Math.floor(value) }[name] ?? value;
    assert.equal(written[name](given), text, `${name} of ${given}`);
  }
console.log(`${numbers.length} numbers are written alike`);
