// What the tuner found on one page to print: the answer and its rivals, a column each (studies/tune/sheet.cpp).
import { resultDocument } from "./document";
import { picture, showSections } from "./frame";
import { flowing, markup, type Markup } from "./template";

interface Candidate {
  name: string;
  place: string; // the square of the picture that errs most
  view: string | null; // from where it is seen, of several
  rows: [name: string, text: string][];
  command: string;
  units: { engine: string; setting: string; value: string }[];
}

const figure = (name: string, caption: string): Markup => markup`<figure>${picture(name)}<figcaption>${caption}</figcaption></figure>`;

const column = ({ name, place, view, rows, command, units }: Candidate, i: number): Markup => markup`<section>
<h2>${name}${i === 0 && markup` <abbr title="the answer">★</abbr>`}</h2>
<div class="pair">${figure(`drawn-${i}`, "as drawn")}${figure(`truth-${i}`, "by rays")}</div>
<p class="hint">The place that errs most, ${place}.${view !== null && ` View: ${view}.`}</p>
<table><tbody>${rows.map(([head, text]) => markup`<tr><th scope="row">${head}</th><td>${flowing(text)}</td></tr>\n`)}</tbody></table>
<p class="command"><code>${command}</code></p>
${
  units.length > 0 &&
  markup`<ul>${units.map(({ engine, setting, value }) => markup`<li>${engine} <code>${setting} ${value}</code></li>\n`)}</ul>`
}</section>
`;

export function startSheet(): void {
  const { scene, wanted, candidates } = resultDocument<{ scene: string; wanted: string; candidates: Candidate[] }>();
  showSections([
    {
      id: "sheet",
      link: "",
      html: markup`<section id="sheet" class="sheet" aria-labelledby="sheet-title"><h1 id="sheet-title">Shadows of ${scene}</h1>
<p>Wanted: ${flowing(wanted)}. The star is the answer; the others have at most as much memory for their maps. Texels and taps
hold on every machine, times on this one. Printed, it is one page.</p>
<div class="candidates">
${candidates.map(column)}</div></section>
`,
    },
  ]);
}
