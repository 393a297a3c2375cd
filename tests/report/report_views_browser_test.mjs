// The report page as it is shown, on a real comparison, in a real browser: the presenter, glass and mirrors, views that the
// URL restores, tall pictures, files beside the page, a phone, accessibility, its weight.
// Needs what report_browser_test needs, and OpenGL in software. Usage: node report_views_browser_test.mjs GNOMON_PROGRAM
// WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import {
  biases,
  canvasOf,
  countsAt,
  folder,
  folderOf,
  height,
  program,
  redrawn,
  resultOf,
  shown,
  width,
} from "../browser/compared_page.mjs";
import { browser, checkAccessibility, checkPhone, checkPicture, close, open, violations } from "../browser/open_page.mjs";

// Glass and a mirror: the pictures' remarks, a probe that tells of the surface and not of a pixel in shadow, and what the
// map takes for opaque. Of a slope bias and a constant both parts are named, and their sum.
async function checkGlass() {
  const glass = join(folder, "glass"),
    size = { width: 240, height: 136 };
  execFileSync(
    program,
    ["compare", "whitted", "--size", `${size.width}x${size.height}`, "--map-size", "256", "--runs", "1", "--quiet", "-o", glass],
    { stdio: "inherit" },
  );
  const page = await open(glass);
  assert.match(await page.locator("#overview .remark").first().textContent(), /Drawn plainly: .* matte grey/);
  const found = await page.evaluate(async () => {
    const light = await gnomon.light(0),
      kinds = {};
    for (let i = 0; i < light.label.length; ++i) {
      const pixel = light.pixel(i % 240, Math.floor(i / 240));
      if (pixel.label < 0 || !Number.isFinite(pixel.gap)) continue;
      const kind = pixel.material ? `${pixel.material.name} ${pixel.rungs[0]}` : pixel.storedGlass ? `floor ${pixel.rungs[0]}` : "";
      if (pixel.rungs[0] === pixel.rungs[6]) kinds[kind] ??= [pixel.x, pixel.y];
    }
    return kinds;
  });
  const said = {
    "glass 1": /glass \(material “glass”\)[\s\S]*matte grey[\s\S]*opaque/,
    "mirror 1": /a mirror \(material “mirror”\)/,
    "mirror 0": /a mirror/,
    "floor 0": /holds glass \(material “glass”\)[\s\S]*bright/,
  };
  for (const [kind, expected] of Object.entries(said)) {
    const at = await open(glass, {}, `#light-0?pixel=${found[kind]}`),
      story = await at.locator(".story").textContent();
    assert.match((await at.locator(".probe-words .remark").allTextContents()).join(" "), expected, kind);
    if (!kind.startsWith("floor")) assert.doesNotMatch(story, /in shadow|: lit/, kind);
    if (kind === "glass 1") {
      const parts = (await at.locator(".bias-mark text").allTextContents()).map((text) => Number(/[\d.e-]+(?=:?$)/.exec(text)[0]));
      assert.equal(parts.length, 3);
      assert.ok(parts[1] > 0 && parts[2] > parts[1] && Math.abs(parts[0] - parts[1] - parts[2]) <= 0.01 * parts[0], `bias ${parts}`);
    }
    await close(at);
  }
  await close(page);
}

