// The words of the lessons' live figures, as a table for another language (docs/lectures/README.md): every English sentence that
// report/page/src/lessons has in say("…"), say`…` or many(n, "…", "…"), and lab/lessons/site.cpp in said("…"). Usage:
// node figure_words.mjs [FIGURES.json]: without a file the table is printed, with one what is missing in it and what is too much
// is named, and the exit code is 1 where there is any.
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const folder = fileURLToPath(new URL("../../report/page/src/lessons/", import.meta.url));
const site = new URL("../../lab/lessons/site.cpp", import.meta.url);

/** The template that begins at a place behind its `, as a key; what its ${…} have is read as well, by the search of words(). */
function templateKey(text, from) {
  let key = "",
    at = from,
    values = 0;
  while (text[at] !== "`") {
    if (!text.startsWith("${", at)) {
      key += text[at++];
      continue;
    }
    key += `{${values++}}`;
    at = endOfValue(text, at + 2) + 1;
  }
  return key;
}
/** Where the } is that ends a value, past strings and templates in it. */
function endOfValue(text, from) {
  let at = from;
  for (let depth = 1; ; ++at) {
    if (text[at] === '"') at = text.indexOf('"', at + 1);
    else if (text[at] === "`")
      for (++at; text[at] !== "`"; ++at) {
        if (text.startsWith("${", at)) at = endOfValue(text, at + 2);
      }
    else if (text[at] === "{") ++depth;
    else if (text[at] === "}" && --depth === 0) return at;
  }
}

/** All keys, sorted. */
export function words() {
  const keys = new Set();
  for (const file of readdirSync(folder).filter((name) => name.endsWith(".ts") && name !== "say.ts")) {
    const text = readFileSync(folder + file, "utf8");
    for (const { index, 0: begin } of text.matchAll(/\bsay`/g)) keys.add(templateKey(text, index + begin.length));
    for (const [, key] of text.matchAll(/\bsay\(\s*"([^"]*)",?\s*\)/g)) keys.add(key);
    for (const [, one, several] of text.matchAll(/\bmany\([^;]*?,\s+"([^"]*)",\s+"([^"]*)",?\s*\)/g)) keys.add(one).add(several);
    // Pairs that many() is given by a name: [one, several].
    for (const [, one, several] of text.matchAll(/\["([a-z]+)", "([a-z]+)"\](?=\s+:|,?\s+[a-z]+: \[|;|,?\s+\}|,?\s*\);)/g))
      keys.add(one).add(several);
  }
  for (const [, key] of readFileSync(site, "utf8").matchAll(/\bsaid\(\s*"([^"]*)"\s*\)/g)) keys.add(key);
  return [...keys].sort();
}
/** What a language's table lacks, and what it has that no figure says. */
export function differences(table) {
  const keys = words();
  return { missing: keys.filter((key) => !table[key]), extra: Object.keys(table).filter((key) => !keys.includes(key)) };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const file = process.argv[2];
  if (!file) console.log(JSON.stringify(Object.fromEntries(words().map((key) => [key, ""])), null, 1));
  else {
    const { missing, extra } = differences(JSON.parse(readFileSync(file, "utf8")));
    for (const key of missing) console.log(`missing: ${key}`);
    for (const key of extra) console.log(`too much: ${key}`);
    process.exit(missing.length + extra.length > 0 ? 1 : 0);
  }
}
