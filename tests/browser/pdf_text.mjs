// The words on each page of a PDF as Chromium prints it: its streams are deflated, its fonts say by a ToUnicode map which
// letters their glyphs are. Glyphs are set one by one, so that the words are compared without the spaces between them.
import { inflateSync } from "node:zlib";

function objectsOf(bytes) {
  const text = bytes.toString("latin1"),
    objects = new Map();
  for (const match of text.matchAll(/(\d+) 0 obj\s/g)) {
    const start = match.index + match[0].length,
      end = text.indexOf("endobj", start),
      stream = text.indexOf("stream", start);
    const head = text.slice(start, stream > 0 && stream < end ? stream : end),
      data = stream > 0 && stream < end ? stream + (text[stream + 6] === "\r" ? 8 : 7) : 0;
    const length = Number(/\/Length (\d+)(?! 0 R)/.exec(head)?.[1] ?? 0);
    const raw = data > 0 ? bytes.subarray(data, data + length) : null;
    objects.set(Number(match[1]), {
      head,
      stream: raw && /FlateDecode/.test(head) ? inflateSync(raw).toString("latin1") : raw?.toString("latin1"),
    });
  }
  return objects;
}

const letter = (hex) => String.fromCodePoint(...hex.match(/.{4}/g).map((code) => parseInt(code, 16)));

/** Glyph to letters, of a font's ToUnicode map. */
function lettersOf(cmap) {
  const letters = new Map();
  for (const [, body] of cmap.matchAll(/beginbfchar([\s\S]*?)endbfchar/g))
    for (const [, glyph, hex] of body.matchAll(/<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>/g)) letters.set(parseInt(glyph, 16), letter(hex));
  for (const [, body] of cmap.matchAll(/beginbfrange([\s\S]*?)endbfrange/g))
    for (const [, first, last, hex] of body.matchAll(/<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>/g))
      for (let glyph = parseInt(first, 16), code = parseInt(hex, 16); glyph <= parseInt(last, 16); ++glyph, ++code)
        letters.set(glyph, String.fromCodePoint(code));
  return letters;
}

/** [{ width, height, text }], in points and letters without spaces, in the order of the pages. */
export function pdfPages(bytes) {
  const objects = objectsOf(bytes),
    all = [...objects.values()],
    maps = new Map();
  const inner = (head, key) => new RegExp(`/${key} (\\d+) 0 R`).exec(head)?.[1];
  const fontOf = (number) => {
    if (!maps.has(number)) maps.set(number, lettersOf(objects.get(Number(inner(objects.get(number).head, "ToUnicode")))?.stream ?? ""));
    return maps.get(number);
  };
  return all
    .filter(({ head }) => /\/Type \/Page\b(?!s)/.test(head))
    .map(({ head }) => {
      const [, , width, height] = /\/MediaBox \[([\d. ]+)\]/.exec(head)[1].split(" ").map(Number);
      const resources = inner(head, "Resources") ? objects.get(Number(inner(head, "Resources"))).head : head;
      const fonts = new Map(
        [...(/\/Font\s*<<([\s\S]*?)>>/.exec(resources)?.[1].matchAll(/\/(\w+) (\d+) 0 R/g) ?? [])].map(([, name, number]) => [
          name,
          Number(number),
        ]),
      );
      let text = "",
        font = new Map();
      for (const [, name, array, hex] of objects
        .get(Number(inner(head, "Contents")))
        .stream.matchAll(/\/(\w+) [\d.-]+ Tf|\[([^\]]*)\]\s*TJ|<([0-9A-Fa-f]+)>\s*Tj/g)) {
        if (name) font = fontOf(fonts.get(name));
        for (const glyphs of hex ? [hex] : array ? [...array.matchAll(/<([0-9A-Fa-f]+)>/g)].map(([, h]) => h) : [])
          text += glyphs
            .match(/.{4}/g)
            .map((glyph) => font.get(parseInt(glyph, 16)) ?? "")
            .join("");
      }
      return { width, height, text: text.replace(/\s/g, "") };
    });
}
