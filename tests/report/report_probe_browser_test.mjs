// The report page's numbers on a real comparison, in a real browser: every pixel's against the EXR file, the probe's words
// and ladder, the dragged bias against a fresh comparison at that bias, exposure, metrics.
// Needs what report_browser_test needs, OpenGL in software, and oiiotool. Usage: node report_probe_browser_test.mjs
// GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { biases, canvasOf, countsAt, folder, folderOf, height, redrawn, resultOf, shown, title, width } from "../browser/compared_page.mjs";
import { browser, close, open } from "../browser/open_page.mjs";

// The EXR's channels, read by another program; it prints nine decimals.
const rungs = ["truth", "point", "texel", "flat", "stored", "biased", "drawn"].map((name) => `${name}.V`);
const channels = ["class.V", "gap.V", "texel_uv.U", "texel_uv.V", "primitive.V", ...rungs];

function readAov(bias) {
  const few = join(folder, "few.exr");
  execFileSync("oiiotool", [join(folder, `bias-${bias}.exr`), "--ch", channels.join(","), "-o", few]);
  const text = execFileSync("oiiotool", ["--dumpdata", few], { encoding: "utf8", maxBuffer: 1 << 28 });
  const order = [...channels].sort(),
    places = channels.map((name) => order.indexOf(name)); // EXR files sort theirs
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
    const light = await gnomon.light(0),
      pixels = Array.from({ length: count }, (_, i) => light.pixel(i % 240, Math.floor(i / 240)));
    const numbers = pixels.flatMap(({ label, gap, at, primitive, rungs }) => [label, gap, at.u, at.v, primitive, ...rungs]);
    return { depthStep: light.json.depth_step, text: bytesAsText(Float64Array.from(numbers, (value) => value ?? NaN)) };
  }, aov.length);
  const numbers = new Float64Array(new Uint8Array(Buffer.from(light.text, "base64")).buffer);
  assert.equal(numbers.length, aov.length * channels.length);
  const used = Math.fround(Number(biases[0])),
    biasesOfCurve = resultOf(biases[0]).bias_curve.map(({ bias }) => Math.fround(bias));
  aov.forEach(([label, gap, u, v, primitive, ...ladder], i) => {
    const [labelHere, gapHere, uHere, vHere, primitiveHere, ...ladderHere] = numbers.subarray(
      i * channels.length,
      (i + 1) * channels.length,
    );
    assert.equal(labelHere, label, `label of pixel ${i}`);
    // Rounded to a step, and never past a bias of the curve. (1e-7: the dump's nine decimals.)
    assert.ok(
      gap === gapHere || Math.abs(gap - gapHere) <= light.depthStep + 1e-7 * Math.abs(gap),
      `gap of pixel ${i}: ${gapHere}, not ${gap}`,
    );
    for (const bias of [used, ...biasesOfCurve])
      if (Math.abs(gap - bias) > 1e-7 * Math.abs(gap) && gapHere > bias !== gap > bias)
        assert.fail(`gap ${gap} of pixel ${i}, kept as ${gapHere}, at the bias ${bias}`);
    if (label >= 0) {
      assert.equal(uHere, Math.floor(u * steps) / steps, `u of pixel ${i}`);
      assert.equal(vHere, Math.floor(v * steps) / steps, `v of pixel ${i}`);
      assert.equal(primitiveHere, primitive, `primitive of pixel ${i}`);
    }
    ladder.forEach((value, k) => assert.equal(ladderHere[k], value, `V${k} of pixel ${i}`));
  });
  return light.depthStep;
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
  aov.forEach(([label], i) => {
    examples.set(label, i);
  });
  assert.ok(examples.size >= 4, `only the labels ${[...examples.keys()]} occur`);
  for (const [label, i] of examples) {
    const page = await open(folderOf(biases[0]), {}, `#light-0?pixel=${i % width},${Math.floor(i / width)}`);
    const [, gap, u, v, primitive, ...ladder] = aov[i];
    assert.equal(await title(page), `Pixel ${i % width}, ${Math.floor(i / width)}: ${names.get(label)}`);
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
  const own = page.locator("svg.light-space .column.own"),
    caption = await page.locator(".probe-body figcaption").textContent();
  const texel = Number(/a texel is ([\d.e-]+) wide/.exec(caption)[1]),
    scale = Number(await own.getAttribute("width")) / texel;
  const [top, bottom] = (await page.locator(".gap-mark .bracket").getAttribute("d")).match(/[\d.]+(?=h8)/g).map(Number);
  const { gap } = await shown(page),
    ray = Math.abs(bottom - top) / scale;
  // The gap is measured along the ray, the drawing's depth along the face's axis: at most sqrt(3) apart on a cube face.
  assert.ok(ray <= gap * 1.03 && ray >= gap / 1.78, `the gap is drawn ${ray} long, and is ${gap}`);
}

