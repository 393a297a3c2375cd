// The page of a film of shadows: its numbers are those of result.json, every frame marks as many flips as the result
// counts, the probe marks a receiver's flips, the film steps, scrubs and plays, and the animated PNG beside it ends with
// the picture that the page ends with. Needs what report_browser_test needs, and OpenGL in software.
// Usage: node shimmer_browser_test.mjs GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { inflateSync } from "node:zlib";
import { browser, checkAccessibility, checkPhone, checkPicture, close, open } from "../browser/open_page.mjs";

const [program, folder] = process.argv.slice(2);
const whole = join(folder, "whole"),
  parts = join(folder, "parts");
mkdirSync(folder, { recursive: true });
const width = 120,
  height = 80,
  frames = 6;
const film = (out, ...more) =>
  execFileSync(
    program,
    [
      "shimmer",
      "fence",
      "--size",
      `${width}x${height}`,
      "--map-size",
      "128",
      "--frames",
      `${frames}`,
      "--path",
      "orbit",
      "--speed",
      "3",
      "--quiet",
      "-o",
      out,
      ...more,
    ],
    { stdio: "inherit" },
  );
film(whole);
film(parts, "--report-max-mb", "0");
const result = JSON.parse(readFileSync(join(whole, "result.json"), "utf8")),
  [light] = result.lights;
const at = (path) => path.split(".").reduce((value, key) => value[Array.isArray(value) ? Number(key) : key], result);

/** The last picture of an animated PNG whose frames are whole and laid over each other, as RGB. */
function lastPicture(file) {
  const bytes = readFileSync(file),
    shown = new Uint8Array(3 * width * height);
  let stream = [],
    count = 0,
    announced = 0;
  const lay = () => {
    if (stream.length === 0) return;
    const rows = inflateSync(Buffer.concat(stream)),
      row = 4 * width + 1;
    for (let i = 0; i < width * height; ++i) {
      const from = Math.floor(i / width) * row + 1 + 4 * (i % width);
      if (rows[from + 3] === 255) shown.set(rows.subarray(from, from + 3), 3 * i);
    }
    ++count;
    stream = [];
  };
  for (let offset = 8; offset < bytes.length;) {
    const length = bytes.readUInt32BE(offset),
      type = bytes.toString("latin1", offset + 4, offset + 8),
      data = bytes.subarray(offset + 8, offset + 8 + length);
    if (type === "acTL") announced = data.readUInt32BE(0);
    if (type === "fcTL") lay();
    if (type === "IDAT") stream.push(data);
    if (type === "fdAT") stream.push(data.subarray(4));
    offset += 12 + length;
  }
  lay();
  assert.equal(count, announced);
  assert.equal(count, frames);
  return shown;
}

const showsFrame = (page, frame) =>
  page.waitForFunction((f) => document.querySelector(".shimmer-light").dataset.frame === f, String(frame));
const pixels = (page) =>
  page.locator(".film canvas").evaluate((canvas) => [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data]);
const showsView = async (page, view) => {
  await page.click(`button[data-view=${view}]`);
  await page.waitForFunction((v) => document.querySelector(`button[data-view=${v}]`).getAttribute("aria-pressed") === "true", view);
};

async function checkFilm(page) {
  await showsFrame(page, 0);
  for (let frame = 1; frame < frames; ++frame) {
    await page.click(".film-on");
    await showsFrame(page, frame);
    await showsView(page, "drawn");
    const plain = await pixels(page);
    await showsView(page, "flips");
    const marked = await pixels(page);
    let changed = 0;
    for (let i = 0; i < plain.length; i += 4)
      changed += plain[i] !== marked[i] || plain[i + 1] !== marked[i + 1] || plain[i + 2] !== marked[i + 2];
    assert.equal(changed, light.by_frame[frame - 1].flips, `flips to frame ${frame}`);
  }
  await showsView(page, "drawn");
  const drawn = (await pixels(page)).filter((_, i) => i % 4 !== 3);
  assert.deepEqual(drawn, [...lastPicture(join(whole, "film-0-drawn.png"))]);
  await page.locator(".film input[type=range]").fill("2");
  await showsFrame(page, 2);
  assert.equal(await page.locator(".film-frame").textContent(), `frame 3 of ${frames}`);
}

async function checkProbe(page) {
  const [worst] = light.worst;
  await page.locator(".place button").first().click();
  await page.waitForFunction((pixel) => document.querySelector(".film-probe").dataset.pixel === pixel, String(worst.y * width + worst.x));
  assert.equal(await page.locator(".strip-flip").count(), worst.flips);
  assert.match(
    await page.locator(".film-probe .probe").textContent(),
    new RegExp(`^Pixel ${worst.x}, ${worst.y}: ${worst.flips} flips?, by `),
  );
}

async function checkNumbers(page, least) {
  const keyed = await page.locator("data[data-key]").evaluateAll((all) => all.map((e) => [e.dataset.key, Number(e.value)]));
  assert.ok(keyed.length >= least, `${keyed.length} numbers`);
  for (const [key, value] of keyed) assert.equal(value, at(key), key);
}

// The map of flips, and all that the result says.
async function checkWithoutScripts() {
  const plain = await open(whole, { javaScriptEnabled: false });
  await checkNumbers(plain, 30);
  await checkPicture(plain.locator("main img"));
  assert.match(await plain.locator("main img").getAttribute("alt"), /^Flips of each receiver, .* \d+$/);
  await close(plain);
  await checkPhone(whole, { javaScriptEnabled: false });
}

// Once round, whatever the time it takes.
async function checkPlay(page) {
  await page.click(".film-play");
  await page.waitForFunction(() => document.querySelector(".film-play").textContent === "Pause");
  await showsFrame(page, frames - 1);
  await showsFrame(page, 1);
  await page.click(".film-play");
  await page.waitForFunction(() => document.querySelector(".film-play").textContent === "Play");
}

try {
  assert.ok(light.flips > 100, `flips ${light.flips}`);
  const page = await open(whole);
  await checkNumbers(page, 20);
  await checkFilm(page);
  await checkProbe(page);
  await checkPlay(page);
  await close(page);
  const beside = await open(parts, { beside: true });
  await checkProbe(beside);
  await close(beside);
  rmSync(join(parts, "report-data", "film-0.js"));
  const lacking = await open(parts, { beside: true });
  assert.match(await lacking.locator(".shimmer-light .left-out").textContent(), /^The film and its probe are missing: /);
  assert.deepEqual(
    lacking.offences.splice(0).filter((text) => !text.includes("ERR_FILE_NOT_FOUND")),
    [],
  );
  await close(lacking);
  await checkWithoutScripts();
  await checkAccessibility(whole);
  await checkPhone(whole);
  console.log(`${light.flips} flips in ${frames} frames: page, films and result agree`);
} finally {
  await browser.close();
}
