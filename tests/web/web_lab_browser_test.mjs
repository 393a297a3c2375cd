// The site that `gnomon site` writes, on a host of plain files: the lab's page with an engine of its own, whose labels are the native
// command's, whose files come by drop, whose report is saved, and which says what it cannot do; start page, manual and lessons beside
// it (their figures: web_lessons_browser_test.mjs). Usage: web_lab_browser_test.mjs GNOMON FOLDER SITE, the last by web_site.mjs. Exit code
// 77 where the program for the web has not been built.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { browser, close, colours, openAt, violations } from "../browser/open_page.mjs";
import { hasThree, serveThree } from "../support/three_page.mjs";
import { app, isBuilt, serveFolder, skip } from "./program_in_browser.mjs";

const [native, folder, site] = process.argv.slice(2);
if (!isBuilt) skip("the program for the web is not here (./gnomon web builds it)");
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const host = await serveFolder(site);
const openLab = (hash, options = {}) => openAt(`${host.url}lab.html`, host.url, options, hash);
/** What was asked for last is compared in full. */
const done = (page) =>
  page.waitForFunction(() => document.body.dataset.busy === "false" || !document.getElementById("lab-gone").hidden, null, {
    timeout: 300000,
  });
const change = async (page, act) => {
  const before = page.url();
  await act();
  await page.waitForFunction((url) => location.href !== url, before);
  await done(page);
};
const small = "#scene=sphere-plane&size=192x108&map-size=128";
const set = (page, name, value) =>
  change(page, () =>
    page
      .locator(`[data-setting=${name}] input[type=text]`)
      .fill(value)
      .then(() => page.keyboard.press("Enter")),
  );
/** By the keys of result.json. */
const countsOf = (page) =>
  page
    .locator("#lab-results .labels tbody tr")
    .evaluateAll((rows) =>
      Object.fromEntries(
        rows.map((row) => [
          row.querySelector("summary").textContent.replaceAll(/[ -]/g, "_"),
          Number(row.querySelector(".n").textContent.replaceAll(",", "")),
        ]),
      ),
    );

async function countsWhatTheCommandCounts() {
  const page = await openLab(small);
  await done(page);
  for (const texels of ["3", "0"]) await set(page, "bias", texels);
  const command = await page.locator("#lab-command").textContent();
  const { classes } = JSON.parse(
    execFileSync("sh", ["-c", `${command.replace(/^gnomon/, `'${native}'`)} --json - --quiet --runs 1`], { maxBuffer: 1 << 28 }),
  ).lights[0];
  const counts = await countsOf(page);
  const wrong = Object.entries(classes).filter(([, count]) => count > 0);
  assert.ok(wrong.length > 0 && wrong.reduce((sum, [, count]) => sum + count, 0) > 100, "a bias of 0 leaves something wrong");
  for (const [label, count] of wrong) assert.equal(counts[label], count, `${label} of ${JSON.stringify(counts)}`);
  const box = await page.locator(".stage").boundingBox();
  await page.locator(".stage").click({ position: { x: 0.3 * box.width, y: 0.8 * box.height } });
  await page.locator("#lab-pixel h2").waitFor();
  assert.equal(await page.locator("#lab-pixel tbody tr").count(), 7);

  // What WebGL 2 lacks is said, and nothing is lost.
  await page.locator("[data-setting=technique] select").selectOption("izb");
  await page.waitForFunction(() => !document.getElementById("lab-error").hidden, null, { timeout: 60000 });
  assert.match(await page.locator("#lab-error").textContent(), /izb writes storage buffers, which WebGL 2 lacks/);
  await change(page, () => page.locator("[data-setting=technique] select").selectOption("pcf"));
  assert.ok(await page.locator("#lab-error").isHidden());
  await close(page);
}

