// The report page in a real browser. Needs node, tests/browser (npm install) and Debian's chromium-headless-shell; what is
// missing is said, and the test is skipped (exit 77). Usage: node report_browser_test.mjs SAMPLE_PROGRAM WORK_FOLDER
//
// Per sample page: nothing in the console, no request, no axe-core violation in light and dark, every number equal to
// result.json, readable without scripts, no sideways scrolling on a phone; then the viewer by keyboard and by mouse.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { browser, checkAccessibility, checkPhone, close, open as openFolder } from "../browser/open_page.mjs";

const [sampleProgram, folder] = process.argv.slice(2);
execFileSync(sampleProgram, [folder], { stdio: "inherit" });
const open = (name, options) => openFolder(join(folder, name), options);

const byKey = (json, key) => key.split(".").reduce((value, part) => value?.[part], json);

// The number that a reader sees, in the unit of result.json.
function numberShown(text) {
  const match = text
    .replaceAll(",", "")
    .replaceAll("\u2212", "-")
    .match(/^([+-]?[\d.]+(?:e[+-]?\d+)?)(?:\s(.*))?$/);
  if (!match) return null;
  const units = { "%": 0.01, s: 1000, ms: 1, kB: 1e3, MB: 1e6, GB: 1e9, bytes: 1 };
  return Number(match[1]) * (units[match[2]] ?? 1);
}

async function checkNumbers(page, name) {
  const file = JSON.parse(readFileSync(join(folder, name, "result.json"), "utf8"));
  const embedded = JSON.parse(await page.locator("#result").textContent());
  assert.deepEqual(embedded, file, "the embedded result differs from result.json");
  const shown = await page
    .locator("data[data-key]")
    .evaluateAll((all) => all.map((e) => ({ key: e.dataset.key, value: e.getAttribute("value"), text: e.textContent })));
  assert.ok(shown.length > 30, `only ${shown.length} numbers on the page`);
  for (const { key, value, text } of shown) {
    const expected = byKey(file, key);
    assert.notEqual(expected, undefined, `${key} is not in result.json`);
    assert.equal(Number(value), expected, `${key} on the page`);
    const read = numberShown(text);
    // Texts are rounded to two significant digits or more, or to four decimals.
    if (read !== null)
      assert.ok(Math.abs(read - expected) <= Math.max(0.051 * Math.abs(expected), 0.00005), `${key}: ${text} for ${expected}`);
  }
  return shown.length;
}

async function checkSaving(page, name) {
  for (const file of ["result.json", "result.csv"]) {
    const href = await page.locator(`a[download="${file}"]`).getAttribute("href");
    const text = Buffer.from(href.slice(href.indexOf(",") + 1), "base64").toString("utf8");
    assert.equal(text, readFileSync(join(folder, name, file), "utf8"), `${file} as saved from the page`);
  }
}

async function checkWithoutScripts(name) {
  const page = await open(name, { javaScriptEnabled: false });
  await checkNumbers(page, name);
  await checkSaving(page, name);
  assert.equal(await page.locator(".viewer:visible").count(), 0, "the viewer shows without scripts");
  assert.ok((await page.locator("main p").first().textContent()).includes("pixel"), "the verdict is missing");
  assert.ok((await page.locator("main img:visible").count()) >= 5);
  for (const image of await page.locator("main img:visible").all()) {
    assert.ok((await image.boundingBox()).width > 0);
    assert.notEqual(await image.getAttribute("alt"), "");
  }
  await close(page);
}

async function checkPolicy(page) {
  const ran = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.intruder = true";
    document.body.append(script);
    return window.intruder === true;
  });
  assert.equal(ran, false, "an inline script that is not the page's own ran");
  assert.equal(page.offences.splice(0).filter((text) => /Content Security Policy/.test(text)).length, 1);
}