// What a reader sets, another reader of the same link sees.
async function checkUrl() {
  const first = await open(folderOf(biases[0])),
    stage = first.locator(".stage");
  // Keys need no click where the pictures are before the reader.
  await stage.evaluate((e) => e.scrollIntoView({ block: "center" }));
  await first.keyboard.press("f");
  await stage.focus();
  for (const key of ["+", "+", "ArrowRight", "Shift+ArrowDown"]) await first.keyboard.press(key);
  await first.locator(".pick").first().selectOption({ label: "labels" });
  await first.locator(".pick").last().selectOption({ label: "gap" });
  await first.locator(".exposure input").fill("1.5");
  await first.getByRole("button", { name: "column" }).click();
  await countsAt(first, 0.125);
  await first.waitForFunction(() => location.hash.includes("bias=0.125"));
  const view = (page) =>
    page.evaluate(() => ({
      mode: document.querySelector(".stage").dataset.mode,
      zoom: document.querySelector(".zoom-value").textContent,
      moved: [...document.querySelectorAll(".stage img, .stage canvas")].map((e) => e.style.transform),
      pictures: [...document.querySelectorAll(".tag")].map((e) => e.textContent),
      title: document.querySelector(".pixel-title").textContent,
      story: document.querySelector(".story").textContent,
      counts: document.querySelector(".bias-counts").textContent,
      cut: document.querySelector("[data-cut][aria-pressed=true]").textContent,
      exposure: document.querySelector(".exposure input").value,
    }));
  const second = await open(folderOf(biases[0]), {}, new URL(first.url()).hash);
  assert.deepEqual(await view(second), await view(first));
  assert.equal((await view(second)).mode, "flip");
  await close(first);
  await close(second);
  const strange = await open(folderOf(biases[0]), {}, "#light-0?pixel=9999,-3&zoom=x&mode=<b>&bias=&texels=5.5");
  assert.equal((await view(strange)).mode, "swipe");
  assert.equal(await strange.locator("[data-texels='16']").getAttribute("aria-pressed"), "true", "half a texel is no width");
  await close(strange);
  // Names that every object has are none of the state's; a pixel outside is the nearest one, with its marker.
  const outside = await open(folderOf(biases[0]), {}, "#light-0?constructor=2&__proto__=1&toString=3&pixel=9999,9999");
  const marker = await outside
    .locator(".pane .marker")
    .first()
    .evaluate((e) => [e.style.left, e.style.top].map(parseFloat));
  assert.deepEqual(
    marker.map((at) => Math.round(at)),
    [width - 1, height - 1].map((at, k) => Math.round((100 * at) / [width, height][k])),
  );
  await close(outside);
}

// On the usual projectors the whole ladder is seen, and what is written in the drawings can be read.
async function checkPresenterOnProjectors() {
  for (const [w, h] of [
    [1280, 720],
    [1024, 768],
  ]) {
    const page = await open(folderOf(biases[1]), { viewport: { width: w, height: h } }, "#light-0?pixel=100,80");
    await page.getByRole("button", { name: "Present" }).click();
    const alone = await page.locator("dialog.presenter .bias-picture").boundingBox();
    assert.ok(
      alone.width * alone.height >= 0.6 * w * h && alone.y + alone.height <= h,
      `${w}: the picture alone is ${JSON.stringify(alone)}`,
    );
    await page.keyboard.press("2");
    assert.equal(
      await page.locator("dialog.presenter .presenter-overlay").getAttribute("src"),
      await page.locator("#picture-raster").getAttribute("src"),
    );
    await page.keyboard.press("1");
    assert.equal(await page.locator("dialog.presenter .presenter-overlay").isVisible(), false);
    await page.keyboard.press("d");
    await redrawn(page);
    for (const rung of await page.locator("dialog.presenter .pixel-ladder tbody tr").all()) {
      const box = await rung.boundingBox();
      assert.ok(
        box.y > 0 && box.y + box.height <= h && box.x + box.width <= w,
        `${w}: ${await rung.textContent()} at ${JSON.stringify(box)}`,
      );
    }
    for (const drawing of ["svg.light-space", "svg.section"]) {
      const pixels = await page
        .locator(`dialog.presenter ${drawing}`)
        .evaluate((svg) => svg.getScreenCTM().a * parseFloat(getComputedStyle(svg.querySelector("text")).fontSize));
      assert.ok(pixels >= 11, `${w}: ${drawing} is written in ${pixels} pixels`);
    }
    await close(page);
  }
}

// Whatever the picture's shape, all of it is on the screen at once.
async function checkStageInWindow() {
  const tall = join(folder, "tall");
  execFileSync(program, ["compare", "sphere-plane", "--size", "60x120", "--map-size", "64", "--runs", "1", "--quiet", "-o", tall]);
  const page = await open(tall, { viewport: { width: 1440, height: 900 } });
  for (const mode of ["Swipe", "Side by side"]) {
    await page.getByRole("button", { name: mode }).click();
    const { width: w, height: h } = await page.locator(".stage .pane").first().boundingBox();
    assert.ok(h <= 900 && h > 600, `${mode}: ${h} pixels high`);
    assert.ok(Math.abs(w / h - 0.5) < 0.01, `${mode}: ${w} x ${h}`);
  }
  const bias = await page.locator(".bias-picture canvas").boundingBox();
  assert.ok(bias.height <= 900, `bias: ${bias.height} pixels high`);
  await close(page);
}