async function opensFilesAndSavesTheReport() {
  const page = await openLab(small);
  await done(page);
  const file = path.join(folder, "pyramid.obj");
  writeFileSync(file, "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  await change(page, () => page.locator("#lab-file").setInputFiles(file));
  await page.waitForFunction(() => document.title.startsWith("pyramid"), null, { timeout: 300000 });
  await done(page);
  const saved = page.waitForEvent("download", { timeout: 300000 });
  await page.locator("#lab-save").click();
  const report = path.join(folder, "report.html");
  await (await saved).saveAs(report);
  assert.match(readFileSync(report, "utf8"), /pyramid/);
  await close(page);
}

async function canBeReadByAll() {
  for (const [name, hash] of [
    ["", ""],
    ["lab.html", small],
    ["manual/", ""],
    ["lessons/", ""],
  ])
    for (const width of [1440, 390]) {
      const page = await openAt(`${host.url}${name}`, host.url, { viewport: { width, height: 844 } }, hash);
      if (name === "lab.html") await done(page);
      assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= width, `${name} is wider than ${width} pixels`);
      assert.deepEqual(await violations(page), [], `axe, ${name}, ${width}`);
      await close(page);
    }
  const dark = await openLab(small, { colorScheme: "dark" });
  await done(dark);
  assert.deepEqual(await violations(dark, colours), [], "axe, dark");
  await close(dark);
}

/** Of all pages but the lessons', which are the same as those of `gnomon lessons`: each link to a page and a place of it that there are. */
async function leadsSomewhere() {
  for (const [name, least, which] of [
    ["", 20, "a[href]"],
    ["manual/", 5, "a[href]"],
    ["manual/options.html", 3, "a[href]"],
    ["manual/techniques.html", 1, "a[href]"],
    ["lab.html", 7, "a.manual"],
  ]) {
    const page = await openAt(`${host.url}${name}`, host.url);
    const links = (await page.locator(which).evaluateAll((all) => all.map(({ href }) => href))).filter((link) => link.startsWith(host.url));
    assert.ok(links.length >= least, `${name}: ${links.length} links`);
    for (const link of links) {
      const [address, place = ""] = link.split("#"),
        answer = await fetch(address);
      assert.ok(answer.ok, `${name}: ${link}`);
      if (place !== "" && !address.endsWith("lab.html"))
        assert.ok((await answer.text()).includes(`id="${place}"`), `${name}: no such place: ${link}`);
    }
    await close(page);
  }
}

/** The lab saved as one file begins from the disk with what was set, and computes there. */
async function savesTheLabAsOneFile() {
  const page = await openLab(small);
  await done(page);
  await set(page, "bias", "0");
  const labels = (of) => of.locator("#lab-results .labels").textContent(),
    counted = await labels(page);
  const saved = page.waitForEvent("download", { timeout: 120000 });
  await page.locator("#lab-one-file").click();
  const file = path.join(folder, "elsewhere", "gnomon-lab.html");
  await (await saved).saveAs(file);
  await close(page);
  const alone = await openAt(pathToFileURL(file).href, "blob:"); // its worker
  await done(alone);
  assert.equal(await alone.locator("#lab-gone").textContent(), "");
  assert.match(await alone.evaluate(() => location.hash), /scene=sphere-plane.*bias=0/);
  assert.equal(await labels(alone), counted);
  await set(alone, "bias", "3");
  assert.notEqual(await labels(alone), counted);
  assert.ok(await alone.locator("#lab-one-file").isHidden());
  assert.ok((await alone.locator("a.manual").first().getAttribute("href")).startsWith(host.url), "the manual is where the lab came from");
  await close(alone);
}

/** A lesson's figure leads to the lab, which draws the same picture: both count what the command counts. */
async function leadsFromALessonToTheLab() {
  const lesson = await openAt(`${host.url}lessons/acne.html`, host.url),
    figure = lesson.locator(".live-figure", { has: lesson.locator(".to-lab") }).first();
  const [counted, href] = [
    await figure.locator(".bias-counts").evaluate(({ dataset }) => Number(dataset.falseShadow)),
    await figure.locator(".to-lab").evaluate((a) => a.href),
  ];
  await close(lesson);
  const page = await openLab(new URL(href).hash);
  assert.equal(new URL(href).href.split("#")[0], `${host.url}lab.html`);
  await done(page);
  const rows = await countsOf(page);
  const { scene, ...options } = Object.fromEntries(new URLSearchParams(new URL(href).hash.slice(1)));
  const { classes, error } = JSON.parse(
    execFileSync(
      native,
      [
        "compare",
        scene,
        ...Object.entries(options).flatMap(([name, value]) => [`--${name}`, value]),
        "--runs",
        "1",
        "--quiet",
        "--no-report",
        "--json",
        "-",
      ],
      { maxBuffer: 1 << 28 },
    ),
  ).lights[0];
  assert.equal(counted, error.false_shadow);
  // Triangles are not drawn to the bit by another graphics driver: as in web_gl_browser_test.
  assert.ok(Math.abs(rows.acne - classes.acne) <= 0.005 * classes.acne, `${JSON.stringify(rows)}, by the command ${classes.acne}`);
  await close(page);
}

