// The page of a hybrid comparison: its numbers are those of result.json, each pixel's story says who decided it as the EXR
// file has it, and the picture marks as many pixels as were traced. Needs what report_browser_test needs, OpenGL in
// software, and oiiotool. Usage: node report_hybrid_browser_test.mjs GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { browser, checkAccessibility, close, open } from "../browser/open_page.mjs";

const [program, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const width = 240,
  height = 135,
  traced = 2;
execFileSync(
  program,
  [
    "compare",
    "thin-wall",
    "--technique",
    "hybrid",
    "--size",
    `${width}x${height}`,
    "--map-size",
    "128",
    "--runs",
    "1",
    "--quiet",
    "-o",
    folder,
    "--aov",
    join(folder, "all.exr"),
  ],
  { stdio: "inherit" },
);
const result = JSON.parse(readFileSync(join(folder, "result.json"), "utf8")),
  { hybrid } = result.lights[0].map;

function decisions() {
  execFileSync("oiiotool", [join(folder, "all.exr"), "--ch", "decision.V,class.V", "-o", join(folder, "few.exr")]);
  const text = execFileSync("oiiotool", ["--dumpdata", join(folder, "few.exr")], { encoding: "utf8", maxBuffer: 1 << 28 }),
    pixels = [];
  for (const [, x, y, values] of text.matchAll(/Pixel \((\d+), (\d+)\): (.*)/g)) {
    const [label, who] = values.trim().split(/\s+/).map(Number); // EXR files sort their channels: class, decision
    pixels.push({ x: Number(x), y: Number(y), label, who });
  }
  return pixels;
}

const at = (path) => path.split(".").reduce((value, key) => value[key], result);
const stories = [/surely in shadow, no ray was cast/, /surely lit, no ray was cast/, /a ray was cast/];

try {
  const page = await open(folder),
    keyed = page.locator("data[data-key^='lights.0.map.hybrid']");
  assert.ok((await keyed.count()) >= 7);
  for (const [key, value] of await keyed.evaluateAll((all) => all.map((e) => [e.dataset.key, Number(e.value)])))
    assert.equal(value, at(key), key);
  assert.equal(await page.locator("text=/bias [\\d.]+ world units/").count(), 0, "an exact technique has no bias");
  const pixels = decisions(),
    counts = [0, 1, 2].map((who) => pixels.filter((p) => p.who === who).length);
  assert.ok(
    counts.every((count) => count > 0),
    `decisions ${counts}`,
  );
  assert.equal(counts[1], hybrid.surely_lit);
  const marked = await page.locator("[id^=picture-decisions]").evaluate((image) => {
    const canvas = Object.assign(document.createElement("canvas"), { width: image.naturalWidth, height: image.naturalHeight }),
      context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += data[i] === 0xa0 && data[i + 1] === 0 && data[i + 2] === 0x30;
    return count;
  });
  assert.equal(marked, counts[traced]);
  await checkAccessibility(folder);
  await close(page);
  for (const who of [0, 1, 2]) {
    const { x, y } = pixels.find((p) => p.who === who && p.label >= 0),
      probed = await open(folder, {}, `#light-0?pixel=${x},${y}`);
    assert.match(await probed.locator(".story").textContent(), stories[who]);
    await close(probed);
  }
  console.log(`surely in shadow ${counts[0]}, surely lit ${counts[1]}, traced ${counts[2]}: numbers, stories and picture agree`);
} finally {
  await browser.close();
}
