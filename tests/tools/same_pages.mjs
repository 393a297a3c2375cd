// Compares two pages as readers see them: every number with its key, and every line of text, in order. Times, of which no
// two runs have the same, are masked, and so are the program's revision and what --mask names; the stages of the run are left
// out, and so are bars of times. Drawings may differ by a rounding of their coordinates. Needs what the browser tests need (tests/browser).
// Usage: node same_pages.mjs OLD.html NEW.html [--mask TEXT]... [--hash HASH]; exit 1 where they differ.
import { basename, dirname } from "node:path";
import { browser, open } from "../browser/open_page.mjs";

const words = process.argv.slice(2),
  files = [],
  masks = [];
let hash = "";
while (words.length > 0) {
  const word = words.shift();
  if (word === "--mask") masks.push(words.shift());
  else if (word === "--hash") hash = words.shift();
  else files.push(word);
}

const time = /(less than )?[\d.,]+(e[+-]\d+)?( to [\d.,]+)?[\s\u00a0](ms|s)\b( \([^)]*\))?/g;
const plain = (text) =>
  masks
    .reduce((shown, mask) => shown.replaceAll(mask, "…"), text)
    .replaceAll("\u00a0", " ")
    .replaceAll(time, "TIME")
    .replaceAll(/\b\d+ runs?\b/g, "RUNS")
    .replaceAll(/\+[0-9a-f]{12}(\.changed)?/g, "")
    .replaceAll(/\s+/g, " ")
    .trim();

async function contents(file) {
  const page = await open(dirname(file), { beside: true, file: basename(file) }, hash);
  await page.evaluate(() => new Promise((done) => setTimeout(done, 500)));
  await page.evaluate(() =>
    document.querySelectorAll("#cost table:has(td.wide) td.wide svg, #cost table:has([data-key^=time_budget])").forEach((e) => e.remove()),
  );
  const found = await page.evaluate(() => ({
    title: [document.title],
    bar: [...document.querySelectorAll("nav a")].map((a) => `${a.getAttribute("href")} ${a.textContent}`),
    numbers: [...document.querySelectorAll("data[data-key]")].map((e) =>
      /times_ms|time_budget|process\./.test(e.dataset.key) ? `${e.dataset.key}` : `${e.dataset.key} ${Number(e.value)} ${e.textContent}`,
    ),
    headings: [...document.querySelectorAll("main :is(h1, h2, h3, h4, summary, caption)")].map((e) => `${e.tagName} ${e.textContent}`),
    pictures: [...document.querySelectorAll("main img")].map(
      (e) => `${e.id} ${e.className} ${e.alt} ${e.width} ${e.height} ${e.naturalWidth} ${e.closest("section").id}`,
    ),
    charts: [...document.querySelectorAll("main svg:is(.chart, .bar, .scale) *, main svg.chart")].map(
      (e) =>
        `${e.tagName} ${[...e.attributes]
          .map(({ name, value }) => `${name}=${value.replaceAll(/-?[\d.]+/g, (n) => String(Math.round(Number(n) - 0.25)))}`)
          .sort()
          .join(" ")} ${e.children.length === 0 ? e.textContent : ""}`,
    ),
    swatches: [...document.querySelectorAll("main .swatch")].map((e) => `${e.firstChild.getAttribute("fill")} ${e.textContent}`),
    ids: [...document.querySelectorAll("main [id]")].map((e) => e.id),
    classes: [
      ...new Set([...document.querySelectorAll("main [class]")].flatMap((e) => [...e.classList].map((c) => `${e.tagName}.${c}`))),
    ].sort(),
    regions: [...document.querySelectorAll("main [role=region]")].map((e) => e.getAttribute("aria-label")),
    cells: [...document.querySelectorAll("main table")]
      .map((e) =>
        [...e.rows]
          .map((row) => [...row.cells].map((c) => `${c.tagName}.${c.className}[${c.colSpan}] ${c.textContent}`).join(" | "))
          .join("\n"),
      )
      .join("\n")
      .split("\n"),
    text: document.body.innerText.split("\n").filter((line) => line.trim() !== ""),
    width: [String(document.documentElement.scrollWidth)],
  }));
  for (const key of Object.keys(found)) found[key] = found[key].map(plain);
  found.offences = page.offences;
  await page.context().close();
  return found;
}

try {
  const [old, now] = [await contents(files[0]), await contents(files[1])];
  let differences = 0;
  for (const key of Object.keys(old)) {
    const length = Math.max(old[key].length, now[key].length);
    let said = 0;
    for (let i = 0; i < length; ++i)
      if (old[key][i] !== now[key][i]) {
        ++differences;
        if (++said <= 6) console.log(`${key} ${i}:\n  old ${old[key][i]}\n  new ${now[key][i]}`);
      }
    console.log(`${key}: ${now[key].length}, ${said === 0 ? "as before" : `${said} differ`}`);
  }
  process.exitCode = differences > 0 ? 1 : 0;
} finally {
  await browser.close();
}