async function checkBias(page) {
  const [used, other] = biases.map(resultOf),
    curve = used.bias_curve;
  const points = [
    ...curve.filter((_, i) => i % 16 === 0),
    { ...used.error, bias: Number(biases[0]) },
    { ...other.error, bias: Number(biases[1]) },
  ];
  for (const { bias, false_shadow, missed_shadow } of points)
    assert.deepEqual(
      await countsAt(page, bias),
      { false_shadow, missed_shadow, orange: false_shadow, blue: missed_shadow },
      `at a bias of ${bias}`,
    );
  assert.notDeepEqual(used.error.false_shadow, other.error.false_shadow, "the two biases cannot be told apart");
  await page.locator(".bias-bar input[type=range]").focus();
  const before = await page.locator(".bias-counts").textContent();
  for (let i = 0; i < 60; ++i) await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((text) => document.querySelector(".bias-counts").textContent !== text, before);
  const chart = page.locator("svg.chart.live"),
    box = await chart.boundingBox();
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

const srgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

// Exposure multiplies linear light: against the EXR file's own colours, to one level of 8 bits (the page keeps half a percent
// of a value, less than one level).
async function checkExposure(page) {
  const text =
    execFileSync("oiiotool", [join(folder, `bias-${biases[0]}.exr`), "--ch", "R,G,B", "-o", join(folder, "rgb.exr")]) &&
    execFileSync("oiiotool", ["--dumpdata", join(folder, "rgb.exr")], { encoding: "utf8", maxBuffer: 1 << 28 });
  const linear = [...text.matchAll(/Pixel \((\d+), (\d+)\): (.*)/g)].map(([, , , values]) =>
    values.trim().split(/\s+/).map(Number).reverse(),
  );
  const blueFirst = /channel list: B, G, R/.test(execFileSync("oiiotool", ["-v", "--info", join(folder, "rgb.exr")], { encoding: "utf8" }));
  const { exposure } = JSON.parse(readFileSync(join(folderOf(biases[0]), "result.json"), "utf8"));
  for (const stops of [0, 2, -3]) {
    await page.locator(".exposure input").fill(String(stops));
    await redrawn(page);
    const shown = await canvasOf(page, 1); // ray traced
    let worst = 0;
    linear.forEach((values, i) =>
      (blueFirst ? values : [...values].reverse()).forEach((v, k) => {
        const expected = Math.floor(255 * srgb(Math.min(v * exposure * 2 ** stops, 1)) + 0.5);
        worst = Math.max(worst, Math.abs(expected - shown[4 * i + k]));
      }),
    );
    assert.ok(worst <= 1, `at ${stops} stops a pixel is off by ${worst} levels`);
  }
  await page.locator(".exposure input").fill("0");
}

// Maps of the metrics: their means are those of result.json, to the step that they are kept in.
async function checkMetrics(page) {
  const { error } = resultOf(biases[0]);
  const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
  const maps = await page.evaluate(async () => {
    const { flip, ssim } = await gnomon.light(0);
    return [[...flip], [...ssim]];
  });
  const flip = maps[0].map((v) => v / 100),
    ssim = maps[1].filter((v) => v !== -128).map((v) => v / 100);
  assert.equal(ssim.length, (width - 10) * (height - 10));
  assert.ok(Math.abs(mean(flip) - error.flip) < 0.5 / 100, `FLIP ${mean(flip)}, not ${error.flip}`);
  assert.ok(Math.abs(mean(ssim) - error.ssim) < 0.5 / 100, `SSIM ${mean(ssim)}, not ${error.ssim}`);
  for (const name of ["absolute error", "FLIP", "1 − SSIM", "truth", "drawn", "gap"]) {
    await page.locator(".pick").first().selectOption({ label: name });
    await redrawn(page);
    assert.match(await page.locator(".legends").textContent(), new RegExp(name.replace("|", ".")), `the scale of ${name}`);
    const picture = await canvasOf(page, 0);
    assert.ok(
      picture.some((v, i) => i % 4 !== 3 && v !== picture[i % 4]),
      `${name} is one colour`,
    );
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
  const stage = page.locator(".stage"),
    box = await stage.boundingBox();
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

try {
  const aov = readAov(biases[0]),
    page = await open(folderOf(biases[0]));
  const depthStep = await checkData(page, aov);
  console.log(`${aov.length} pixels carry the numbers of the EXR file`);
  // One that sees exactly half the light is in neither shadow, whatever the bias.
  assert.deepEqual(
    await page.evaluate(async () => {
      const light = await gnomon.light(0),
        { visibility_steps: steps } = JSON.parse(document.getElementById("page-data").textContent);
      const wrongWith = (share) => {
        light.truth[0] = share * steps;
        return [-1e9, 1e9].map((bias) => light.wrongAt(0, bias));
      };
      light.gap[0] = 0;
      return [0, 0.5, 1].map(wrongWith);
    }),
    [
      [0, 1],
      [0, 0],
      [-1, 0],
    ],
  );
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
} finally {
  await browser.close();
}
