// The lessons as a site, in a real browser: every page is text, pictures and nothing from outside; fits a phone; has no
// accessibility violation, light or dark; its slides turn by arrow keys; and its live figures say what the program says.
// Needs what report_browser_test needs, and OpenGL in software. Usage: node lessons_browser_test.mjs GNOMON_PROGRAM
// WORK_FOLDER [LESSON,...], where lessons are named these alone are made and looked at.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import { browser, close, colours, goTo, open, violations } from "../browser/open_page.mjs";
import { near, operate, said, slide } from "./lesson_figures.mjs";
import { checkLanguage } from "./lesson_language.mjs";

const [program, folder, only] = process.argv.slice(2),
  site = join(folder, "site");
rmSync(folder, { recursive: true, force: true });
execFileSync(program, ["lessons", "-o", site, "--quiet", ...(only ? ["--only", only] : [])], { stdio: "inherit" });
const pages = readdirSync(site),
  lessons = only?.split(",") ?? JSON.parse(execFileSync(program, ["scenes", "--json", "-"])).lessons.map(({ name }) => name);
assert.deepEqual([...pages].sort(), ["index.html", ...lessons.map((name) => `${name}.html`)].sort());
const bytes = pages.reduce((sum, page) => sum + statSync(join(site, page)).size, 0);
assert.ok(bytes < 20e6, `the site weighs ${bytes} bytes`);

const at = (page, options = {}, hash = "") => open(site, { file: page, ...options }, hash);

/** Every link within the site leads to one of its pages; every picture is there; nothing is wider than a phone. */
async function checkContent(page, name) {
  const links = await page.locator("a[href]").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
  for (const link of links.filter((l) => !l.startsWith("#") && !l.includes("://")))
    assert.ok(pages.includes(link), `${name} links to ${link}`);
  const broken = await page.locator("img").evaluateAll((all) => all.filter((i) => i.complete && i.naturalWidth === 0).map((i) => i.alt));
  assert.deepEqual(broken, [], name);
  assert.equal(await page.locator("h1").count(), 1, name);
  // C++ has "](" of its own.
  const text = await page.locator("main").evaluate((main) => {
    const code = [...main.querySelectorAll("code.language-cpp")].map((element) => element.innerText);
    return code.reduce((all, lines) => all.replace(lines, ""), main.innerText);
  });
  assert.ok(!/```|\]\(|<!--/.test(text), `${name} shows Markdown`);
  await page.setViewportSize({ width: 390, height: 844 });
  const width = await page.evaluate(() => document.scrollingElement.scrollWidth);
  assert.ok(width <= 390, `${name} is ${width} pixels wide on a phone`);
  await page.setViewportSize({ width: 1440, height: 900 });
}

/** Nothing but the colours differs in the dark. */
async function checkAxe(page, name) {
  for (const [colorScheme, rules] of [
    ["light", {}],
    ["dark", colours],
  ]) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await violations(page, rules), [], `axe, ${name}, ${colorScheme}`);
  }
}

/** Three ways on: to the lab, or its command to copy; to the exercise; back. */
async function checkWays(page, name) {
  const ways = page.locator(".ways .way");
  assert.deepEqual(await ways.allTextContents(), ["This state in the lab", "This exercise", "Back"], name);
  assert.match(await ways.nth(0).getAttribute("title"), /^Copies gnomon view [a-z]/, name);
  await ways.nth(0).click();
  await page.waitForFunction(() => document.querySelector(".ways .way").textContent === "Copied");
  await ways.nth(1).click();
  assert.equal(await page.evaluate(() => location.hash), "#exercise");
  const heading = await page.locator("#exercise").textContent();
  assert.ok(["Exercise", "Experiments"].includes(heading), `${name}: ${heading}`);
  await page.evaluate(() => history.replaceState(null, "", location.pathname));
}

/** From the first slide to the last by keys; each shows something and fits the screen. */
async function checkSlides(page, name) {
  await page.click(".open-slides");
  await page.waitForFunction(() => location.hash === "#slide-1");
  const count = Number((await page.locator(".slide-bar output").textContent()).replace(/^1 of /, ""));
  assert.ok(count >= 3, `${name} has ${count} slides`);
  for (let slide = 1; slide <= count; ++slide) {
    await page.waitForFunction((n) => location.hash === `#slide-${n}`, slide);
    const { seen, over } = await page.evaluate(() => {
      const part = document.querySelector(".part.on-slide");
      return {
        seen: [...part.children].filter((e) => e.getClientRects().length > 0).length,
        over: Math.max(part.scrollHeight - part.clientHeight, part.scrollWidth - part.clientWidth),
      };
    });
    assert.ok(seen >= 1, `${name}, slide ${slide} is empty`);
    assert.ok(over <= 0, `${name}, slide ${slide} is ${over} pixels too large`);
    await page.keyboard.press("ArrowRight");
  }
  await page.keyboard.press("Home");
  await page.waitForFunction(() => location.hash === "#slide-1");
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.documentElement.dataset.view === "page");
}