/** A page whose worker begins with other lines. */
async function openWith(lines) {
  const page = await browser.newPage();
  const body = `${lines}\n${readFileSync(path.join(app, "gnomon_worker.mjs"), "utf8")}`;
  await page.route("**/gnomon_worker.mjs", (route) => route.fulfill({ contentType: "text/javascript", body }));
  await page.goto(`${host.url}lab.html${small}`);
  return page;
}

/** A GPU whose clock tells the first run's three spans in 1, 1.5 and 0.5 ms, so that a run has ten drawings, loses count in the second, and
 *  answers nothing until a pixel is asked for. */
const gpu = `const { getExtension, getParameter } = WebGL2RenderingContext.prototype, spans = [];
  let open = false, lost = false;
  addEventListener("message", ({ data }) => { open ||= data.name === "pixel"; });
  Object.assign(WebGL2RenderingContext.prototype, {
    getExtension(name) { return name === "EXT_disjoint_timer_query_webgl2" ? { TIME_ELAPSED_EXT: 0x88BF, QUERY_COUNTER_BITS_EXT: 0x8864 } : getExtension.call(this, name); },
    getParameter(name) {
      if (name === 0x8FBB) { const was = lost; lost = false; return was; }
      return name === 0x9246 ? "Stub GPU" : getParameter.call(this, name);
    },
    getQuery: () => 30, createQuery: () => ({}), deleteQuery() {}, endQuery() {},
    beginQuery(target, query) { Object.assign(query, { number: spans.push(query) - 1, told: false }); setTimeout(() => { query.told = true; }); lost ||= query.number === 4; },
    getQueryParameter: (query, name) => (name === 0x8867 ? open && query.told
      : 1e6 * (query.number < 3 ? [1, 1.5, 0.5] : query.number < 6 ? [99, 99, 99] : [4, 9, 6])[query.number % 3]),
  });`;
const noClock = `const { getExtension, getParameter } = WebGL2RenderingContext.prototype;
  Object.assign(WebGL2RenderingContext.prototype, {
    getExtension(name) { return name === "EXT_disjoint_timer_query_webgl2" ? null : getExtension.call(this, name); },
    getParameter(name) { return name === 0x9246 ? "Stub GPU" : getParameter.call(this, name); },
  });`;
const askForAPixel = (page) => page.locator(".stage").click({ position: { x: 100, y: 100 } });
const times = (page) =>
  page
    .locator("#lab-times tbody tr")
    .evaluateAll((rows) => Object.fromEntries(rows.map((row) => [...row.children].map(({ textContent }) => textContent))));
const timedBy = (page, pattern) =>
  page.waitForFunction((source) => new RegExp(source).test(document.querySelector("#lab-times + p")?.textContent ?? ""), pattern.source, {
    timeout: 60000,
  });

/** What shadows take: by the GPU's clock where a page may read it, which labels do not wait for; else by the program's; else not of a GPU. */
async function timesTheShadowsOnTheGpu() {
  const page = await openWith(gpu);
  await done(page);
  await timedBy(page, /They are timed while nothing else is to be done/);
  await askForAPixel(page);
  await timedBy(page, /by the clock of Stub GPU: 5 runs of 10 drawings, in steps of 1 ms/);
  const drawn = await times(page);
  assert.deepEqual(Object.keys(drawn), ["nothing moves", "light or camera moves", "casters move"]);
  assert.match(drawn["nothing moves"], /^0\.3 ms by the map, .* ms\)? by rays$/, "the run that the GPU lost count in is not among them");
  for (const moved of ["light or camera moves", "casters move"]) assert.match(drawn[moved], /^0\.7 ms by the map, .* ms\)? by rays$/);
  await page.close();

  const without = await openWith(noClock);
  await done(without);
  await timedBy(without, /are a guess: no clock of Stub GPU is to be read here.*the wait for the driver too; 5 runs of \d+ drawings/);
  assert.equal(Object.keys(await times(without)).length, 3);
  await without.close();

  const software = await openLab(small);
  await done(software);
  await timedBy(software, /3 runs, by the processor: .*SwiftShader.* is no GPU/);
  await close(software);
}

