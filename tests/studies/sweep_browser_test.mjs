// The pages of a sweep and of the tuner in a real browser, made by the program itself: the grid by any two parameters,
// every cell's pictures against sweep.jsonl, sorting, commands, charts, the URL; one file and files beside it.
// Needs what report_probe_browser_test needs. Usage: node sweep_browser_test.mjs GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { browser, checkAccessibility, checkPhone, checkPicture, close, open, pixelsOf } from "../browser/open_page.mjs";

const [program, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const swept = join(folder, "swept"),
  beside = join(folder, "beside"),
  tuned = join(folder, "tuned");
const sweep = (out, more = []) =>
  spawnSync(
    program,
    [
      "sweep",
      "floating-box",
      "--size",
      "160x90",
      "--map-size",
      "32,64,128",
      "--slope-bias",
      "0,1",
      "--bias",
      "0,0.05,0.4",
      "-o",
      out,
      ...more,
    ],
    { encoding: "utf8" },
  );
const results = () =>
  readFileSync(join(swept, "sweep.jsonl"), "utf8")
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));

const settled = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
async function opened(page, cell) {
  const title = page.locator("#cell h2");
  await page
    .waitForFunction((n) => document.querySelector("#cell h2").textContent.startsWith(`Cell ${n}:`), cell)
    .catch(async (error) =>
      assert.fail(
        `cell ${cell} does not open: "${await title.textContent()}", ${page.url().split("#")[1]}, ${page.offences}, ${error.message}`,
      ),
    );
  await settled(page);
}
const canvasOf = (page, pane) => pixelsOf(page.locator("#cell .pane canvas").nth(pane));

function countColour(pixels, [r, g, b]) {
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) count += pixels[i] === r && pixels[i + 1] === g && pixels[i + 2] === b;
  return count;
}
const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

// The label picture of every cell holds as many pixels of each label as sweep.jsonl says, and the picture of differences as
// many false and missed shadows.
async function checkCells(page) {
  const all = results(),
    words = JSON.parse(await page.locator("#page-data").textContent()).labels;
  const colours = new Map(words.map(({ name, colour }) => [name, rgb(colour)]));
  const named = {
    peter_panning: "peter-panning",
    light_leak: "light leak",
    missed_feature: "missed feature",
    false_feature: "false feature",
    light_size: "light size",
    outside_map: "outside the map",
    custom_shader: "custom shader",
  };
  for (const [
    cell,
    {
      lights: [light],
      command,
      axes,
    },
  ] of all.entries()) {
    await page.locator(`.cells a[href='#cell-${cell}']`).click();
    await opened(page, cell);
    await page.locator("#cell .pick").first().selectOption({ label: "labels" });
    await page.locator("#cell .pick").last().selectOption({ label: "difference" });
    await settled(page);
    const labels = await canvasOf(page, 0),
      difference = await canvasOf(page, 1);
    for (const [name, count] of Object.entries(light.classes))
      assert.equal(countColour(labels, colours.get(named[name] ?? name.replaceAll("_", " "))), count, `${name} in cell ${cell}`);
    assert.equal(countColour(difference, [213, 94, 0]), light.error.false_shadow, `false shadow in cell ${cell}`);
    assert.equal(countColour(difference, [86, 180, 233]), light.error.missed_shadow, `missed shadow in cell ${cell}`);
    assert.equal(await page.locator(".cell-command").textContent(), command);
    const title = await page.locator("#cell h2").textContent();
    for (const [axis, value] of Object.entries(axes))
      assert.ok(title.includes(`${axis.replaceAll("_", " ")} ${value}`), `${title} lacks ${axis} ${value}`);
  }
  return all.length;
}