/** With every slider at one end all points of a figure may be the same, and lie on its border. What the browser cannot draw is an
    offence of the page; what is written stays in the drawing, and nothing is written over anything else. On a phone letters are larger. */
async function checkSliderEnds(page) {
  for (const [size, end] of [
    [1440, "min"],
    [1440, "max"],
    [390, "max"],
    [390, "min"],
  ]) {
    await page.setViewportSize({ width: size, height: 844 });
    const [outside, over] = await page.evaluate((limit) => {
      for (const input of document.querySelectorAll("[data-slider]")) {
        input.value = input[limit];
        input.dispatchEvent(new Event("input", { bubbles: true }));
      }
      const isOutside = (text) => {
        const at = text.getBoundingClientRect(),
          all = text.ownerSVGElement.getBoundingClientRect();
        return at.left < all.left - 2 || at.top < all.top - 2 || at.right > all.right + 2 || at.bottom > all.bottom + 2;
      };
      const meets = (one, other) => {
        const a = one.getBoundingClientRect(),
          b = other.getBoundingClientRect();
        return a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
      };
      return new Promise((done) =>
        requestAnimationFrame(() =>
          requestAnimationFrame(() =>
            requestAnimationFrame(() => {
              const drawings = [...document.querySelectorAll("svg.flatland")].map((drawing) => [...drawing.querySelectorAll("text")]);
              done([
                drawings
                  .flat()
                  .filter(isOutside)
                  .map((text) => text.textContent),
                drawings.flatMap((texts) =>
                  texts.flatMap((a, i) =>
                    texts
                      .slice(i + 1)
                      .filter((b) => meets(a, b))
                      .map((b) => `${a.textContent}, ${b.textContent}`),
                  ),
                ),
              ]);
            }),
          ),
        ),
      );
    }, end);
    assert.deepEqual(outside, [], `${page.url()}, ${size} pixels wide, with every slider at its ${end}`);
    assert.deepEqual(over, [], `${page.url()}, ${size} pixels wide, with every slider at its ${end}`);
  }
  await page.setViewportSize({ width: 1440, height: 900 });
}

/** A drag holds its handle, past the other one as well, and the handle stays under the pointer: also on a slide, where the drawing is
    narrower than its element. */
