// The report page's live parts on a real comparison, in a real browser: every pixel's numbers against the EXR file, the
// probe's words and ladder, the dragged bias against a fresh comparison at that bias, views that the URL restores.
// Needs what report_browser_test needs, OpenGL in software, and oiiotool. Usage: node report_probe_browser_test.mjs
// GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import { browser, checkAccessibility, checkPhone, checkPicture, close, open, pixelsOf, violations } from "./browser/open_page.mjs";

const [program, folder] = process.argv.slice(2);
const width = 240, height = 136, biases = ["0.02", "0.3"];
const folderOf = (bias) => join(folder, `bias-${bias}`);
mkdirSync(folder, { recursive: true });
for (const bias of biases)
  execFileSync(program, ["compare", "sphere-plane", "--size", `${width}x${height}`, "--map-size", "64", "--runs", "1", "--bias", bias,
    "--quiet", "-o", folderOf(bias), "--aov", join(folder, `bias-${bias}.exr`)], { stdio: "inherit" });
const resultOf = (bias) => JSON.parse(readFileSync(join(folderOf(bias), "result.json"), "utf8")).lights[0];

// The EXR's channels, read by another program; it prints nine decimals.
const rungs = ["truth", "point", "texel", "flat", "stored", "biased", "drawn"].map((name) => `${name}.V`);
const channels = ["class.V", "gap.V", "texel_uv.U", "texel_uv.V", "primitive.V", ...rungs];
function readAov(bias) {
  const few = join(folder, "few.exr");
  execFileSync("oiiotool", [join(folder, `bias-${bias}.exr`), "--ch", channels.join(","), "-o", few]);
  const text = execFileSync("oiiotool", ["--dumpdata", few], { encoding: "utf8", maxBuffer: 1 << 28 });
  const order = [...channels].sort(), places = channels.map((name) => order.indexOf(name));  // EXR files sort theirs
  const pixels = [];
  for (const [, x, y, values] of text.matchAll(/Pixel \((\d+), (\d+)\): (.*)/g))
    pixels[Number(y) * width + Number(x)] = places.map((place) => Number(values.trim().split(/\s+/)[place]));
  assert.equal(pixels.length, width * height);
  return pixels;
}

// Every pixel's numbers as the page unpacks them, against the EXR file's.
async function checkData(page, aov) {
  const { position_steps: steps } = JSON.parse(await page.locator("#page-data").textContent());
  const light = await page.evaluate(async (count) => {
    const light = await gnomon.light(0), pixels = Array.from({ length: count }, (_, i) => light.pixel(i % 240, Math.floor(i / 240)));
    const numbers = pixels.flatMap(({ label, gap, at, primitive, rungs }) => [label, gap, at.u, at.v, primitive, ...rungs]);
    return { depthStep: light.json.depth_step, text: bytesAsText(Float64Array.from(numbers, (value) => value ?? NaN)) };
  }, aov.length);
  const numbers = new Float64Array(new Uint8Array(Buffer.from(light.text, "base64")).buffer);
  assert.equal(numbers.length, aov.length * channels.length);
  const used = Math.fround(Number(biases[0])), biasesOfCurve = resultOf(biases[0]).bias_curve.map(({ bias }) => Math.fround(bias));
  aov.forEach(([label, gap, u, v, primitive, ...ladder], i) => {
    const [labelHere, gapHere, uHere, vHere, primitiveHere, ...ladderHere] = numbers.subarray(i * channels.length, (i + 1) * channels.length);
    assert.equal(labelHere, label, `label of pixel ${i}`);
    // Rounded to a step, and never past a bias of the curve. (1e-7: the dump's nine decimals.)
    assert.ok(gap === gapHere || Math.abs(gap - gapHere) <= light.depthStep + 1e-7 * Math.abs(gap), `gap of pixel ${i}: ${gapHere}, not ${gap}`);
    for (const bias of [used, ...biasesOfCurve])
      if (Math.abs(gap - bias) > 1e-7 * Math.abs(gap) && gapHere > bias !== gap > bias) assert.fail(`gap ${gap} of pixel ${i}, kept as ${gapHere}, at the bias ${bias}`);
    if (label >= 0) {
      assert.equal(uHere, Math.floor(u * steps) / steps, `u of pixel ${i}`);
      assert.equal(vHere, Math.floor(v * steps) / steps, `v of pixel ${i}`);
      assert.equal(primitiveHere, primitive, `primitive of pixel ${i}`);
    }
    ladder.forEach((value, k) => assert.equal(ladderHere[k], value, `V${k} of pixel ${i}`));
  });
  return light.depthStep;
}

