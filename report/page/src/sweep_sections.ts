// The sections of a sweep's page.
import { resultDocument } from "./document";
import type { Section } from "./frame";
import { byteCount, grouped, milliseconds, percent, plainNumber, timeDifference } from "./number_text";
import { isBeside } from "./parts";
import { paretoChart, sizeChart } from "./sweep_charts";
import {
  inWords,
  isFilmed,
  shadowRange,
  type Configuration,
  type RayPoint,
  type SweepCell,
  type SweepResult,
  type TimeRange,
} from "./sweep_document";
import { flowing, markup, scrollRegion, type Markup } from "./template";
import { viewerBlock } from "./viewer_block";

// "The 24 cells have errors between 0.1 % and 12 %; …"
function sentence({ cells, front }: SweepResult): string {
  if (cells.length === 1)
    return `The one cell leaves ${percent(cells[0]!.wrong_fraction)} wrong, with a mean error of ${percent(cells[0]!.mean_absolute)}.`;
  const [least, most] = [(a: number, b: number) => a < b, (a: number, b: number) => a >= b].map((better) =>
    cells.reduce((best, cell) => (better(cell.error, best.error) ? cell : best)),
  ) as [SweepCell, SweepCell];
  const text = `The ${grouped(cells.length)} cells have errors between ${least.error_words} and ${most.error_words}.`;
  if (front.length === 1) return `${text} One of them is worth having (★): none has a smaller error, and none is clearly faster.`;
  return front.length === 0
    ? text
    : `${text} ${front.length} of them are worth having (★): every cell with a smaller error takes clearly longer.`;
}

function overview(result: SweepResult): Markup {
  const items = result.headline.map(({ title, cell, setting, figures }) =>
    cell === null
      ? markup`<li>${title}.</li>\n`
      : markup`<li><span class="eyebrow">${title}</span> <a href="#cell-${cell}">${flowing(setting)}</a> <span>${flowing(figures)}</span></li>\n`,
  );
  return markup`<section id="overview" aria-labelledby="title"><h1 id="title">Sweep of ${result.configuration.scene.name ?? ""}</h1>
${
  isBeside &&
  markup`<p class="setting beside">The pictures would make this page too large for one file: they lie beside it, in <code>cells</code> and <code>thumbnails</code>. Keep the folder together.</p>\n`
}<p
class="verdict">${sentence(result)}</p>
${items.length > 0 && markup`<ul class="headline">\n${items}</ul>\n`}</section>
`;
}

const grid = (): Markup => markup`<section id="grid" aria-labelledby="grid-title"><h2 id="grid-title">Grid</h2>
<p class="hint">The ray-traced picture in grey; <b class="false-text">orange</b>: drawn dark, truly lit; <b class="missed-text">blue</b>: drawn lit, truly dark.
The number is the share of wrong pixels; ★: worth having.</p>
<div id="grids"></div></section>
`;

// Brought to life, and shown, when a cell is opened.
const cellSection = (): Markup => markup`<section id="cell" aria-labelledby="cell-title" hidden><h2 id="cell-title">One cell</h2>
<p class="lead cell-line"></p>
${viewerBlock(
  null,
  "cell",
  markup`Point at a pixel to read its label. Drag to move the divider, or the picture once it is
enlarged; double-click enlarges. Keys: <kbd>F</kbd> flips, <kbd>+</kbd> <kbd>−</kbd> <kbd>0</kbd> zoom, arrows move, <kbd>Shift</kbd> with arrows steps from pixel to pixel.`,
  false,
)}<p
class="cell-labels"></p>
<p class="command"><code class="cell-command"></code></p></section>
`;

// What the ray tracer's points cost, on this machine and on any.
function rayTable(rays: RayPoint[], samples: number): Markup | null {
  if (rays.length === 0) return null;
  const row = (p: RayPoint): Markup => markup`<tr><th scope="row">${p.name}</th><td class="n">${milliseconds(p.times_ms.median)}</td><td
class="n">${
    p.shadow_times_ms.runs.length === 0 ? "–" : milliseconds(p.shadow_times_ms.median)
  }</td><td class="n">${grouped(p.wrong)}</td><td
class="n">${grouped(p.uncertain)}</td><td class="n">${plainNumber(p.mean_absolute)}</td><td class="n">${grouped(p.rays)}</td><td
class="n">${p.boxes_per_ray.toFixed(1)}</td><td class="n">${p.primitives_per_ray.toFixed(
    1,
  )}</td><td class="n">${byteCount(p.bytes)}</td></tr>\n`;
  return markup`<h3>The ray tracer itself</h3>
${scrollRegion(
  "The ray tracer itself",
  markup`<table class="families"><thead><tr><th scope="col">precision, samples of lights with size</th><th
scope="col" class="n">time</th><th scope="col" class="n">shadows alone</th><th scope="col" class="n">wrong</th><th scope="col" class="n">in doubt</th><th
scope="col" class="n">mean error</th><th scope="col" class="n">rays</th><th scope="col" class="n">boxes per ray</th><th
scope="col" class="n">primitives per ray</th><th scope="col" class="n">structure</th></tr></thead><tbody>
${rays.map(row)}</tbody></table>`,
)}<p class="hint">Camera and shadow rays of the first cell's picture, against exact precision with ${samples} samples.</p>
`;
}