async function checkViewer() {
  const page = await open("one");
  const viewer = page.locator(".viewer").first(),
    stage = viewer.locator(".stage"),
    probe = viewer.locator(".probe");
  const transform = () =>
    stage
      .locator("canvas")
      .first()
      .evaluate((e) => e.style.transform);
  await stage.focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await viewer.locator(".slider input").inputValue(), "52");
  await page.keyboard.press("f");
  assert.equal(await stage.getAttribute("data-mode"), "flip");
  const front = () => stage.locator(".pane:not(.away) .tag").textContent();
  const first = await front();
  await page.keyboard.press("f");
  assert.notEqual(await front(), first, "F did not flip");
  await page.keyboard.press("+");
  assert.match(await transform(), /scale\(1\.5\)/);
  await page.keyboard.press("0");
  assert.match(await transform(), /scale\(1\)/);
  // Pixel (10, 120) of the hand-made picture is acne: (10 + 120) is even, in the first patch.
  const box = await stage.boundingBox();
  await stage.hover({ position: { x: (10.5 / 320) * box.width, y: (120.5 / 180) * box.height } });
  assert.match(
    await probe.textContent(),
    /^Pixel 10, 120: acne; rasterized #[0-9a-f]{6}, linear [\d. e-]+; ray traced #[0-9a-f]{6}, linear [\d. e-]+/,
  );
  await page.keyboard.press("Shift+ArrowRight");
  assert.match(await probe.textContent(), /^Pixel 11, 120: right/);
  await viewer.getByRole("button", { name: "Side by side" }).click();
  const panes = await stage.locator(".pane").evaluateAll((all) => all.map((e) => e.getBoundingClientRect().left));
  assert.ok(panes[1] > panes[0]);
  const picture = page.locator("#picture-labels-0"),
    before = await picture.getAttribute("src");
  const acne = page.getByRole("button", { name: "acne", exact: true });
  await acne.click();
  assert.notEqual(await picture.getAttribute("src"), before, "the label picture did not change");
  await acne.click();
  assert.equal(await picture.getAttribute("src"), before);
  // The label has pinned a pixel, from which steps start; the focus may bring nothing under the mouse.
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const [, x, y] = /^Pixel (\d+), (\d+): acne/.exec((await page.locator(".pixel-title").first().textContent()).trim());
  await stage.evaluate((e) => e.focus({ preventScroll: true }));
  await page.keyboard.press("Shift+ArrowLeft");
  assert.ok(
    (await probe.textContent()).startsWith(`Pixel ${x - 1}, ${y}:`),
    `a step from ${x}, ${y} leads to ${await probe.textContent()}`,
  );
  await close(page);
}

// Several lights stand in tabs: one section at a time, by mouse, keyboard and link; all of them in print.
async function checkTabs() {
  const page = await open("three"),
    tabs = page.getByRole("tab");
  const seen = () => page.locator("main section[id^=light-]:visible").evaluateAll((all) => all.map((e) => e.id));
  assert.equal(await tabs.count(), 3);
  assert.deepEqual(await seen(), ["light-0"]);
  await tabs.nth(1).click();
  assert.deepEqual(await seen(), ["light-1"]);
  assert.equal(await page.getByRole("tabpanel").getAttribute("id"), "light-1");
  await page.waitForFunction(() => location.hash.startsWith("#light-1?"));
  const linked = await openFolder(join(folder, "three"), {}, new URL(page.url()).hash);
  assert.deepEqual(await linked.locator("main section[id^=light-]:visible").evaluateAll((all) => all.map((e) => e.id)), ["light-1"]);
  await close(linked);
  await close(await openFolder(join(folder, "three"), {}, "#light-01")); // a light by another spelling of its number
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.deepEqual(await seen(), ["light-0"]);
  assert.equal(await tabs.first().evaluate((e) => e === document.activeElement && e.getAttribute("aria-selected") === "true"), true);
  await page.keyboard.press("End");
  assert.deepEqual(await seen(), ["light-2"]);
  await page.locator("nav a[href='#light-1']").click();
  await page.locator("#light-1").waitFor({ state: "visible" });
  await page.waitForFunction(() => document.querySelector("#light-1").getBoundingClientRect().top < 200);
  assert.deepEqual(await seen(), ["light-1"]);
  await page.emulateMedia({ media: "print" });
  assert.deepEqual(await seen(), ["light-0", "light-1", "light-2"]);
  await close(page);
}

// The first screen of 1440 x 900 holds both pictures and the labelled one, side by side.
async function checkFirstScreen() {
  const page = await open("one"),
    boxes = [];
  for (const id of ["picture-raster", "picture-raytraced", "picture-labels-0"]) boxes.push(await page.locator(`#${id}`).boundingBox());
  for (const box of boxes) assert.ok(box.y === boxes[0].y && box.y + box.height < 900 && box.width > 300, JSON.stringify(boxes));
  assert.ok(boxes[0].x < boxes[1].x && boxes[1].x < boxes[2].x);
  const verdict = await page.locator(".verdict").first().boundingBox();
  assert.ok(verdict.y + verdict.height < boxes[0].y, JSON.stringify(verdict));
  await close(page);
  const phone = await open("one", { viewport: { width: 390, height: 844 } }),
    said = await phone.locator(".verdict").first().boundingBox();
  assert.ok(said.y + said.height < 844, `on a phone the verdict ends at ${said.y + said.height}`);
  await close(phone);
}