const number = (text) => Number(text.replaceAll("\u2212", "-").replaceAll("∞", "Infinity"));
const title = async (page) => (await page.locator(".pixel-title").textContent()).trim();
async function shown(page) {
  const text = (selector) => page.locator(selector).textContent();
  const ladder = await page.locator(".pixel-ladder tbody tr td:nth-child(2)").allTextContents();
  return {
    story: await text(".story"), ladder: ladder.map(number),
    gap: number((await text("[data-fact=gap]")).split(" ")[0]), texel: (await text("[data-fact=texel]")).split(" u")[0].split(", ").map(Number),
    primitive: Number(await text("[data-fact=primitive]")),
  };
}

// The ring in the depth map's picture: six faces of 64 texels with a gap of one, rows upwards.
async function checkMarker(page, pixel, u, v) {
  const face = await page.evaluate(async (i) => (await gnomon.light(0)).face(i), pixel);
  const [left, top] = await page.locator(".map-marker").evaluate((e) => [e.style.left, e.style.top].map(parseFloat));
  assert.ok(Math.abs(left - (100 * ((face % 3) * 65 + u)) / 194) < 0.01, `marker at ${left} % from the left, face ${face}, u ${u}`);
  assert.ok(Math.abs(top - (100 * ((face > 2 ? 65 : 0) + 64 - v)) / 129) < 0.01, `marker at ${top} % from the top, face ${face}, v ${v}`);
}

// One pixel of every label that occurs, those of pixels not compared among them, chosen by the URL.
async function checkProbe(aov, names, depthStep) {
  const examples = new Map();
  aov.forEach(([label], i) => { examples.set(label, i); });
  assert.ok(examples.size >= 4, `only the labels ${[...examples.keys()]} occur`);
  for (const [label, i] of examples) {
    const page = await open(folderOf(biases[0]), {}, `#light-0?pixel=${i % width},${Math.floor(i / width)}`);
    const [, gap, u, v, primitive, ...ladder] = aov[i];
    assert.equal((await title(page)), `Pixel ${i % width}, ${Math.floor(i / width)}: ${names.get(label)}`);
    if (label < 0) {
      assert.match(await page.locator(".story").textContent(), /^Not compared: /);
      await close(page);
      continue;
    }
    const said = await shown(page);
    assert.deepEqual(said.ladder, ladder);
    assert.ok(said.gap === gap || Math.abs(said.gap - gap) <= 1e-5 * Math.abs(gap) + depthStep, `gap ${said.gap}, not ${gap}`);
    assert.ok(Math.abs(said.texel[0] - u) < 0.005 && Math.abs(said.texel[1] - v) < 0.005, `texel ${said.texel}, not ${u}, ${v}`);
    assert.equal(said.primitive, primitive);
    assert.match(said.story, ladder[0] === 1 ? /exact ray says: lit/ : /exact ray says: in shadow/);
    assert.match(said.story, ladder[6] === 1 ? /lit at the bias|draws it lit|lets it be lit/ : /draws it in shadow/);
    await checkMarker(page, i, u, v);
    const deciding = await page.locator(".pixel-ladder .deciding").count();
    assert.equal(deciding, label > 0 ? 1 : 0);
    assert.equal(await page.locator("svg.light-space").count(), 1);
    assert.equal(await page.locator("svg.section .profile").count(), 1);
    await close(page);
  }
  return examples.size;
}