function cost(result: SweepResult): Markup {
  const { cells, rays } = result,
    pareto = paretoChart(result),
    sizes = sizeChart(result);
  return markup`<section id="cost" aria-labelledby="cost-title"><h2 id="cost-title">What accuracy costs</h2>
${
  pareto &&
  markup`<h3>Error against time</h3>
<figure>${scrollRegion(
    "Error against time",
    pareto,
  )}<figcaption>Each cell is a point and opens its pictures. Error: ${result.measure.words}. ${
    result.front.length > 0 &&
    `The line joins those that are faster than every cell with
a smaller error, by more than the times' spread. `
  }${
    rays.length > 0
      ? "The diamonds are the ray tracer itself."
      : `The diamond is the ray tracer, whose shadows are the truth here; ${milliseconds(
          cells[0]!.exact_shadow_ms ?? NaN,
        )} of its time are its shadows.`
  }${
    cells.some(({ derived }) => derived) && " Cells that differ in the constant bias alone come from one drawing and share its time."
  }</figcaption></figure>
`
}${
    sizes &&
    markup`<h3>Error against map size</h3>
<figure>${scrollRegion("Error against map size", sizes)}<figcaption>The best cell of each technique and size.${
      result.measure.shares &&
      " Where the map's sampling is all that is wrong, the error falls along the dotted line: half of it at twice the size."
    }</figcaption></figure>
`
  }${rayTable(rays, result.reference_samples)}</section>
`;
}

/** A column of numbers, which sorting goes by. */
interface Column {
  name: string;
  value: (cell: SweepCell) => number | null;
  text: (cell: SweepCell, value: number) => string; // of a value; none is a dash
}
const column = (name: string, value: Column["value"], text: (value: number) => string): Column => ({
  name,
  value,
  text: (_, v) => text(v),
});

const rangeText = ([low, median, high]: TimeRange): string =>
  low === undefined ? "not timed" : timeDifference({ low, median: median!, high: high!, told: low > 0 });

const forms = { count: grouped, percent, number: plainNumber };

// The figures, those of pixels that are wrong before the rest, and then what it costs.
function columns(result: SweepResult): [before: Column[], after: Column[]] {
  const figures = result.columns.map(({ key, head, form }) =>
    column(head, (c) => (c as unknown as Record<string, number | null>)[key]!, forms[form]),
  );
  const kinds = result.columns.findIndex(({ form }, k) => form === "count" && result.columns[k + 1]?.form !== "count") + 1;
  return [
    figures.slice(0, kinds),
    [
      ...figures.slice(kinds),
      column("time", (c) => c.raster_ms, milliseconds),
      ...result.situations.map(({ key, words }): Column => ({
        name: `shadows, ${words}`,
        value: (cell) => shadowRange(cell, key, "map")[1] ?? null,
        text: (cell) => `${rangeText(shadowRange(cell, key, "map"))} by map, ${rangeText(shadowRange(cell, key, "rays"))} by rays`,
      })),
      column("texels drawn", (c) => c.map_texels, grouped),
      column("map memory", (c) => c.map_bytes, byteCount),
    ],
  ];
}

