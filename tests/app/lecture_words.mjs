// What a slide says by itself: every symbol of its formulas is named on it or in its figure, and what was cut from a lesson stands
// alone, since nobody in the room has read what stood before it.
import assert from "node:assert/strict";

/** In the page: of each slide its formulas, its sentences, and all other words on it, those in drawings one by one. */
function slideWords() {
  const text = (element) => element.textContent.trim(),
    drawn = (image) => {
      const [head, body] = image.src.split(",");
      if (!head.startsWith("data:image/svg+xml")) return [];
      const svg = new TextDecoder().decode(Uint8Array.from(atob(body), (c) => c.charCodeAt(0)));
      return [...svg.matchAll(/<text[^>]*>([^<]*)</g)].map(([, words]) => words);
    };
  return [...document.querySelectorAll(".part")].map((part) => ({
    slide: part.id,
    heading: text(part.querySelector("h1, h2")),
    formulas: [...part.querySelectorAll(".step.formula pre")].map((pre) => pre.textContent),
    sentences: [...part.querySelectorAll(".step.sentence")].filter((step) => !step.previousElementSibling?.matches(".question")).map(text),
    words: [...part.querySelectorAll("h2, .step:not(.formula) :is(p, td, th)")].map(text),
    labels: [
      ...[...part.querySelectorAll("svg text")].map(text),
      ...[...part.querySelectorAll(".step.figure img")].filter((image) => !image.closest(".is-live")).flatMap(drawn),
    ],
  }));
}

const symbol = /(?<!')[\p{L}][\p{L}\p{M}0-9₀-₉_]*/gu;
/** A word of English, or the name of a function: three letters or more and nothing but letters; or one of these. */
const isWord = (token) => /^\p{L}{3,}$/u.test(token) || ["of", "or", "on", "by", "it", "in", "is", "if", "to", "at", "go"].includes(token);

/** The symbols of a formula, but for those that it gives a value to: "t = n·(p − o) / (n·d)" leaves n, p, o and d. */
export function symbolsOf(formula) {
  const given = [...formula.matchAll(/(?<![\p{L}\p{M}·+−/(] ?)([\p{L}][\p{L}\p{M}0-9₀-₉_]*)(?:\([^)]*\))?\s+=\s/gu)].map(
    ([, name]) => name,
  );
  for (const [, tuple] of formula.matchAll(/^\s*\(([^()]*)\)\s+=\s/gmu)) given.push(...tuple.match(symbol));
  // "of a pixel": an article.
  const found =
    formula
      .replaceAll("ⁿ", " n ")
      .replace(/\ba (?=\p{L}{3})/gu, "")
      .match(symbol) ?? [];
  return [...new Set(found)].filter((token) => !isWord(token) && !given.includes(token));
}

/** Whether some words, or a label of a drawing, say the symbol. "a" and "A" are articles but where something is said of them;
 *  of "dx" it is x. */
export function isNamed(token, words, labels) {
  if (/^d[a-z]$/.test(token) && isNamed(token[1], words, labels)) return true;
  const alone = new RegExp(`(?<![\\p{L}\\p{N}_])${token}(?![\\p{L}\\p{M}\\p{N}_])`, "u"),
    said = /^[aA]$/.test(token) ? new RegExp(`(?<![\\p{L}])${token} (is|are|and [bB]|the|near)\\b`, "u") : alone;
  return words.some((text) => said.test(text)) || labels.some((text) => alone.test(text));
}

const pronoun = /^(It|They|Them|This|That|These|Those|Its|Their|He|She|Such)\b/;

/** What is wrong with each slide, as lines. */
export function faultsOf({ slide, heading, formulas, sentences, words, labels }) {
  const nameless = [...new Set(formulas.flatMap(symbolsOf))].filter((token) => !isNamed(token, words, labels)),
    leaning = sentences.filter((text) => pronoun.test(text) || /:$/.test(text) || /\b(above|below|that centre)\b/.test(text));
  return [
    ...(nameless.length > 0 ? [`${slide}, ${heading}: nothing says what ${nameless.join(", ")} is`] : []),
    ...leaning.map((text) => `${slide}, ${heading}: does not stand alone: ${text}`),
  ];
}

export async function checkWords(page, lecture) {
  // The check sees what it is for.
  assert.deepEqual(symbolsOf("t = n·(p − o) / (n·d)"), ["n", "p", "o", "d"]);
  assert.deepEqual(symbolsOf("(X, Y) = M·(x, 1)\nu = ½ + ½·X/W"), ["M", "x", "W"]);
  assert.ok(isNamed("w", ["Here w is the wall"], []) && !isNamed("w", ["a wall wide"], []) && !isNamed("a", ["a wall"], []));
  const slides = await page.evaluate(slideWords);
  assert.ok(slides.some(({ formulas }) => formulas.length > 0) && slides.some(({ labels }) => labels.length > 0), lecture);
  assert.deepEqual(slides.flatMap(faultsOf), [], lecture);
}
