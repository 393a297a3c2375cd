// The lessons' figures in another language: every word in them comes from its table, and a table that lacks one is told which.
import assert from "node:assert/strict";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { differences, words } from "../tools/figure_words.mjs";
import { goTo } from "../browser/open_page.mjs";

const lectures = new URL("../../docs/lectures/", import.meta.url).pathname;

/** Each key between brackets, its values outside of them. */
const marked = () => Object.fromEntries(words().map((key) => [key, `⟦${key.replace(/\{\d+\}/g, "⟧$&⟦")}⟧`]));
const withWords = (html) =>
  html.replace('id="page-data">{', () => `id="page-data">{"figure_words":${JSON.stringify(marked()).replaceAll("<", "\\u003c")},`);

/** Of the live figures what is written, heard or shown beside a slider, and stands outside the brackets. What the report's page has as well
    is left out (the viewer, the chart of every bias, the drawing in light space). */
const strays = (page) =>
  page.evaluate(() => {
    const shared = ".bias-picture, .scroll, .live-drawing, .story, .live-chart .end, [data-name=bias] :is(.bias-bar, .bias-counts)",
      found = [];
    // The same in every language: scenes and what is in them, nodes of a tree, and the unit that the report's numbers have.
    const names = JSON.parse(document.getElementById("page-data").textContent)
      .figures.flatMap((f) => [f?.settings.scene, f?.data.scene])
      .filter((name) => name);
    const same = new RegExp(`⟦[^⟦⟧]*⟧|${names.map((name) => `\\b${name}\\b`).join("|") || "⟦"}|\\b1[a-d]+\\b|\\btexels?\\b`, "g");
    const look = (text, where) => {
      for (const word of (text ?? "").replace(same, " ").match(/\p{L}{3,}/gu) ?? []) found.push(`${where}: ${word}`);
    };
    for (const figure of document.querySelectorAll(".live-figure")) {
      for (const e of figure.querySelectorAll("*")) {
        if (e.closest(shared)) continue;
        for (const name of ["aria-label", "aria-valuetext", "title"]) look(e.getAttribute(name), `${figure.dataset.name} ${name}`);
        for (const node of e.childNodes) if (node.nodeType === Node.TEXT_NODE) look(node.data, figure.dataset.name);
      }
    }
    return [...new Set(found)];
  });

/** Every slider at its end: other words may stand there. */
const toEnds = (page) =>
  page.evaluate(() => {
    for (const input of document.querySelectorAll(".live-figure input[type=range]")) {
      input.value = input.max;
      input.dispatchEvent(new Event("input", { bubbles: true }));
    }
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  });

/** `pages` of the site, which get a copy each beside them. */
export async function checkLanguage(page, site, pages) {
  for (const name of pages) {
    const html = readFileSync(join(site, name), "utf8");
    if (!html.includes('class="live"')) continue;
    const own = `marked-${name}`;
    writeFileSync(join(site, own), withWords(html));
    await goTo(page, site, own);
    const first = await strays(page);
    await toEnds(page);
    assert.deepEqual([...new Set([...first, ...(await strays(page))])], [], `${name}: words that no language can translate`);
  }
  for (const language of readdirSync(lectures, { withFileTypes: true })
    .filter((e) => e.isDirectory() && e.name !== "en")
    .map((e) => e.name))
    assert.deepEqual(
      differences(JSON.parse(readFileSync(join(lectures, language, "figures.json"), "utf8"))),
      { missing: [], extra: [] },
      language,
    );
  const { "Next split": _, ...without } = marked();
  assert.deepEqual(differences({ ...without, "Next slit": "x" }), { missing: ["Next split"], extra: ["Next slit"] });
}