async function checkGrid(page) {
  const grid = page.locator("#grids table.grid"),
    bar = page.locator(".grid-bar"),
    all = results();
  const pick = (label, value) => bar.getByLabel(label, { exact: true }).selectOption(value);
  await pick("Rows", "bias");
  await pick("Columns", "map_size");
  assert.deepEqual(await grid.locator("thead th").allTextContents(), ["32", "64", "128"]);
  assert.deepEqual(await grid.locator("tbody th").allTextContents(), ["0", "0.05", "0.4"]);
  const slope = bar.getByLabel("slope bias", { exact: true });
  await slope.focus();
  await pick("slope bias", "1");
  assert.equal(await slope.evaluate((e) => e === document.activeElement), true, "the keyboard has left the list that it used");
  // Each place of the grid shows the cell of its row, its column and the slice.
  for (const link of await grid.locator("a").all()) {
    const cell = Number((await link.getAttribute("href")).slice(6));
    const [row, column] = await link.evaluate((a) => [
      a.closest("tr").querySelector("th").textContent,
      a.closest("table").tHead.rows[0].cells[a.closest("td").cellIndex].textContent,
    ]);
    assert.deepEqual([all[cell].axes.bias, all[cell].axes.map_size, all[cell].axes.slope_bias].map(String), [row, column, "1"]);
    await checkPicture(link.locator("img"));
  }
  const link = grid.locator("a").nth(4),
    number = Number((await link.getAttribute("href")).slice(6));
  await link.click();
  await opened(page, number);
  assert.equal(await link.getAttribute("aria-current"), "true");
  await page.getByRole("button", { name: "Keep for comparison" }).click();
  await page.getByRole("button", { name: "Next cell" }).click();
  await opened(page, number + 1);
  await page
    .locator("#cell .pick")
    .last()
    .selectOption({ label: `cell ${number}: labels` });
  assert.equal(await page.locator("#cell .tag").last().textContent(), `cell ${number}: labels`);
  await page.waitForFunction((n) => location.hash.includes(`held=${n}`) && location.hash.includes("right=cell"), number);
  const again = await open(swept, {}, new URL(page.url()).hash);
  await opened(again, number + 1);
  assert.equal(await again.locator("#cell .tag").last().textContent(), `cell ${number}: labels`);
  assert.equal(await again.getByRole("button", { name: `Kept: cell ${number}` }).count(), 1);
  // A link without a cell to keep lets the kept one go. (The page has then written its own view into the URL.)
  await again.evaluate((n) => new Promise((done) => setTimeout(() => done((location.hash = `#sweep?cell=${n}`)), 300)), number);
  await again.getByRole("button", { name: "Keep for comparison" }).waitFor();
  await close(again);
  const missing = await open(swept, {}, `#sweep?cell=${number}&held=12345`);
  await opened(missing, number);
  assert.equal(await missing.getByRole("button", { name: "Keep for comparison" }).count(), 1);
  await close(missing);
  await page.locator("#cell .stage").hover({ position: { x: 300, y: 300 } });
  assert.match(await page.locator("#cell .probe").textContent(), new RegExp(`^Pixel \\d+, \\d+: [a-z-, ]+; in cell ${number}: `));
  const label = page.locator("#cell .cell-labels button").first();
  await label.focus();
  for (const pressed of ["true", "false"]) {
    await page.keyboard.press("Enter");
    assert.equal(await label.getAttribute("aria-pressed"), pressed);
    assert.equal(await label.evaluate((e) => e === document.activeElement), true, "the keyboard has left the label's button");
  }
}

async function checkTable(page) {
  const sorted = async (name) => {
    const header = page.locator(".cells thead th").filter({ hasText: new RegExp(`^${name}$`) });
    await header.getByRole("button").click();
    const column = await header.evaluate((th) => th.cellIndex);
    return page.locator(".cells tbody tr").evaluateAll((rows, k) => rows.map((row) => Number(row.cells[k].dataset.sort)), column);
  };
  const up = await sorted("wrong"),
    down = await sorted("wrong");
  assert.deepEqual(
    up,
    [...up].sort((a, b) => a - b),
  );
  assert.deepEqual(down, [...up].reverse());
  assert.deepEqual(
    [...up].sort(),
    results()
      .map(({ lights: [light] }) => light.error.wrong_fraction)
      .sort(),
  );
  await page.locator(".run button").first().click();
  await page.locator(".run").first().getByText("Copied").waitFor();
}

async function checkCharts(page) {
  for (const chart of ["Error against time", "Least error"]) {
    const points = page.locator(`svg[aria-label^='${chart}'] a`),
      point = points.last(); // no other point lies above it
    const cell = Number((await point.getAttribute("href")).slice(6));
    await point.locator("circle").click();
    await opened(page, cell);
  }
  const [line] = await page
    .locator("svg[aria-label^='Least error'] line.used")
    .evaluateAll((all) => all.map((e) => ["x1", "y1", "x2", "y2"].map((name) => Number(e.getAttribute(name)))));
  assert.ok(line[2] > line[0] && line[3] >= line[1], "the line of slope -1 does not fall");
}