// Picture, pixel drawing, cross-section and bias on one screen of 1440 x 900; what one shows follows what is dragged in
// another. Closed, all is back in its place.
async function checkPresenter() {
  const page = await open(folderOf(biases[0]), {}, "#light-0?pixel=100,80"),
    dialog = page.locator("dialog.presenter");
  const places = () => JSON.stringify([...document.querySelectorAll(".bias-live, .pixel-probe")].map((e) => e.textContent.length > 40));
  const before = await page.evaluate(places);
  await page.getByRole("button", { name: "Present" }).click();
  await page.getByRole("button", { name: "Details" }).click();
  for (const part of [".bias-picture canvas", "svg.light-space", "svg.section", ".bias-bar input[type=range]", ".story"]) {
    const box = await dialog.locator(part).boundingBox();
    assert.ok(
      box.x >= 0 && box.y >= 0 && box.x + box.width <= 1440 && box.y + box.height <= 900 && box.width > 150,
      `${part}: ${JSON.stringify(box)}`,
    );
  }
  const look = () => dialog.evaluate((d) => [".pixel-title", ".light-space", ".section"].map((s) => d.querySelector(s).outerHTML));
  const canvas = await dialog.locator(".bias-picture canvas").boundingBox(),
    first = await look();
  await page.mouse.move(canvas.x + 0.3 * canvas.width, canvas.y + 0.7 * canvas.height);
  await page.mouse.down();
  await redrawn(page);
  const second = await look();
  await page.mouse.move(canvas.x + 0.6 * canvas.width, canvas.y + 0.8 * canvas.height);
  await redrawn(page);
  const third = await look(); // the button is still down
  await page.mouse.up();
  for (const k of [0, 1, 2]) assert.ok(first[k] !== second[k] && second[k] !== third[k], `part ${k} does not follow the dragged pixel`);
  await dialog.locator(".bias-bar input[type=range]").fill("700");
  await redrawn(page);
  const fourth = await look();
  for (const k of [1, 2]) assert.notEqual(fourth[k], third[k], `part ${k} does not follow the bias`);
  await dialog.locator("svg.section").evaluate((e) => e.closest(".scroll").focus());
  await page.keyboard.press("Shift+ArrowRight");
  await redrawn(page);
  assert.notEqual((await look())[0], fourth[0]);
  assert.deepEqual(await violations(page, {}, "dialog"), []);
  await page.keyboard.press("Escape");
  assert.equal(await dialog.isVisible(), false);
  // The browser tells of the closing in a task of its own. Asked from outside: the page's policy forbids strings as code.
  for (let i = 0; i < 100 && (await page.evaluate(places)) !== before; ++i) await redrawn(page);
  assert.equal(await page.evaluate(places), before);
  await close(page);
}

// So many pixels of one row that marks would hide each other: bars, split by what came out, that add up to the counts.
async function checkBins(page) {
  await page.getByRole("button", { name: "all", exact: true }).click();
  await redrawn(page);
  const { counts, areas } = await page.locator(".probe-section").evaluate((host) => ({
    counts: [...host.querySelectorAll(".key span")].map((e) => Number(e.textContent.split(": ")[1].replaceAll(",", ""))),
    areas: ["lit", "dark", "false", "missed"].map((outcome) => {
      const heights =
        host
          .querySelector(`.spot.${outcome}`)
          ?.getAttribute("d")
          .matchAll(/v([\d.]+)/g) ?? [];
      return [...heights].reduce((sum, [, h]) => sum + Number(h), 0);
    }),
  }));
  assert.ok(counts.reduce((a, b) => a + b) > 600, `only ${counts} marks`);
  assert.equal(await page.locator("svg.section .dot").count(), 0, "marks beside the bars");
  // An outcome has bars exactly where it has pixels, and those of wrong pixels are seen beside the right ones.
  counts.forEach((count, k) => assert.equal(areas[k] > 0, count > 0, `${count} pixels, bars ${areas[k]} high`));
}