async function checkDrawing(page) {
  // Texels are as wide as the caption says, in the drawing's one scale for width and depth.
  const own = page.locator("svg.light-space .column.own"), caption = await page.locator(".probe-body figcaption").textContent();
  const texel = Number(/a texel is ([\d.e-]+) wide/.exec(caption)[1]), scale = Number(await own.getAttribute("width")) / texel;
  const [top, bottom] = (await page.locator(".gap-mark .bracket").getAttribute("d")).match(/[\d.]+(?=h8)/g).map(Number);
  const { gap } = await shown(page), ray = Math.abs(bottom - top) / scale;
  // The gap is measured along the ray, the drawing's depth along the face's axis: at most sqrt(3) apart on a cube face.
  assert.ok(ray <= gap * 1.03 && ray >= gap / 1.78, `the gap is drawn ${ray} long, and is ${gap}`);
}

// A slope bias and a constant: both parts are named, and their sum.
// In the same scene, glass and a mirror: the pictures' remarks, a probe that tells of the surface and not of a pixel in
// shadow, and what the map takes for opaque.
async function checkGlass() {
  const glass = join(folder, "glass"), size = { width: 240, height: 136 };
  execFileSync(program, ["compare", "whitted", "--size", `${size.width}x${size.height}`, "--map-size", "256", "--runs", "1", "--quiet", "-o", glass], { stdio: "inherit" });
  const page = await open(glass);
  assert.match(await page.locator("#overview .remark").first().textContent(), /Drawn plainly: .* matte grey/);
  const found = await page.evaluate(async () => {
    const light = await gnomon.light(0), kinds = {};
    for (let i = 0; i < light.label.length; ++i) {
      const pixel = light.pixel(i % 240, Math.floor(i / 240));
      if (pixel.label < 0 || !Number.isFinite(pixel.gap)) continue;
      const kind = pixel.material ? `${pixel.material.name} ${pixel.rungs[0]}` : pixel.storedGlass ? `floor ${pixel.rungs[0]}` : "";
      if (pixel.rungs[0] === pixel.rungs[6]) kinds[kind] ??= [pixel.x, pixel.y];
    }
    return kinds;
  });
  const said = { "glass 1": /glass \(material “glass”\)[\s\S]*matte grey[\s\S]*opaque/, "mirror 1": /a mirror \(material “mirror”\)/, "mirror 0": /a mirror/,
    "floor 0": /holds glass \(material “glass”\)[\s\S]*bright/ };
  for (const [kind, expected] of Object.entries(said)) {
    const at = await open(glass, {}, `#light-0?pixel=${found[kind]}`), story = await at.locator(".story").textContent();
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

async function countsAt(page, bias) {
  await page.locator(".bias-bar input[type=number]").fill(String(bias));
  await page.keyboard.press("Enter");
  await page.waitForFunction((b) => document.querySelector(".bias-counts").textContent.startsWith("At a bias of")
    && Number(document.querySelector(".bias-bar input[type=number]").value) === b, bias);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator(".bias-live").evaluate((live) => {
    const { falseShadow, missedShadow } = live.querySelector(".bias-counts").dataset, canvas = live.querySelector("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let orange = 0, blue = 0;
    for (let i = 0; i < data.length; i += 4) {
      orange += data[i] === 213 && data[i + 1] === 94 && data[i + 2] === 0;
      blue += data[i] === 86 && data[i + 1] === 180 && data[i + 2] === 233;
    }
    return { false_shadow: Number(falseShadow), missed_shadow: Number(missedShadow), orange, blue };
  });
}

async function checkBias(page) {
  const [used, other] = biases.map(resultOf), curve = used.bias_curve;
  const points = [...curve.filter((_, i) => i % 16 === 0), { ...used.error, bias: Number(biases[0]) }, { ...other.error, bias: Number(biases[1]) }];
  for (const { bias, false_shadow, missed_shadow } of points)
    assert.deepEqual(await countsAt(page, bias), { false_shadow, missed_shadow, orange: false_shadow, blue: missed_shadow }, `at a bias of ${bias}`);
  assert.notDeepEqual(used.error.false_shadow, other.error.false_shadow, "the two biases cannot be told apart");
  await page.locator(".bias-bar input[type=range]").focus();
  const before = await page.locator(".bias-counts").textContent();
  for (let i = 0; i < 60; ++i) await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((text) => document.querySelector(".bias-counts").textContent !== text, before);
  const chart = page.locator("svg.chart.live"), box = await chart.boundingBox();
  const dragged = await page.locator(".bias-counts").textContent();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.mouse.up();
  await page.waitForFunction((text) => document.querySelector(".bias-counts").textContent !== text, dragged);
  await page.getByRole("button", { name: "as rendered" }).click();
  await page.waitForFunction((b) => Number(document.querySelector(".bias-bar input[type=number]").value) === b, Number(biases[0]));
  return points.length;
}

// What a reader sets, another reader of the same link sees.
async function checkUrl() {
  const first = await open(folderOf(biases[0])), stage = first.locator(".stage");
  await stage.focus();
  for (const key of ["f", "+", "+", "ArrowRight", "Shift+ArrowDown"]) await first.keyboard.press(key);
  await first.locator(".pick").first().selectOption({ label: "labels" });
  await first.locator(".pick").last().selectOption({ label: "gap" });
  await first.locator(".exposure input").fill("1.5");
  await first.getByRole("button", { name: "column" }).click();
  await countsAt(first, 0.125);
  await first.waitForFunction(() => location.hash.includes("bias=0.125"));
  const view = (page) => page.evaluate(() => ({
    mode: document.querySelector(".stage").dataset.mode, zoom: document.querySelector(".zoom-value").textContent,
    moved: [...document.querySelectorAll(".stage img, .stage canvas")].map((e) => e.style.transform),
    pictures: [...document.querySelectorAll(".tag")].map((e) => e.textContent), title: document.querySelector(".pixel-title").textContent,
    story: document.querySelector(".story").textContent, counts: document.querySelector(".bias-counts").textContent,
    cut: document.querySelector("[data-cut][aria-pressed=true]").textContent, exposure: document.querySelector(".exposure input").value,
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
  const marker = await outside.locator(".pane .marker").first().evaluate((e) => [e.style.left, e.style.top].map(parseFloat));
  assert.deepEqual(marker.map((at) => Math.round(at)), [width - 1, height - 1].map((at, k) => Math.round((100 * at) / [width, height][k])));
  await close(outside);
}

// On the usual projectors the whole ladder is seen, and what is written in the drawings can be read.
async function checkPresenterOnProjectors() {
  for (const [w, h] of [[1280, 720], [1024, 768]]) {
    const page = await open(folderOf(biases[1]), { viewport: { width: w, height: h } }, "#light-0?pixel=100,80");
    await page.getByRole("button", { name: "Present" }).click();
    await redrawn(page);
    for (const rung of await page.locator("dialog.presenter .pixel-ladder tbody tr").all()) {
      const box = await rung.boundingBox();
      assert.ok(box.y > 0 && box.y + box.height <= h && box.x + box.width <= w, `${w}: ${await rung.textContent()} at ${JSON.stringify(box)}`);
    }
    for (const drawing of ["svg.light-space", "svg.section"]) {
      const pixels = await page.locator(`dialog.presenter ${drawing}`).evaluate((svg) =>
        svg.getScreenCTM().a * parseFloat(getComputedStyle(svg.querySelector("text")).fontSize));
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

const canvasOf = (page, pane) => pixelsOf(page.locator(".pane canvas").nth(pane));
const redrawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

const srgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

// Exposure multiplies linear light: against the EXR file's own colours, to one level of 8 bits (the page keeps half a percent
// of a value, less than one level).
async function checkExposure(page) {
  const text = execFileSync("oiiotool", [join(folder, `bias-${biases[0]}.exr`), "--ch", "R,G,B", "-o", join(folder, "rgb.exr")]) &&
    execFileSync("oiiotool", ["--dumpdata", join(folder, "rgb.exr")], { encoding: "utf8", maxBuffer: 1 << 28 });
  const linear = [...text.matchAll(/Pixel \((\d+), (\d+)\): (.*)/g)].map(([, , , values]) => values.trim().split(/\s+/).map(Number).reverse());
  const blueFirst = /channel list: B, G, R/.test(execFileSync("oiiotool", ["-v", "--info", join(folder, "rgb.exr")], { encoding: "utf8" }));
  const { exposure } = JSON.parse(readFileSync(join(folderOf(biases[0]), "result.json"), "utf8"));
  for (const stops of [0, 2, -3]) {
    await page.locator(".exposure input").fill(String(stops));
    await redrawn(page);
    const shown = await canvasOf(page, 1);  // ray traced
    let worst = 0;
    linear.forEach((values, i) => (blueFirst ? values : [...values].reverse()).forEach((v, k) => {
      const expected = Math.floor(255 * srgb(Math.min(v * exposure * 2 ** stops, 1)) + 0.5);
      worst = Math.max(worst, Math.abs(expected - shown[4 * i + k]));
    }));
    assert.ok(worst <= 1, `at ${stops} stops a pixel is off by ${worst} levels`);
  }
  await page.locator(".exposure input").fill("0");
}

// Maps of the metrics: their means are those of result.json, to the step that they are kept in.
async function checkMetrics(page) {
  const { error } = resultOf(biases[0]);
  const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
  const maps = await page.evaluate(async () => { const { flip, ssim } = await gnomon.light(0); return [[...flip], [...ssim]]; });
  const flip = maps[0].map((v) => v / 100), ssim = maps[1].filter((v) => v !== -128).map((v) => v / 100);
  assert.equal(ssim.length, (width - 10) * (height - 10));
  assert.ok(Math.abs(mean(flip) - error.flip) < 0.5 / 100, `FLIP ${mean(flip)}, not ${error.flip}`);
  assert.ok(Math.abs(mean(ssim) - error.ssim) < 0.5 / 100, `SSIM ${mean(ssim)}, not ${error.ssim}`);
  for (const name of ["absolute error", "FLIP", "1 − SSIM", "truth", "drawn", "gap"]) {
    await page.locator(".pick").first().selectOption({ label: name });
    await redrawn(page);
    assert.match(await page.locator(".legends").textContent(), new RegExp(name.replace("|", ".")), `the scale of ${name}`);
    const picture = await canvasOf(page, 0);
    assert.ok(picture.some((v, i) => i % 4 !== 3 && v !== picture[i % 4]), `${name} is one colour`);
    if (name === "absolute error") {
      // Hard shadows: wrong pixels are magma's 1, right ones its 0.
      const wrong = picture.reduce((n, v, i) => n + (i % 4 === 0 && v === 252 && picture[i + 1] === 253 && picture[i + 2] === 191), 0);
      assert.equal(wrong, error.wrong);
    }
  }
  await page.locator(".pick").first().selectOption({ label: "rasterized" });
}

async function checkLessons(page) {
  const lessons = page.locator("details.lesson");
  assert.ok((await lessons.count()) >= 3);
  await lessons.first().locator("summary").click();
  assert.match(await lessons.first().textContent(), /^Lesson: [A-Z][\s\S]*docs\/lessons\/[a-z-]+\.md/);
}

async function checkControls(page) {
  await page.getByRole("button", { name: "Copy the command" }).click();
  await page.getByRole("button", { name: "Copied" }).waitFor();
  const stage = page.locator(".stage"), box = await stage.boundingBox();
  await stage.click({ position: { x: (100.5 / width) * box.width, y: (80.5 / height) * box.height } });
  await page.waitForFunction(() => document.querySelector(".pixel-title").textContent.trim().startsWith("Pixel 100, 80:"));
  await stage.click({ button: "right", position: { x: (50.5 / width) * box.width, y: (40.5 / height) * box.height } });
  await redrawn(page);
  assert.match(await title(page), /^Pixel 100, 80:/, "a click for the menu pins a pixel");
  await page.locator(".exposure input").fill("1");
  await redrawn(page);
  assert.equal(await page.locator(".exposure input").getAttribute("aria-valuetext"), "1 stop");
  await page.locator(".exposure input").fill("0");
  await page.locator(".stage").focus();
  await page.keyboard.press("Escape");
  await page.locator(".marker").first().waitFor({ state: "hidden" });
}

// Picture, pixel drawing, cross-section and bias on one screen of 1440 x 900; what one shows follows what is dragged in
// another. Closed, all is back in its place.
async function checkPresenter() {
  const page = await open(folderOf(biases[0]), {}, "#light-0?pixel=100,80"), dialog = page.locator("dialog.presenter");
  const places = () => JSON.stringify([...document.querySelectorAll(".bias-live, .pixel-probe")].map((e) => e.textContent.length > 40));
  const before = await page.evaluate(places);
  await page.getByRole("button", { name: "Present" }).click();
  for (const part of [".bias-picture canvas", "svg.light-space", "svg.section", ".bias-bar input[type=range]", ".story"]) {
    const box = await dialog.locator(part).boundingBox();
    assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= 1440 && box.y + box.height <= 900 && box.width > 150, `${part}: ${JSON.stringify(box)}`);
  }
  const look = () => dialog.evaluate((d) => [".pixel-title", ".light-space", ".section"].map((s) => d.querySelector(s).outerHTML));
  const canvas = await dialog.locator(".bias-picture canvas").boundingBox(), first = await look();
  await page.mouse.move(canvas.x + 0.3 * canvas.width, canvas.y + 0.7 * canvas.height);
  await page.mouse.down();
  await redrawn(page);
  const second = await look();
  await page.mouse.move(canvas.x + 0.6 * canvas.width, canvas.y + 0.8 * canvas.height);
  await redrawn(page);
  const third = await look();  // the button is still down
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
  for (let i = 0; i < 100 && await page.evaluate(places) !== before; ++i) await redrawn(page);
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
      const heights = host.querySelector(`.spot.${outcome}`)?.getAttribute("d").matchAll(/v([\d.]+)/g) ?? [];
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
  const large = join(folder, "beside"), run = [program, ["compare", "sphere-plane", "--size", `${width}x${height}`, "--map-size", "64", "--runs", "1",
    "--bias", biases[0], "--report-max-mb", "0.1", "-o", large]];
  const { stderr } = spawnSync(...run, { encoding: "utf8" });
  assert.match(stderr, /note: the page would weigh \d+ MB, more than --report-max-mb 0.1: its pictures and pixels are files/);
  // Script and style weigh 0.09 MB, the result of one light 0.04, the page's text 0.05, and the words of the probe 0.01.
  assert.ok(statSync(join(large, "report.html")).size < 0.2e6);
  const page = await open(large, { beside: true }, "#light-0?pixel=100,80&exposure=1");
  assert.match(await page.locator(".beside").textContent(), /lie beside it/);
  for (const image of await page.locator("main img:visible").all()) await checkPicture(image);
  const single = await open(folderOf(biases[0]), {}, "#light-0?pixel=100,80&exposure=1");
  assert.deepEqual(await shown(page), await shown(single));
  assert.deepEqual(await canvasOf(page, 0), await canvasOf(single, 0));
  const { false_shadow, missed_shadow } = resultOf(biases[1]).error;
  assert.deepEqual(await countsAt(page, Number(biases[1])), { false_shadow, missed_shadow, orange: false_shadow, blue: missed_shadow });
  assert.ok(page.requests.some((url) => url.endsWith("report-data/light-0.js")), "no data file was asked for");
  await close(page);
  await close(single);
  await checkAccessibility(large, { beside: true });
  // Without the scene's file all but the cross-section is there, and that says why.
  rmSync(join(large, "report-data", "geometry.js"));
  const lacking = await open(large, { beside: true }, "#light-0?pixel=100,80");
  await lacking.locator(".probe-section").getByText("The cross-section is missing").waitFor();
  assert.equal(await lacking.locator("svg.light-space").count(), 1);
  assert.deepEqual(lacking.offences.splice(0).filter((text) => !text.includes("ERR_FILE_NOT_FOUND")), []);
  await close(lacking);
}

// A page with every pixel of a scene of 150 thousand triangles can be sent by mail: below 10 MB. Its speed is printed, not
// judged: machines differ.
async function checkWeight() {
  const large = join(folder, "hd");
  execFileSync(program, ["compare", "fence", "--size", "1280x720", "--runs", "1", "--quiet", "-o", large], { stdio: "inherit" });
  const page = await open(large, {}, "#light-0?pixel=900,300"), said = await page.evaluate(async () => {
    const [paint] = performance.getEntriesByName("first-contentful-paint"), slider = document.querySelector(".bias-bar input[type=range]");
    const frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const timed = async (act) => {
      await frame();
      const start = performance.now();
      act();
      await frame();
      return Math.round(performance.now() - start);
    };
    const exposure = document.querySelector(".exposure input");
    const bias = await timed(() => { slider.value = 300; slider.dispatchEvent(new Event("input")); });
    const stops = await timed(() => { exposure.value = 1; exposure.dispatchEvent(new Event("input")); });
    const stage = document.querySelector(".stage"), step = new KeyboardEvent("keydown", { key: "ArrowRight", shiftKey: true, bubbles: true });
    const pixel = await timed(() => stage.dispatchEvent(step));
    return { firstPaint: Math.round(paint?.startTime ?? NaN), bias, stops, pixel };
  });
  await checkBins(page);
  const weight = statSync(join(large, "report.html")).size / 1e6;
  assert.ok(weight < 10, `the page of fence weighs ${weight} MB`);
  console.log(`1280x720, ${weight.toFixed(1)} MB: first paint after ${said.firstPaint} ms; until the next frame but one, a dragged bias ${said.bias} ms, an exposure ${said.stops} ms, another pixel ${said.pixel} ms`);
  await close(page);
}

try {
  const aov = readAov(biases[0]), page = await open(folderOf(biases[0]));
  const depthStep = await checkData(page, aov);
  console.log(`${aov.length} pixels carry the numbers of the EXR file`);
  // One that sees exactly half the light is in neither shadow, whatever the bias.
  assert.deepEqual(await page.evaluate(async () => {
    const light = await gnomon.light(0), { visibility_steps: steps } = JSON.parse(document.getElementById("page-data").textContent);
    const wrongWith = (share) => { light.truth[0] = share * steps; return [-1e9, 1e9].map((bias) => light.wrongAt(0, bias)); };
    light.gap[0] = 0;
    return [0, 0.5, 1].map(wrongWith);
  }), [[0, 1], [0, 0], [-1, 0]]);
  const names = new Map(JSON.parse(await page.locator("#page-data").textContent()).labels.map(({ value, name }) => [value, name]));
  console.log(`${await checkProbe(aov, names, depthStep)} labels probed`);
  await checkDrawing(page);
  console.log(`${await checkBias(page)} biases counted and coloured as by a fresh comparison`);
  await checkExposure(page);
  await checkMetrics(page);
  await checkLessons(page);
  await checkControls(page);
  assert.deepEqual([...new Set(page.requests.filter((url) => !url.startsWith("data:")))].length, 1);
  await close(page);
  await checkPresenter();
  await checkPresenterOnProjectors();
  await checkGlass();
  await checkUrl();
  await checkStageInWindow();
  await checkBeside();
  await checkPhone(folderOf(biases[0]));
  await checkAccessibility(folderOf(biases[0]));
  console.log("the URL restores the view; controls, files beside the page, phone and accessibility are right");
  await checkWeight();
} finally {
  await browser.close();
}
