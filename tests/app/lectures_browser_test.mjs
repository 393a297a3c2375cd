// Both lectures in a real browser, slide by slide as they are projected at 1024 x 768: nothing cut, no letter below 18
// pixels, texels that the last row sees, no symbol without a name (lecture_words.mjs), minutes that sum to 90; slides and keys from the first moment, before the figures
// are made; keys, clicker, black screen, the speaker's window; no accessibility violation; and the PDF that Chromium prints: one page a slide, with all that is on it.
// Needs what lessons_browser_test needs. Usage: node lectures_browser_test.mjs GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, rmSync } from "node:fs";
import { basename, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { browser, close, colours, open, violations } from "../browser/open_page.mjs";
import { pdfPages } from "../browser/pdf_text.mjs";
import { checkWords } from "./lecture_words.mjs";

const [program, folder] = process.argv.slice(2),
  viewport = { width: 1024, height: 768 };
const decks = new URL("../../docs/lectures/en", import.meta.url),
  lectures = readdirSync(decks).map((file) => basename(file, ".md"));
rmSync(folder, { recursive: true, force: true });
for (const lecture of lectures) execFileSync(program, ["lessons", "--lecture", lecture, "-o", folder, "--quiet"], { stdio: "inherit" });
const at = (lecture, options = {}, hash = "") => open(folder, { file: `${lecture}.html`, viewport, ...options }, hash);

const count = (page) => page.locator(".part").count();
const hash = (page) => page.evaluate(() => location.hash);
const toCome = (page) => page.locator(".on-slide .to-come").count();
const go = async (page, slide) => {
  await page.evaluate((n) => {
    location.hash = `#slide-${n}`;
  }, slide);
  await page.waitForFunction((n) => document.querySelector(".on-slide").id === `slide-${n}`, slide);
};

/** Every slide: heading, minutes and notes; all of it on the screen; letters of 18 pixels or more; a question before its answer. */
async function checkSlides(page, lecture) {
  const slides = await count(page),
    minutes = await page.locator(".notes").evaluateAll((all) => all.map((notes) => Number(notes.dataset.minutes))),
    core = await page
      .locator(".notes:not([data-beyond])")
      .evaluateAll((all) => all.reduce((sum, notes) => sum + Number(notes.dataset.minutes), 0));
  // What the lecture on rays has of GAMES101's lectures 13 and 14, and of shadow maps what those have.
  assert.equal(core, { rays: 64, shadows: 31 }[lecture], `${lecture} without what may be left out`);
  assert.equal(await page.locator(".beyond").count(), await page.locator(".notes[data-beyond]").count());
  assert.equal(
    minutes.reduce((sum, m) => sum + m, 0),
    90,
    `${lecture} takes ${minutes.join(" + ")} minutes`,
  );
  assert.ok(slides >= 30 && minutes.every((m) => m >= 1 && m <= 5), lecture);
  for (let slide = 1; slide <= slides; ++slide) {
    await go(page, slide);
    const found = await page.evaluate(() => {
      const part = document.querySelector(".on-slide"),
        box = part.getBoundingClientRect(),
        small = [],
        cut = [],
        broken = [];
      for (const element of part.querySelectorAll("*")) {
        if (element.closest(".notes, .beyond, .is-live > p") || element.getClientRects().length === 0) continue;
        if (![...element.childNodes].some((c) => c.nodeType === Node.TEXT_NODE && c.textContent.trim() !== "")) continue;
        const drawing = element.closest("svg"),
          pixels = parseFloat(getComputedStyle(element).fontSize) * (drawing ? drawing.getScreenCTM().a : 1),
          at = element.getBoundingClientRect();
        if (pixels < 18) small.push(`${element.textContent.slice(0, 30)}: ${pixels}`);
        if (at.left < box.left - 1 || at.top < box.top - 1 || at.right > box.right + 1 || at.bottom > box.bottom - 30)
          cut.push(element.textContent.slice(0, 40));
        if (element.matches(".option") && element.getClientRects().length > 1) broken.push(element.textContent);
      }
      for (const element of part.querySelectorAll("pre, .scroll, .live-figure > p"))
        if (element.scrollWidth > element.clientWidth + 1) cut.push(element.textContent.slice(0, 40));
      const notes = part.querySelector(".notes").textContent.trim(),
        asks = part.querySelector(".step.question") !== null;
      return {
        small,
        cut,
        broken,
        notes: notes.length,
        asks,
        heading: part.querySelector("h1, h2").textContent,
        sentences: part.querySelectorAll(".step.sentence:not(.to-come)").length,
      };
    });
    const where = `${lecture}, slide ${slide}: ${found.heading}`;
    assert.deepEqual([found.small, found.cut, found.broken], [[], [], []], where);
    assert.ok(found.notes > 20, `${where} has no notes`);
    assert.equal(found.sentences, 0, `${where} shows its answer at once`);
  }
}

/** A texel in the middle of such a picture is 20 pixels wide or more, at the coarsest map where the figure has several. */
async function checkTexels(page, lecture) {
  const figures = await page.evaluate(() => JSON.parse(document.getElementById("page-data").textContent).figures);
  for (const [i, { name, settings }] of figures.entries()) {
    if (name !== "bias" && name !== "map-size") continue;
    const { scene, sizes, ...options } = settings,
      words = Object.entries({ ...options, ...(sizes ? { "map-size": sizes.split(",")[0] } : {}) }).flatMap(([key, value]) => [
        `--${key}`,
        value,
      ]);
    const light = JSON.parse(
      execFileSync(program, ["compare", scene, ...words, "--size", "480x270", "--runs", "1", "--quiet", "--no-report", "--json", "-"]),
    ).lights[0];
    const shown = await page
      .locator(`[data-figure="${i}"] canvas`)
      .first()
      .evaluate((canvas) => canvas.getBoundingClientRect().width / canvas.width);
    const texel = light.theory.aliasing.median * shown;
    assert.ok(texel >= 20, `${lecture}: a texel of ${scene} ${words.join(" ")} is ${texel.toFixed(1)} pixels wide`);
  }
}

/** Of two pictures in one file the slide shows the left one alone, then the right one alone, each as wide as the slide allows. */
async function checkPairs(page, lecture) {
  const pairs = await page
    .locator(".part:has(.step.pair)")
    .evaluateAll((parts) => parts.map(({ id }) => Number(id.slice("slide-".length))));
  assert.ok(pairs.length >= 3, `${lecture} shows ${pairs.length} pairs`);
  for (const slide of pairs) {
    await go(page, slide);
    for (const [side, step] of [
      ["0%", "pair"],
      ["100%", "flip"],
    ]) {
      while ((await page.locator(`.on-slide .step.${step}.to-come`).count()) > 0) await page.keyboard.press("ArrowRight");
      const shown = await page
        .locator(".on-slide .step.pair img")
        .evaluate((img) => ({
          ...img.getBoundingClientRect().toJSON(),
          texel: img.getBoundingClientRect().height / img.naturalHeight,
          at: getComputedStyle(img).objectPosition,
        }));
      assert.equal(shown.at.split(" ")[0], side, `${lecture}, slide ${slide}`);
      assert.ok(
        Math.abs(shown.width / shown.height - 16 / 9) < 0.01 && shown.texel > 2.2,
        `${lecture}, slide ${slide}: ${JSON.stringify(shown)}`,
      );
    }
  }
}

/** Keys and a clicker's: a step at a time, back again, to the ends, black; and a slide's address. */
async function checkKeys(page, lecture) {
  await go(page, 2);
  const steps = await toCome(page);
  assert.ok(steps >= 1, `${lecture}: the second slide shows all at once`);
  await page.keyboard.press("PageDown");
  assert.equal(await toCome(page), steps - 1);
  await page.keyboard.press("PageUp");
  assert.equal(await toCome(page), steps);
  for (let i = 0; i <= steps; ++i) await page.keyboard.press(["ArrowRight", " ", "Enter"][i % 3]);
  assert.equal(await hash(page), "#slide-3");
  await page.keyboard.press("ArrowLeft");
  assert.deepEqual([await hash(page), await toCome(page)], ["#slide-2", 0]);
  await page.keyboard.press("End");
  assert.equal(await hash(page), `#slide-${await count(page)}`);
  await page.keyboard.press("Home");
  for (const key of ["b", "."]) {
    await page.keyboard.press(key);
    assert.ok(await page.locator(".black").isVisible(), key);
    await page.keyboard.press(key);
    assert.ok(!(await page.locator(".black").isVisible()), key);
  }
  // A slider keeps its arrows, and a clicker turns the slide all the same.
  const slides = await page.locator(".part:has(input[type=range])").evaluateAll((parts) => parts.map(({ id }) => id));
  await go(page, Number(slides[0].slice("slide-".length)));
  const left = await toCome(page);
  await page.locator(".on-slide input[type=range]:visible").first().focus();
  await page.keyboard.press("ArrowRight");
  assert.deepEqual([await hash(page), await toCome(page)], [`#${slides[0]}`, left]);
  await page.keyboard.press("PageDown");
  assert.equal(await toCome(page), left - 1);
}

/** In the page: the notes that its frames show, the most headings that one shows, the figures in the order in which they come, and how
 *  many there are when keys that come with the first slide have turned it. */
function watchFrames() {
  globalThis.watched = { frames: 0, notes: 0, headings: 0, figures: [], whenTurned: location.hash === "" ? null : 0 };
  const shown = (what) => [...document.querySelectorAll(what)].filter((element) => element.checkVisibility({ visibilityProperty: true }));
  const look = () => {
    const { watched } = globalThis;
    ++watched.frames;
    watched.notes += shown(".notes").length;
    watched.headings = Math.max(watched.headings, shown(".part > :is(h1, h2)").length);
    if (document.documentElement.dataset.view === "lecture" && watched.whenTurned === null) {
      const begun = location.hash;
      for (let i = 0; i < 9 && location.hash === begun; ++i)
        document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
      if (location.hash !== begun) watched.whenTurned = watched.figures.length;
    }
    if (document.documentElement.dataset.ready !== "true") requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
  const come = (changes) => {
    for (const { target } of changes) if (target.matches(".is-live")) globalThis.watched.figures.push(target.dataset.figure);
  };
  new MutationObserver(come).observe(document, { subtree: true, attributeFilter: ["class"] });
}

/** From the first moment it is slides, and takes keys; figures come later, that of the slide in view first. */
async function checkFirstMoment(lecture) {
  const context = await browser.newContext({ viewport }),
    page = await context.newPage(),
    begin = (hash) => page.goto(pathToFileURL(resolve(folder, `${lecture}.html`)).href + hash, { waitUntil: "commit" });
  await page.addInitScript(watchFrames);
  await begin("");
  const ready = () => page.waitForFunction(() => document.documentElement.dataset.ready === "true");
  await ready();
  const { frames, notes, headings, figures, whenTurned } = await page.evaluate(() => globalThis.watched);
  assert.equal(await hash(page), "#slide-2");
  assert.ok(figures.length > 10 && frames > 0, lecture);
  assert.ok(whenTurned < figures.length / 2, `${lecture}: keys turned the slide when ${whenTurned} of ${figures.length} figures were made`);
  assert.deepEqual([notes, headings], [0, 1], `${lecture} is a document before it is slides`);
  const last = page.locator(".part:has(.live)").last(),
    [slide, figure] = await last.evaluate((part) => [part.id, part.querySelector(".live").dataset.figure]);
  await page.goto("about:blank");
  await begin(`#${slide}`);
  await ready();
  assert.equal(await page.evaluate(() => globalThis.watched.figures[0]), figure, `${lecture}: the slide in view has its figure first`);
  await context.close();
}

/** The speaker's window: the notes of the slide that is shown, what comes next, a clock; its keys turn the slides. */
async function checkNotes(page, lecture) {
  await go(page, 1);
  await go(page, 2); // anew
  const [notes] = await Promise.all([page.waitForEvent("popup"), page.locator(".lecture-bar button", { hasText: "Notes" }).click()]);
  const said = await page.locator(".on-slide .notes").textContent(),
    next = await page.locator("#slide-3 h2").textContent();
  const plain = (text) => text.replace(/\s+/g, "");
  assert.equal(plain(await notes.locator(".notes-text").textContent()), plain(said), lecture);
  assert.equal(await notes.locator(".notes-next").textContent(), `Next: ${next}`);
  assert.match(await notes.locator(".notes-time").textContent(), /^0:0\d gone; this slide ends at \d+:00, in \d+:\d\d\. Now /);
  assert.equal(
    await notes.evaluate(() => getComputedStyle(document.querySelector(".notes-time")).fontWeight),
    "700",
    "the window has the page's style",
  );
  const before = await toCome(page);
  await notes.keyboard.press("PageDown");
  assert.equal(await toCome(page), before - 1);
  await notes.close();
}

/** Printed: a page a slide, of its size, with the words of every step. */
async function checkPrinted(page, lecture) {
  const pages = pdfPages(await page.pdf({ preferCSSPageSize: true, printBackground: true })),
    plain = (text) => text.normalize("NFKC").replace(/\s/g, "");
  const wanted = await page
    .locator(".part")
    .evaluateAll((parts) =>
      parts.map((part) =>
        [...part.querySelectorAll("h1, h2, .step:not(.figure) :is(p, pre, td, th)")]
          .filter((e) => getComputedStyle(e).display !== "none")
          .map((e) => e.textContent),
      ),
    );
  assert.equal(pages.length, wanted.length, `${lecture} has another number of pages than of slides`);
  for (const [i, { width, height, text }] of pages.entries()) {
    assert.deepEqual([width, height], [768, 576], `${lecture}, page ${i + 1}`);
    for (const words of wanted[i]) assert.ok(plain(text).includes(plain(words)), `${lecture}, page ${i + 1} has no "${words}"`);
  }
  return pages.length;
}

try {
  for (const lecture of lectures) {
    await checkFirstMoment(lecture);
    const page = await at(lecture);
    await checkWords(page, lecture);
    await checkSlides(page, lecture);
    await checkTexels(page, lecture);
    await checkPairs(page, lecture);
    await checkKeys(page, lecture);
    await checkNotes(page, lecture);
    const pages = await checkPrinted(page, lecture);
    for (const slide of [1, 2, 6]) {
      await go(page, slide);
      for (const [colorScheme, rules] of [
        ["light", {}],
        ["dark", colours],
      ]) {
        await page.emulateMedia({ colorScheme });
        assert.deepEqual(await violations(page, rules), [], `axe, ${lecture}, slide ${slide}, ${colorScheme}`);
      }
    }
    await close(page);
    const linked = await at(lecture, { viewport: { width: 1920, height: 1080 } }, "#slide-4");
    assert.equal(await linked.locator(".lecture-bar output").textContent(), `4 of ${pages}`);
    await close(linked);
    const plain = await at(lecture, { javaScriptEnabled: false });
    assert.ok(await plain.locator(".lecture img").first().isVisible());
    await close(plain);
    console.log(`${lecture}: ${pages} slides, 90 minutes`);
  }
} finally {
  await browser.close();
}
