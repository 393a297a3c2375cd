// The lessons as a site, in a real browser: every page is text, pictures and nothing from outside; fits a phone; has no
// accessibility violation, light or dark; its slides turn by arrow keys; and its live figures say what the program says.
// Needs what report_browser_test needs, and OpenGL in software. Usage: node lessons_browser_test.mjs GNOMON_PROGRAM
// WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import { browser, checkAccessibility, checkPhone, close, open } from "./browser/open_page.mjs";

const [program, folder] = process.argv.slice(2), site = join(folder, "site");
rmSync(folder, { recursive: true, force: true });
execFileSync(program, ["lessons", "-o", site, "--quiet"], { stdio: "inherit" });
const pages = readdirSync(site), lessons = JSON.parse(execFileSync(program, ["scenes", "--json", "-"])).lessons.map(({ name }) => name);
assert.deepEqual([...pages].sort(), ["index.html", ...lessons.map((name) => `${name}.html`)].sort());
const bytes = pages.reduce((sum, page) => sum + statSync(join(site, page)).size, 0);
assert.ok(bytes < 30e6, `the site weighs ${bytes} bytes`);

const at = (page, options = {}, hash = "") => open(site, { file: page, ...options }, hash);

/** Every link within the site leads to one of its pages; every picture is there. */
async function checkContent(name) {
  const page = await at(name);
  const links = await page.locator("a[href]").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
  for (const link of links.filter((l) => !l.startsWith("#") && !l.includes("://"))) assert.ok(pages.includes(link), `${name} links to ${link}`);
  const broken = await page.locator("img").evaluateAll((all) => all.filter((i) => i.complete && i.naturalWidth === 0).map((i) => i.alt));
  assert.deepEqual(broken, [], name);
  assert.equal(await page.locator("h1").count(), 1, name);
  const text = await page.locator("main").textContent();
  assert.ok(!/```|\]\(|<!--/.test(text), `${name} shows Markdown`);
  await close(page);
}

/** From the first slide to the last by keys; each shows something and fits the screen. */
async function checkSlides(name) {
  const page = await at(name);
  await page.click(".open-slides");
  await page.waitForFunction(() => location.hash === "#slide-1");
  const count = Number((await page.locator(".slide-bar output").textContent()).replace(/^1 of /, ""));
  assert.ok(count >= 3, `${name} has ${count} slides`);
  for (let slide = 1; slide <= count; ++slide) {
    await page.waitForFunction((n) => location.hash === `#slide-${n}`, slide);
    const { seen, over } = await page.evaluate(() => {
      const part = document.querySelector(".part.on-slide");
      return { seen: [...part.children].filter((e) => e.getClientRects().length > 0).length,
        over: Math.max(part.scrollHeight - part.clientHeight, part.scrollWidth - part.clientWidth) };
    });
    assert.ok(seen >= 1, `${name}, slide ${slide} is empty`);
    assert.ok(over <= 0, `${name}, slide ${slide} is ${over} pixels too large`);
    await page.keyboard.press("ArrowRight");
  }
  await page.keyboard.press("Home");
  await page.waitForFunction(() => location.hash === "#slide-1");
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.documentElement.dataset.view === "page");
  await close(page);
}

try {
  for (const page of pages) {
    await checkContent(page);
    await checkAccessibility(site, { file: page });
    await checkPhone(site, { file: page });
  }
  for (const lesson of lessons) await checkSlides(`${lesson}.html`);
  const linked = await at("acne.html", {}, "#slide-2");
  assert.equal(await linked.locator(".slide-bar output").textContent().then((text) => text.slice(0, 5)), "2 of ");
  await checkAccessibility(site, { file: "acne.html" }, "#slide-2");
  await close(linked);
  const plain = await at("acne.html", { javaScriptEnabled: false });
  assert.ok(await plain.locator(".lesson-text img").first().isVisible());
  await close(plain);
  console.log(`${pages.length} pages, ${(bytes / 1e6).toFixed(1)} MB`);
} finally {
  await browser.close();
}