async function checkUrl() {
  const view = (page) =>
    page.evaluate(() => ({
      cell: document.querySelector("#cell h2").textContent,
      tags: [...document.querySelectorAll("#cell .tag")].map((e) => e.textContent),
      grid: document.querySelector("#grids table").textContent,
      first: document.querySelector(".cells tbody tr").id,
      zoom: document.querySelector(".zoom-value").textContent,
      mode: document.querySelector(".stage").dataset.mode,
    }));
  const first = await open(swept);
  await first.locator(".grid-bar").getByLabel("Rows", { exact: true }).selectOption("bias");
  await first.getByRole("button", { name: "false shadow" }).click();
  await first.locator("#grids a").nth(2).click();
  await first.waitForFunction(() => !document.getElementById("cell").hidden);
  await first.locator("#cell .pick").first().selectOption({ label: "labels" });
  await first.locator("#cell .stage").focus();
  await first.keyboard.press("+");
  await first.waitForFunction(() => location.hash.includes("zoom=1.5"));
  const second = await open(swept, {}, new URL(first.url()).hash);
  assert.deepEqual(await view(second), await view(first));
  await close(first);
  await close(second);
  await close(await open(swept, {}, "#sweep?cell=999&rows=<b>&sort=none"));
}

// The cells' pictures, and their numbers in a table.
async function checkWithoutScripts(folderName, options = {}) {
  const page = await open(folderName, { javaScriptEnabled: false, ...options });
  assert.match(await page.locator("h1").textContent(), /^Sweep of floating-box$/);
  const cells = page.locator("table", { has: page.locator("caption", { hasText: /^cells$/ }) }).locator("tbody tr");
  assert.equal(await cells.count(), 18);
  const wrong = await page
    .locator("th", { hasText: /^wrong fraction$/ })
    .evaluate((th) => [...th.closest("table").tBodies[0].rows].map((row) => Number(row.cells[th.cellIndex].textContent)));
  assert.deepEqual(
    wrong,
    JSON.parse(await page.locator("#result").textContent()).cells.map((cell) => cell.wrong_fraction),
  );
  for (const image of await page.locator("figure img").all()) await checkPicture(image);
  assert.equal(await page.locator("figure img").count(), 18);
  await close(page);
}

async function checkBeside() {
  const { stderr, status } = sweep(beside, ["--report-max-mb", "0.1"]);
  assert.equal(status, 0, stderr);
  assert.match(stderr, /more than --report-max-mb 0.1/);
  assert.ok(!readFileSync(join(beside, "report.html"), "utf8").includes("data:image/png"));
  assert.ok(statSync(join(beside, "report.html")).size < statSync(join(swept, "report.html")).size / 1.3);
  const hash = "#sweep?cell=7&left=labels",
    page = await open(beside, { beside: true }, hash),
    single = await open(swept, {}, hash);
  assert.match(await page.locator(".beside").textContent(), /lie beside it/);
  await opened(page, 7);
  await opened(single, 7);
  assert.deepEqual(await canvasOf(page, 0), await canvasOf(single, 0));
  assert.ok(page.requests.some((url) => url.endsWith("cells/cell-000007.js")));
  await close(page);
  await close(single);
  await checkWithoutScripts(beside, { beside: true });
}

// A shader of the reader's own is tuned like a technique: what is promised is what its command gives.
function checkTunedShader() {
  const mine = join(tuned, "mine");
  mkdirSync(join(mine, "technique"), { recursive: true });
  writeFileSync(
    join(mine, "technique", "hard.glsl"),
    `float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  return test.gap > 2.0 * light.bias.x ? 0.0 : 1.0;
}
`,
  );
  const run = (words) =>
    JSON.parse(execFileSync(program, [...words, "--size", "160x90", "--runs", "1", "--quiet", "--json", "-"], { encoding: "utf8" }));
  const answer = run([
    "tune",
    "sphere-plane",
    "--technique",
    "hard",
    "--slope-bias",
    "1",
    "--max-error",
    "2%",
    "--map-size",
    "64:512:x2",
    "--shader-dir",
    mine,
  ]);
  assert.deepEqual(
    answer.shaders.map(({ replaced }) => replaced),
    ["technique/hard.glsl"],
  );
  assert.ok(answer.custom_shader && answer.feasible && answer.command.includes("--shader-dir"), answer.command);
  const words = answer.command
    .split(" ")
    .slice(1)
    .filter((_, i, all) => all[i] !== "--size" && all[i - 1] !== "--size");
  assert.equal(run(words).lights[0].error.wrong_fraction, answer.error);
}