/** It is lost with the wish: lost before, the page may say so before it hears of the wish. */
async function saysThatTheContextIsLost() {
  const page = await openWith(`const get = OffscreenCanvas.prototype.getContext;
    OffscreenCanvas.prototype.getContext = function (...words) { return (self.drawing = get.apply(this, words)); };
    addEventListener("message", ({ data }) => { if (data.name === "pixel") self.asked = true; else if (self.asked) self.drawing.getExtension("WEBGL_lose_context")?.loseContext(); });`);
  await done(page);
  await page.locator(".stage").click({ position: { x: 100, y: 100 } });
  await page.locator("#lab-pixel h2").waitFor();
  await page.locator("[data-setting=map-size] input[type=text]").fill("64");
  await page.keyboard.press("Enter");
  await page.locator("#lab-gone").waitFor({ timeout: 60000 });
  assert.match(await page.locator("#lab-gone").textContent(), /context lost.*reload the page/);
  assert.match(await page.evaluate(() => location.hash), /map-size=64/, "the state is kept");
  await page.close();
}

/** An engine that hears nothing for long, as one whose browser translates shaders for minutes. */
async function saysThatItTakesLong() {
  const page = await browser.newPage();
  await page.clock.install();
  await page.route("**/gnomon_worker.mjs", (route) =>
    route.fulfill({
      contentType: "text/javascript",
      body: "onmessage = ({ data: { id, name } }) => { if (name !== 'news') postMessage({ id, status: 200, type: 'application/json', body: new TextEncoder().encode('{\"number\": 1}') }); };",
    }),
  );
  await page.goto(`${host.url}lab.html#scene=shapes`);
  await page.waitForFunction(() => document.body.dataset.busy === "true");
  assert.equal(await page.locator("#lab-note").textContent(), "");
  await page.clock.fastForward(21000);
  assert.match(await page.locator("#lab-note").textContent(), /takes long.*without a GPU.*reload the page with another scene/);
  assert.match(await page.evaluate(() => location.hash), /scene=shapes/, "the state is kept");
  await page.close();
}

