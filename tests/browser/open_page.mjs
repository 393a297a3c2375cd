// What the tests of the report page share: a browser, and pages that must not do what they must not do. A test that
// lacks node packages or the browser says so and is skipped (exit 77).
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

export function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

const require = createRequire(new URL("package.json", import.meta.url));
function load(name) {
  try {
    return require(name);
  } catch {
    return skip(`${name} is not installed: npm install --no-save --prefix tests/browser`);
  }
}
const browserPath =
  ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium"].find(existsSync) || skip("no chromium-headless-shell or chromium in /usr/bin");
const { chromium } = load("playwright-core");
const axeSource = load("axe-core").source;
/** WebGL without a GPU is the browser's own software's. */
const webgl = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
export const browser = await chromium.launch({ executablePath: browserPath, args: webgl });

/** In the page: an array of a type as text. Its numbers one by one take ten times as long to come out of the browser. */
function addBytesAsText() {
  globalThis.bytesAsText = ({ buffer, byteOffset, byteLength }) => {
    const bytes = new Uint8Array(buffer, byteOffset, byteLength),
      parts = [];
    for (let at = 0; at < bytes.length; at += 4096) parts.push(String.fromCharCode(...bytes.subarray(at, at + 4096)));
    return btoa(parts.join(""));
  };
}

/** Opens FOLDER/report.html, or another file of it, and collects everything that it must not do. `hash` begins with #. */
export function open(folder, options = {}, hash = "") {
  const { beside, file = "report.html", ...others } = options,
    url = pathToFileURL(resolve(folder, file)).href;
  return openAt(url, beside ? new URL(".", url).href : null, others, hash);
}

/** The same of any address. `allowed`: what the page may ask for besides itself begins so; null: nothing. */
export async function openAt(url, allowed, contextOptions = {}, hash = "") {
  // Without motion: a page that still scrolls when a button goes up again makes no click of it.
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, reducedMotion: "reduce", ...contextOptions });
  await context.addInitScript(addBytesAsText);
  const page = await context.newPage();
  page.offences = [];
  page.requests = [];
  page.on("console", (message) => page.offences.push(`console ${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => page.offences.push(`error: ${error.message}`));
  page.own = url;
  page.on("request", (request) => {
    // A page may ask for nothing but itself, or, where it says so, for the files beside it.
    const asked = request.url().split("#")[0],
      besideIt = allowed !== null && asked.startsWith(allowed);
    page.requests.push(asked);
    if (asked !== page.own && !asked.startsWith("data:") && !besideIt) page.offences.push(`request: ${asked}`);
  });
  await page.goto(url + hash);
  if (contextOptions.javaScriptEnabled !== false) await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
  return page;
}

/** Another file of the folder in the page that is open, which collects on. */
export async function goTo(page, folder, file) {
  page.own = pathToFileURL(resolve(folder, file)).href;
  await page.goto(page.own);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
}

export async function close(page) {
  assert.deepEqual(page.offences, []);
  await page.context().close();
}

/** What axe finds wrong with the page, or with a part of it. */
export async function violations(page, rules = {}, part = null) {
  await page.evaluate(axeSource);
  // Of what passes axe would otherwise list every element, too.
  return page.evaluate(
    async ([where, options]) =>
      (await window.axe.run(where ?? document, options)).violations.map(
        ({ id, nodes }) => `${id}: ${nodes.map((n) => n.html.slice(0, 120)).join(" | ")}`,
      ),
    [part, { resultTypes: ["violations"], ...rules }],
  );
}
/** The rules that colours decide. */
export const colours = { runOnly: ["color-contrast", "link-in-text-block"] };

/** Nothing but the colours differs in the dark. */
export async function checkAccessibility(folder, options = {}, hash = "") {
  for (const colorScheme of ["light", "dark"]) {
    const page = await open(folder, { colorScheme, ...options }, hash);
    assert.deepEqual(await violations(page, colorScheme === "dark" ? colours : {}), [], `axe, ${page.url()}, ${colorScheme}`);
    await close(page);
  }
}

/** A picture can be read. One that the page has only just set may still be loading, so this waits until it has loaded or failed. */
export async function checkPicture(image) {
  const width = await image.evaluate(
    (e) =>
      new Promise((done) => {
        const tell = () => done(e.naturalWidth);
        if (e.complete) return tell();
        e.addEventListener("load", tell);
        e.addEventListener("error", tell);
      }),
  );
  assert.ok(width > 0, "a picture cannot be read");
}

/** A canvas' pixels, four bytes each. */
export async function pixelsOf(canvas) {
  return Buffer.from(
    await canvas.evaluate((e) => {
      const copy = Object.assign(document.createElement("canvas"), { width: e.width, height: e.height });
      const context = copy.getContext("2d", { willReadFrequently: true });
      context.drawImage(e, 0, 0);
      return globalThis.bytesAsText(context.getImageData(0, 0, copy.width, copy.height).data);
    }),
    "base64",
  );
}

/** Nothing may be wider than a phone. */
export async function checkPhone(folder, options = {}, hash = "") {
  const page = await open(folder, { viewport: { width: 390, height: 844 }, ...options }, hash);
  const width = await page.evaluate(() => document.scrollingElement.scrollWidth);
  assert.ok(width <= 390, `${page.url()} is ${width} pixels wide on a phone`);
  await close(page);
}