// A page larger than allowed keeps pictures and pixels in files beside it, says so, and does all the same.
async function checkBeside() {
  const large = join(folder, "beside"),
    run = [
      program,
      [
        "compare",
        "sphere-plane",
        "--size",
        `${width}x${height}`,
        "--map-size",
        "64",
        "--runs",
        "1",
        "--bias",
        biases[0],
        "--report-max-mb",
        "0.1",
        "-o",
        large,
      ],
    ];
  const { stderr } = spawnSync(...run, { encoding: "utf8" });
  assert.match(stderr, /note: the page would weigh \d+ MB, more than --report-max-mb 0.1: its pictures and pixels are files/);
  // Templates, script and style weigh 0.18 MB, the result of one light 0.04, its tables 0.05, and words 0.03.
  assert.ok(!readFileSync(join(large, "report.html"), "utf8").includes("data:image/png"));
  assert.ok(statSync(join(large, "report.html")).size < 0.3e6);
  const page = await open(large, { beside: true }, "#light-0?pixel=100,80&exposure=1");
  assert.match(await page.locator(".beside").textContent(), /lie beside it/);
  for (const image of await page.locator("main img:visible").all()) await checkPicture(image);
  const single = await open(folderOf(biases[0]), {}, "#light-0?pixel=100,80&exposure=1");
  assert.deepEqual(await shown(page), await shown(single));
  assert.deepEqual(await canvasOf(page, 0), await canvasOf(single, 0));
  const { false_shadow, missed_shadow } = resultOf(biases[1]).error;
  assert.deepEqual(await countsAt(page, Number(biases[1])), { false_shadow, missed_shadow, orange: false_shadow, blue: missed_shadow });
  assert.ok(
    page.requests.some((url) => url.endsWith("report-data/light-0.js")),
    "no data file was asked for",
  );
  await close(page);
  await close(single);
  await checkAccessibility(large, { beside: true });
  // Without the scene's file all but the cross-section is there, and that says why.
  rmSync(join(large, "report-data", "geometry.js"));
  const lacking = await open(large, { beside: true }, "#light-0?pixel=100,80");
  await lacking.locator(".probe-section").getByText("The cross-section is missing").waitFor();
  assert.equal(await lacking.locator("svg.light-space").count(), 1);
  assert.deepEqual(
    lacking.offences.splice(0).filter((text) => !text.includes("ERR_FILE_NOT_FOUND")),
    [],
  );
  await close(lacking);
}

// A page with every pixel of a scene of 150 thousand triangles can be sent by mail: below 10 MB, with room
// for what the next key of the result takes. Its speed is printed, not judged: machines differ.
async function checkWeight() {
  const large = join(folder, "hd");
  execFileSync(program, ["compare", "fence", "--size", "1280x720", "--runs", "1", "--quiet", "-o", large], { stdio: "inherit" });
  const page = await open(large, {}, "#light-0?pixel=900,300"),
    said = await page.evaluate(async () => {
      const [paint] = performance.getEntriesByName("first-contentful-paint"),
        slider = document.querySelector(".bias-bar input[type=range]");
      const frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      const timed = async (act) => {
        await frame();
        const start = performance.now();
        act();
        await frame();
        return Math.round(performance.now() - start);
      };
      const exposure = document.querySelector(".exposure input");
      const bias = await timed(() => {
        slider.value = 300;
        slider.dispatchEvent(new Event("input"));
      });
      const stops = await timed(() => {
        exposure.value = 1;
        exposure.dispatchEvent(new Event("input"));
      });
      const stage = document.querySelector(".stage"),
        step = new KeyboardEvent("keydown", { key: "ArrowRight", shiftKey: true, bubbles: true });
      const pixel = await timed(() => stage.dispatchEvent(step));
      return { firstPaint: Math.round(paint?.startTime ?? NaN), bias, stops, pixel };
    });
  await checkBins(page);
  const weight = statSync(join(large, "report.html")).size / 1e6;
  assert.ok(weight < 9.95, `the page of fence weighs ${weight} MB`);
  console.log(
    `1280x720, ${weight.toFixed(1)} MB: first paint after ${said.firstPaint} ms; until the next frame but one, a dragged bias ${said.bias} ms, an exposure ${said.stops} ms, another pixel ${said.pixel} ms`,
  );
  await close(page);
}

try {
  await checkPresenter();
  await checkPresenterOnProjectors();
  await checkGlass();
  await checkUrl();
  await checkStageInWindow();
  await checkBeside();
  await checkPhone(folderOf(biases[0]));
  await checkAccessibility(folderOf(biases[0]));
  console.log("the URL restores the view; files beside the page, phone and accessibility are right");
  await checkWeight();
} finally {
  await browser.close();
}