/** From the disk all opens, and the lab says what it needs. */
async function opensFromTheDisk() {
  const page = await openAt(pathToFileURL(path.resolve(site, "lab.html")).href, null);
  await page.locator("#lab-gone").waitFor({ timeout: 10000 });
  assert.match(await page.locator("#lab-gone").textContent(), /needs a host.*python3 -m http.server/);
  assert.equal(await page.locator("#lab-verdict").textContent(), "", "nothing is said to be drawn");
  await close(page);
  const start = await openAt(pathToFileURL(path.resolve(site, "index.html")).href, null);
  assert.ok(
    await start.locator(".cards img").evaluateAll((all) => all.length > 10 && all.every(({ naturalWidth }) => naturalWidth === 320)),
    "a picture of each scene",
  );
  const begin = start.locator("main a").first();
  assert.equal(await begin.textContent(), "Begin here", "what to press first is seen");
  assert.match(await begin.getAttribute("href"), /^lab\.html#scene=acne-floor$/);
  assert.match(await start.locator(".cards a").first().getAttribute("href"), /acne-floor$/);
  await close(start);
}

async function saysThatThereIsNoWebGl() {
  const page = await openWith("OffscreenCanvas.prototype.getContext = () => null;");
  await page.waitForFunction(() => !document.getElementById("lab-error").hidden || !document.getElementById("lab-gone").hidden, null, {
    timeout: 60000,
  });
  assert.match(
    await page
      .locator("#lab-error, #lab-gone")
      .allTextContents()
      .then((all) => all.join(" ")),
    /no WebGL 2 here to draw with/,
  );
  await page.close();
}

/** A page of three.js, of another host, hands its scene in with one line: the lab says where it came from, and counts what the command
    counts of the same file. Nothing else is taken from anywhere. */
async function takesARunningScene() {
  const three = await serveThree(),
    page = await openAt(`${three.url}?light=sun&bias=-0.001`, "http://127.0.0.1:");
  const opened = page.waitForEvent("popup");
  const exported = page.evaluate(async (site) => {
    const { exportForLab, openInLab } = await import(`${site}open_in_lab.mjs`);
    await openInLab(globalThis.scene);
    return [...new Uint8Array((await exportForLab(globalThis.scene)).glb)];
  }, host.url);
  const lab = await opened;
  await lab.waitForFunction(() => document.title.startsWith("scene"), null, { timeout: 300000 });
  await done(lab);
  assert.equal(await lab.locator("#lab-from").textContent(), `This scene came from the page at ${new URL(three.url).origin}.`);
  assert.match(lab.url(), /window-depths=1,9&bias=0\.008/, "the shadow's settings came along");
  const file = path.join(folder, "scene.glb");
  writeFileSync(file, Buffer.from(await exported));
  const counts = await countsOf(lab),
    command = (await lab.locator("#lab-command").textContent()).replace(/^gnomon compare \S+/, `'${native}' compare '${file}'`);
  const { classes, pixels } = JSON.parse(
    execFileSync("sh", ["-c", `${command} --json - --quiet --no-report --runs 1`], { maxBuffer: 1 << 28 }),
  ).lights[0];
  // As in web_gl_browser_test; of what is wrong a twentieth.
  for (const [label, count] of Object.entries(classes)) {
    const apart = Math.abs((counts[label] ?? 0) - count);
    assert.ok(
      apart <= Math.min(0.005 * pixels.compared, 0.05 * classes.acne),
      `${label}: ${JSON.stringify(counts)}, by the command ${count}`,
    );
  }
  assert.ok(classes.acne > 1000, "a bias of 0.008 leaves acne");

  await lab.close();

  // Of what is no scene, of another window's, and of a second one nothing is taken; a file that is none says so, as one that is dropped.
  const opening = page.waitForEvent("popup");
  await page.evaluate((site) => {
    globalThis.lab = window.open(`${site}lab.html`);
    return new Promise((heard) => {
      window.onmessage = heard;
    });
  }, host.url);
  const other = await opening;
  await other.evaluate(() => window.postMessage({ gnomon: "scene", glb: new ArrayBuffer(8) }, "*"));
  await page.evaluate(() => {
    for (const said of [null, "scene", { gnomon: "scene" }, { gnomon: "scene", glb: "text" }]) globalThis.lab.postMessage(said, "*");
  });
  await done(other);
  assert.equal(await other.locator("#lab-from").textContent(), "");
  assert.ok(await other.locator("#lab-error").isHidden());
  await page.evaluate(() => {
    for (const note of ["<b>first</b>", "second"])
      globalThis.lab.postMessage(
        { gnomon: "scene", glb: new ArrayBuffer(8), options: { "no such": "1", "map-size": 7 }, notes: [note, 1] },
        "*",
      );
  });
  await other.waitForFunction(() => !document.getElementById("lab-error").hidden, null, { timeout: 60000 });
  assert.match(await other.locator("#lab-from").textContent(), /Not brought along: <b>first<\/b>\.$/);
  assert.match(await other.locator("#lab-error").textContent(), /not a GLB file/);
  await other.close();
  await close(page);
  three.stop();
}

await countsWhatTheCommandCounts();
await opensFilesAndSavesTheReport();
await canBeReadByAll();
await leadsSomewhere();
await leadsFromALessonToTheLab();
await timesTheShadowsOnTheGpu();
await saysThatTheContextIsLost();
await saysThatThereIsNoWebGl();
await saysThatItTakesLong();
await savesTheLabAsOneFile();
await opensFromTheDisk();
if (hasThree) await takesARunningScene();
await browser.close();
host.stop();
if (!hasThree) skip("three is not installed: npm install --prefix adapters");
console.log("the site in a browser");