async function checkTuned() {
  execFileSync(program, [
    "tune",
    "floating-box",
    "--size",
    "160x90",
    "--technique",
    "hard",
    "--max-error",
    "2%",
    "--map-size",
    "32:512:x2",
    "--runs",
    "1",
    "--quiet",
    "-o",
    tuned,
  ]);
  const answer = JSON.parse(readFileSync(join(tuned, "tune.json"), "utf8")),
    result = JSON.parse(readFileSync(join(tuned, "result.json"), "utf8"));
  const page = await open(tuned);
  assert.equal(await page.locator("#tune .command code").first().textContent(), answer.command);
  assert.equal(result.command, answer.command);
  assert.equal(result.lights[0].error.wrong_fraction, answer.error);
  assert.deepEqual(
    answer.engine_units.map(({ units }) => units),
    result.lights.map(({ engine_units }) => engine_units),
  );
  assert.ok(answer.engine_units[0].units.some(({ engine, value }) => engine === "three.js" && typeof value === "number"));
  const commands = await page.locator(".families tbody code").allTextContents();
  assert.deepEqual(commands, [answer.command, ...answer.others.map((other) => other.command)]);
  const reasons = await page.locator(".families tbody th small").allTextContents();
  assert.deepEqual(reasons, [answer.why, ...answer.others.map((other) => other.why)]);
  assert.ok((await page.locator("#tune svg.chart polyline").count()) >= 3);
  await page.locator("#tune").getByRole("button", { name: "Copy the command" }).first().click();
  await page.locator("#tune").getByRole("button", { name: "Copied" }).first().waitFor();
  assert.equal(await page.locator(".pixel-probe").count(), 1);
  await close(page);
  const impossible = spawnSync(program, [
    "tune",
    "floating-box",
    "--size",
    "160x90",
    "--max-error",
    "0",
    "--map-size",
    "16,32",
    "--runs",
    "1",
    "--technique",
    "hard",
    "--slope-bias",
    "0",
    "--quiet",
    "-o",
    join(folder, "impossible"),
  ]);
  assert.equal(impossible.status, 1);
  const proof = await open(join(folder, "impossible"));
  const text = (await proof.locator("#tune").textContent()).replaceAll("\u00a0", " "),
    { best_bias: best } = JSON.parse(readFileSync(join(folder, "impossible/result.json"), "utf8")).lights[0];
  assert.match(text, /No constant bias[^:]* fits all: [\d,]+\slit pixels stay/);
  assert.ok(
    text.replaceAll(",", "").includes(`${best.lit_pixels_above} lit pixels stay dark`),
    "the proof's lit pixels are not those of result.json",
  );
  assert.ok(text.replaceAll(",", "").includes(`${best.shadowed_pixels_below} shadowed pixels are lit from`));
  await close(proof);
}

try {
  const { status, stderr } = sweep(swept);
  assert.equal(status, 0, stderr);
  const page = await open(swept);
  console.log(`${await checkCells(page)} cells show the labels and errors of sweep.jsonl`);
  await checkGrid(page);
  await checkTable(page);
  await checkCharts(page);
  assert.equal(new Set(page.requests.filter((url) => !url.startsWith("data:"))).size, 1);
  await close(page);
  await checkUrl();
  await checkWithoutScripts(swept);
  await checkBeside();
  await checkTuned();
  checkTunedShader();
  for (const hash of ["", "#sweep?cell=4"]) {
    await checkAccessibility(swept, {}, hash);
    await checkPhone(swept, {}, hash);
  }
  await checkAccessibility(tuned);
  await checkPhone(tuned);
  console.log("grid, table, charts, URL, files beside the page, tuner and accessibility are right");
} finally {
  await browser.close();
}