async function checkDrag() {
  const page = await at("intersections.html", { viewport: { width: 1024, height: 768 } }),
    id = '[data-figure="0"]',
    drawing = page.locator(`${id} svg.flatland`);
  await page.click(".open-slides");
  for (let i = 0; i < 40 && !(await drawing.isVisible()); ++i) await page.keyboard.press("ArrowRight");
  const screen = (at) =>
    drawing.evaluate((svg, [x, y]) => {
      const place = new DOMPoint(160 * (x + 3), 160 * (1.5 - y)).matrixTransform(svg.getScreenCTM());
      return [place.x, place.y];
    }, at);
  await slide(page, id, { ox: -2, oy: 0, ax: 0, ay: 0.02 });
  await page.mouse.move(...(await screen([-2, 0])));
  await page.mouse.down();
  await page.mouse.move(...(await screen([2, 0.1])), { steps: 40 });
  await page.mouse.up();
  await slide(page, id, {});
  const { ox, oy, ax, ay } = await said(page, id);
  near(ox, 2, 0.01, "the start, dragged");
  near(oy, 0.1, 0.01, "the start, dragged");
  assert.deepEqual([ax, ay], [0, 0.02]);
  await close(page);
}

/** What is written in the drawings can be read from a projector of 1024 × 768. */
async function checkProjector() {
  const page = await at("shadow-map.html", { viewport: { width: 1024, height: 768 } }),
    drawing = page.locator(".light-space");
  await page.click(".open-slides");
  for (let i = 0; i < 40 && !(await drawing.isVisible()); ++i) await page.keyboard.press("ArrowRight");
  const pixels = await drawing.evaluate((svg) => svg.getScreenCTM().a * parseFloat(getComputedStyle(svg.querySelector("text")).fontSize));
  assert.ok(pixels >= 11, `the drawing on a slide is written in ${pixels} pixels`);
  await close(page);
}

const operated = new Set();
/** What the lessons have: a figure that no lesson asks for would be looked at by nobody. */
const wanted = [
  "bias",
  "box-fit",
  "build",
  "cube-faces",
  "eye-ray",
  "flatland",
  "grid-curve",
  "intersection",
  "map-size",
  "structure",
  "two-passes",
  "two-ways",
  "whitted",
];
async function checkFigures(page) {
  const figures = await page.evaluate(() => JSON.parse(document.getElementById("page-data").textContent).figures);
  for (const [i, figure] of figures.entries()) {
    if (!figure) continue;
    await operate[figure.name](page, figure, `[data-figure="${i}"]`, program);
    operated.add(figure.name);
  }
}

/** What is asked of the site once. */
async function checkWhole() {
  assert.deepEqual([...operated].sort(), wanted);
  await checkDrag();
  await checkProjector();
  const linked = await at("acne.html", {}, "#slide-2");
  assert.equal(
    await linked
      .locator(".slide-bar output")
      .textContent()
      .then((text) => text.slice(0, 5)),
    "2 of ",
  );
  await checkAxe(linked, "a slide");
  await close(linked);
  // Back is where one came from, and from a page by itself all lessons.
  const way = await at("bias.html");
  const follow = async (link) => {
    await way.click(link);
    await way.waitForFunction(() => document.documentElement.dataset.ready === "true");
    return way.url().split("/").at(-1);
  };
  assert.equal(await follow(".lesson-text a[href='precision.html']"), "precision.html");
  assert.equal(await follow(".ways .way:last-child"), "bias.html");
  await way.context().close();
  const plain = await at("acne.html", { javaScriptEnabled: false });
  assert.ok(await plain.locator(".lesson-text img").first().isVisible());
  await close(plain);
}

try {
  // One page for all: to end a browser's context takes as long as the checks.
  const page = await at(pages[0]);
  for (const name of pages) {
    await page.emulateMedia({ colorScheme: "light" });
    if (name !== pages[0]) await goTo(page, site, name);
    await checkContent(page, name);
    await checkAxe(page, name);
    await checkFigures(page);
    await checkSliderEnds(page);
    if (name !== "index.html") await checkSlides(page, name);
    if (name !== "index.html") await checkWays(page, name);
  }
  await checkLanguage(page, site, pages);
  await close(page);
  if (!only) await checkWhole();
  console.log(`live figures: ${[...operated].join(", ") || "none"}`);
  console.log(`${pages.length} pages, ${(bytes / 1e6).toFixed(1)} MB`);
} finally {
  await browser.close();
}