// Of a picture with more pixels than a page holds the page shows some, and says so on its first screen, scripts or none.
async function checkReducedPage() {
  for (const javaScriptEnabled of [true, false]) {
    const page = await open("large", { javaScriptEnabled }),
      said = page.locator("main p", { hasText: "shows one pixel" });
    const words = async (place) => (await place.innerText()).replaceAll(/\s+/g, " ");
    assert.match(await words(said), /^This page shows one pixel of every 3 × 3 .* are of all pixels\.$/);
    const box = await said.boundingBox();
    assert.ok(box.y + box.height < 900, `said at ${box.y}, below the first screen`);
    if (javaScriptEnabled) assert.match(await words(page.locator(".setting").first()), /^10000 × 5625 pixels/);
    await checkNumbers(page, "large");
    // 320 x 180 pixels were given: every third of their columns and rows.
    if (javaScriptEnabled)
      assert.deepEqual(
        await page
          .locator(".stage canvas")
          .first()
          .evaluate((e) => [e.width, e.height]),
        [107, 60],
      );
    await close(page);
  }
  const page = await open("one");
  assert.equal(await page.getByText("shows one pixel").count(), 0);
  await close(page);
}

// Several captures: the worst first, each with a link to its own page, and the same without scripts.
async function checkCaptures() {
  const page = await open("captures"),
    rows = await page.locator(".captures tbody tr").allInnerTexts();
  assert.deepEqual(
    rows.map((row) => row.replaceAll(/\s+/g, " ").trim()),
    [
      "shot#1 <b> fence Another 2.0 12.5 % 25.0 % acne 12 1.5 0.0625 bias 0.002 instead of 0.001",
      "empty nothing compared",
      "refused not judged: no such file",
    ],
  );
  assert.deepEqual(await page.locator(".captures a").evaluateAll((all) => all.map((a) => a.getAttribute("href"))), [
    "shot%231%20%3Cb%3E/report.html",
    "empty/report.html",
  ]);
  assert.equal(await page.locator("nav a").getAttribute("href"), "#captures");
  await close(page);
  const plain = await open("captures", { javaScriptEnabled: false });
  assert.equal(await plain.locator("tbody tr", { hasText: "shot#1 <b>" }).getByText("0.125", { exact: true }).count(), 1);
  await close(plain);
  await checkPhone(join(folder, "captures"));
  await checkAccessibility(join(folder, "captures"));
}

// What shadows cost is said by what has moved; what only the rounding of sums leaves is written as 0.
async function checkSums() {
  const three = await open("three");
  const costs = await three.locator("#overview .shadow-costs > div").allTextContents();
  assert.equal(costs.length, 3);
  assert.match(costs[0], /^Shadows, .*, nothing moves.* by the map, .* by rays$/);
  assert.match(costs[2], /casters move.* by the map, .* by rays$/);
  assert.equal(await three.locator("#cost").getByText("casters move").count(), 3, "of each light");
  await close(three);
  const page = await open("cancelling"),
    sums = await page.locator("table:is(.budget, .ladder) tr.sum .n").allTextContents();
  assert.deepEqual(
    sums.filter((text) => text !== ""),
    ["0", "0"],
  );
  await close(page);
}

try {
  for (const name of ["one", "three", "none"]) {
    const page = await open(name);
    const numbers = await checkNumbers(page, name);
    await checkSaving(page, name);
    if (name === "one") await checkPolicy(page);
    await close(page);
    await checkWithoutScripts(name);
    await checkPhone(join(folder, name));
    await checkAccessibility(join(folder, name));
    console.log(`${name}: ${numbers} numbers equal to result.json, no violation, no request`);
  }
  await checkViewer();
  await checkTabs();
  await checkFirstScreen();
  await checkReducedPage();
  await checkCaptures();
  await checkSums();
  console.log(
    "viewer: keys, mouse and labels work; three lights in tabs; the first screen has the labelled picture, and says what it leaves out",
  );
} finally {
  await browser.close();
}