function cellTable(result: SweepResult): Markup {
  const { axes, cells } = result,
    [before, after] = columns(result),
    head = (name: string, words = false): Markup => markup`<th scope="col"${!words && markup` class="n"`}>${name}</th>`;
  const number =
    (cell: SweepCell) =>
    ({ value, text }: Column): Markup => {
      const v = value(cell);
      return markup`<td class="n" data-sort="${v}">${v === null ? "–" : text(cell, v)}</td>`;
    };
  const row = (cell: SweepCell): Markup => markup`<tr id="cell-${cell.cell}"${
    cell.front && markup` class="front-row"`
  }><th scope="row" class="n" data-sort="${cell.cell}"><a
href="#cell-${cell.cell}">${cell.cell}</a>${cell.front && markup` <abbr title="worth having">★</abbr>`}</th>${axes.map(
    (axis, k) =>
      markup`<td class="n" data-sort="${cell.values[k]}">${cell.shown[k]}${cell.no_effect.includes(axis) && " (no effect)"}</td>`,
  )}${before.map(number(cell))}<td>${cell.mostly}</td>${after.map(number(cell))}<td class="run"><code>${cell.command}</code></td></tr>\n`;
  return markup`<section id="cells" aria-labelledby="cells-title"><h2 id="cells-title">Cells</h2>
<p class="hint">Each cell is one combination of settings. ★: worth having. Time is that of map and shading. Shadows are
what they add to a frame, by what has moved since the last one: ${result.situations
    .map(({ words, made }) => `${words} (${made})`)
    .join(", ")}. Errors of visibility are between 0 and 1.</p>
<div class="scroll" role="region" tabindex="0" aria-label="Table of cells"><table class="cells"><thead><tr>${head("cell")}${axes.map((axis) => head(inWords(axis)))}${before.map(
    ({ name }) => head(name),
  )}${head("mostly", true)}${after.map(({ name }) => head(name))}${head("command", true)}</tr></thead><tbody>
${cells.map(row)}</tbody></table></div></section>
`;
}

const valuesText = (values: string[]): string =>
  values.length > 12 ? `${values.length} values from ${values[0]} to ${values.at(-1)}` : values.join(", ");

function settings({ scene, options, measure, film, axes = [], ...rest }: Configuration): [string, string][] {
  const words = (value: unknown): string => (typeof value === "string" ? value : JSON.stringify(value));
  const named: [string, unknown][] = [
    ["Runs of each pass", rest.runs],
    ["seed", rest.seed],
    ["exposure", rest.exposure],
  ];
  return [
    ...(
      [
        ["Scene", scene.path ?? ""],
        ["SHA-256 of the scene file", scene.sha256 ?? ""],
      ] as [string, string][]
    ).filter(([, text]) => text !== ""),
    ...Object.entries(options).map(([name, value]): [string, string] => [`--${name}`, words(value)]),
    ...(measure || film ? [["--measure", measure ?? "shimmer"] as [string, string]] : []),
    ...Object.entries(film ?? {}).map(([name, value]): [string, string] => [
      name === "sha256" ? "SHA-256 of the path's file" : `--${name}`,
      value,
    ]),
    ...named.filter(([, value]) => value !== null && value !== undefined).map(([name, value]): [string, string] => [name, words(value)]),
    ...axes.map(({ name, values }): [string, string] => [`Swept: --${name}`, valuesText(values)]),
  ];
}

const provenance = ({
  version,
  configuration,
  load,
}: SweepResult): Markup => markup`<section id="provenance" aria-labelledby="provenance-title"><h2
id="provenance-title">Where this comes from</h2>
<dl class="provenance">
${[
  ["Program", `gnomon ${version}`],
  ...settings(configuration),
  ...(load ? [["Load of the machine", load.map(plainNumber).join(" to ")] as [string, string]] : []),
].map(([name, value]) => markup`<div><dt>${name}</dt><dd>${value}</dd></div>\n`)}</dl>
<p class="save"><a class="button" href="sweep.csv">sweep.csv</a> <a class="button" href="sweep.jsonl">sweep.jsonl</a> <a class="button" href="sweep_times.jsonl">sweep_times.jsonl</a></p></section>
`;

export function sweepSections(): Section[] {
  const result = resultDocument<SweepResult>();
  return [
    { id: "overview", link: "", html: overview(result) },
    ...(result.axes.length > 0 ? [{ id: "grid", link: "Grid", html: grid() }] : []),
    { id: "cell", link: "", html: cellSection() },
    { id: "cost", link: "Cost", html: cost(result) },
    { id: "cells", link: "Cells", html: cellTable(result) },
    { id: "provenance", link: "Provenance", html: provenance(result) },
  ];
}

/** "4.1 % wrong, mean error 4.1 %: false shadow 12, missed shadow 3, mostly acne; 12 ms …" */
export const cellLine = (cell: SweepCell): string =>
  `${
    isFilmed(cell) ? `${cell.error_words}; ` : ""
  }${percent(cell.wrong_fraction)} wrong, mean error ${percent(cell.mean_absolute)}: false shadow ${grouped(cell.false_shadow)}, missed shadow ${grouped(
    cell.missed_shadow,
  )}${cell.mostly && `, mostly ${cell.mostly}`}${cell.raster_ms === null ? "" : `; ${milliseconds(cell.raster_ms)} for map and shading`}`;
