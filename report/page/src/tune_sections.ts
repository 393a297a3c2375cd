// What the tuner says before the comparison at its answer. That is the answer, what accuracy costs, the runners-up with the
// reasons, and how the error of each kind of bias depends on the bias (studies/tune/page.cpp).
import { chartFrame, ChartLabels, chartSvg, fixed, leastError, LogPlot, logTicks, chartText } from "./log_chart";
import { general, milliseconds, percent, plainNumber } from "./number_text";
import { niceTicks } from "./svg";
import { flowing, markup, scrollRegion, type Markup } from "./template";

interface Family {
  name: string;
  technique: string;
  why: string;
  command: string;
  size: number | null; // texels; null without a map
  bias: string | null; // in the unit that the command asks for it in; null: none is read
  words: string; // its figures
  wrong_fraction: number;
  mean_absolute: number;
  figure: number; // of the measure
  time_ms: number;
}

interface Tried {
  family: number;
  size: number | null;
  error: number;
  time_ms: number;
  words: string;
  answer: boolean;
}

interface BiasLine {
  family: number;
  size: number;
  good: boolean; // its family has an answer
  cost: number;
  error: number;
  texels: number[]; // biases
  shares: number[]; // wrong at each
  best_texels: number;
  best_share: number;
}

export interface TuneFacts {
  scene: string;
  wanted: string;
  feasible: boolean;
  max_error: number | null; // one of the two is given
  max_time_ms: number | null;
  shares: boolean; // what the goal is about is a share of the pixels, or their mean error
  head: string; // of its column; empty where the others have it
  films: boolean; // of films
  renders: number;
  proof: string; // why no constant bias can be right everywhere; empty where it can
  proof_has_both: boolean; // it names a least and a largest bias
  families: Family[]; // the answer's, or the nearest, first; then best first
  tried: Tried[];
  lines: BiasLine[];
}

function verdict({ wanted, feasible, max_error: byError, families: [winner] }: TuneFacts): string {
  const { name, size, bias, words, time_ms: time } = winner!;
  const answer = `${name}${size === null ? "" : `, ${size} × ${size} texels`}${
    bias === null ? "" : `, bias ${bias}`
  }. Compared as below it gives ${words}, in ${milliseconds(time)}.`;
  if (!feasible) return `Wanted: ${wanted}. Nothing that was tried gives that. Nearest comes ${answer}`;
  return `Wanted: ${wanted}. ${byError === null ? "The best within it" : "The cheapest that gives it"}: ${answer}`;
}

// Where the two sets of pixels are seen.
const proofLine = ({ proof, proof_has_both }: TuneFacts): Markup | null =>
  proof === ""
    ? null
    : markup`<p class="lead">${flowing(proof)}${
        proof_has_both &&
        markup` In the picture of differences below the first are those that turn
<b class="false-text">orange</b> when the bias is dragged to the left of that, the second those that turn
<b class="missed-text">blue</b> to the right of it.`
      }</p>\n`;

// Cheapest first.
function frontOf(tried: Tried[]): Tried[] {
  const front: Tried[] = [];
  for (const one of [...tried].sort((a, b) => a.time_ms - b.time_ms || a.error - b.error))
    if (front.length === 0 || one.error < front.at(-1)!.error) front.push(one);
  return front;
}

/** The error wanted small against milliseconds: every map that was tried, and the goal. Null where too little was timed. */
function costChart({ tried, families, max_error, max_time_ms, shares }: TuneFacts): Markup | null {
  if (tried.length < 2) return null;
  const times = tried.map(({ time_ms }) => time_ms).concat(max_time_ms ?? []),
    errors = tried.map(({ error }) => error).concat(max_error !== null && max_error > 0 ? max_error : []);
  const least = leastError(errors),
    front = frontOf(tried),
    labels = new ChartLabels();
  const plot = new LogPlot(
    Math.min(...times) / 1.15,
    Math.max(...times) * 1.15,
    least,
    Math.max(4 * least, 1.3 * Math.max(...errors)),
    shares,
  );
  const at = (one: Tried): [number, number] => [plot.x(one.time_ms), plot.y(one.error)];
  // The answer first, whose label finds its place before all others. It may be none of the front's: where times differ by
  // their noise alone, others decide.
  const named = [...tried.filter(({ answer }) => answer), ...front.filter(({ answer }) => !answer)];
  front.forEach((one, i) => labels.keepLineFree(...at(one), ...at(front[Math.min(i + 1, front.length - 1)]!)));
  for (const one of named) labels.keepFree(...at(one), one.answer ? 11 : 8);
  const line = (x0: number, y0: number, x1: number, y1: number): Markup =>
    markup`<line class="used" x1="${fixed(x0)}" y1="${fixed(y0)}" x2="${fixed(x1)}" y2="${fixed(y1)}"/>`;
  const goal = (): Markup => {
    const right = LogPlot.width - LogPlot.right;
    if (max_time_ms === null)
      return markup`${line(
        LogPlot.left,
        plot.y(max_error!),
        right,
        plot.y(max_error!),
      )}${chartText(right, plot.y(max_error!) - 5, "note end", "wanted")}`;
    return markup`${line(
      plot.x(max_time_ms),
      LogPlot.top,
      plot.x(max_time_ms),
      LogPlot.height - LogPlot.bottom,
    )}${chartText(plot.x(max_time_ms) - 6, LogPlot.top + 10, "note end", "wanted")}`;
  };
  const dot = (one: Tried, best: boolean): Markup =>
    markup`<circle class="dot${best && " best-dot"}" cx="${fixed(at(one)[0])}" cy="${fixed(at(one)[1])}" r="${
      one.answer ? 8 : best ? 5 : 3.5
    }"><title>${families[one.family]!.name}${one.size === null ? "" : `, ${one.size} texels`}: ${one.words}; ${milliseconds(one.time_ms)}</title></circle>`;
  return chartSvg(
    "Error against time, each map tried a point, the best of them joined",
    markup`${chartFrame(plot, logTicks(plot.minX, plot.maxX), "milliseconds for map and shading")}${goal()}<polyline
class="curve front" points="${front.map((one) => at(one).map(fixed).join(",")).join(" ")}"/>${tried.map((one) => dot(one, false))}${named.map((one) => dot(one, true))}${named.map(
      (one) => labels.place(...at(one), `${families[one.family]!.technique} ${one.size ?? ""}`.trim()),
    )}`,
  );
}

const width = 980,
  height = 360,
  left = 58,
  right = width - 342,
  top = 20,
  bottom = height - 48;
const leader = 16; // from a line's end to its name
const mostTexels = 4; // of bias, on the chart
const mostLines = 6; // line-0 … in report.css; more could not be told apart

/** Wrong pixels against the constant bias, in texels, of every family whose gaps tell it. */
function biasChart({ lines, families }: TuneFacts): Markup | null {
  // What is good enough, by its cost, and then the rest, by its error.
  const shown = [...lines]
    .sort((a, b) => Number(b.good) - Number(a.good) || (a.good ? a.cost - b.cost : a.error - b.error))
    .slice(0, mostLines);
  if (shown.length === 0) return null;
  // The worst that stands on a curve beyond its beginning sets the scale: a bias of 0 would flatten all.
  const highest = Math.max(1e-9, 1.05 * Math.max(0, ...lines.flatMap(({ texels, shares }) => shares.filter((_, k) => texels[k]! >= 0.25))));
  const x = (texels: number): number => left + (texels / mostTexels) * (right - left);
  const y = (share: number): number => bottom - Math.min(share / highest, 2) * (bottom - top);
  const lastShown = ({ texels, shares }: BiasLine): number => {
    const beyond = texels.findIndex((bias, k) => k > 0 && bias > mostTexels);
    return shares[(beyond < 0 ? texels.length : beyond) - 1]!;
  };
  // The names stand at the lines' right ends, moved apart.
  const placed = shown.map((line, i) => ({ line, i, end: Math.max(top, y(lastShown(line))), label: 0 }));
  const order = [...placed].sort((a, b) => a.end - b.end);
  order.forEach((one, k) => {
    one.label = Math.max(one.end, k === 0 ? top + 8 : order[k - 1]!.label + 17);
  });
  const excess = Math.max(0, order.at(-1)!.label - bottom);
  const curve = ({ line, i, end, label }: (typeof placed)[number]): Markup =>
    markup`<g clip-path="url(#tune-clip)"><polyline class="curve line-${i}" points="${line.texels
      .map((bias, k) => bias <= mostTexels * (1 + 1e-9) && `${fixed(x(bias))},${fixed(y(line.shares[k]!))}`)
      .filter(Boolean)
      .join(" ")}"/></g><circle class="line-${i}" cx="${fixed(
      x(Math.min(Math.max(line.best_texels, 0), mostTexels)),
    )}" cy="${fixed(y(line.best_share))}" r="4"/><polyline class="curve line-${i}" points="${right},${fixed(end)} ${right + leader},${fixed(
      label - excess,
    )}"/><text class="name" x="${right + leader + 6}" y="${fixed(label - excess + 4)}">${
      families[line.family]!.name
    } (${line.size})</text>`;
  return markup`<svg class="chart" viewBox="0 0 ${width} ${height}" role="img" aria-label="Wrong pixels against the constant bias, a line for each kind"><defs><clipPath
id="tune-clip"><rect x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/></clipPath></defs>${niceTicks(
    0,
    highest,
    4,
  ).map(
    (v) =>
      markup`<line class="grid" x1="${left}" x2="${right}" y1="${fixed(
        y(v),
      )}" y2="${fixed(y(v))}"/><text class="tick end" x="${left - 8}" y="${fixed(y(v) + 4)}">${general(100 * v, 3)} %</text>`,
  )}${niceTicks(0, mostTexels, 4).map(
    (v) => markup`<text class="tick middle" x="${fixed(x(v))}" y="${bottom + 20}">${general(v, 3)}</text>`,
  )}<text class="tick middle" x="${(left + right) / 2}" y="${height - 8}">bias, texels</text>${placed.map(curve)}</svg>`;
}

function familyTable({ families, feasible, head }: TuneFacts): Markup {
  const n = (text: string): Markup => markup`<td class="n">${text}</td>`;
  const row = (family: Family, i: number): Markup =>
    markup`<tr${i === 0 && markup` class="front-row"`}><th scope="row">${family.name}${
      i === 0 && feasible && markup` <abbr title="the answer">★</abbr>`
    }<small>${
      family.why
    }</small></th>${n(String(family.size ?? "–"))}${n(family.bias ?? "–")}${n(percent(family.wrong_fraction))}${n(percent(family.mean_absolute))}${head && n(plainNumber(family.figure))}${n(
      milliseconds(family.time_ms),
    )}<td class="run"><code>${family.command}</code></td></tr>\n`;
  return scrollRegion(
    "What was tried",
    markup`<table class="families"><thead><tr><th scope="col">technique and bias</th><th
scope="col" class="n">texels</th><th scope="col" class="n">bias</th><th scope="col" class="n">wrong</th><th scope="col" class="n">mean error</th>${
      head && markup`<th scope="col" class="n">${head}</th>`
    }<th scope="col" class="n">time</th><th
scope="col" class="run">command</th></tr></thead><tbody>
${families.map(row)}</tbody></table>`,
  );
}

export function tuneSection(tune: TuneFacts): Markup {
  const cost = costChart(tune),
    biases = biasChart(tune);
  return markup`<section id="tune" aria-labelledby="tune-title">
<h1 id="tune-title">Tuning ${tune.scene}</h1>
<p class="verdict">${flowing(verdict(tune))}</p>
<p class="command"><code>${tune.families[0]!.command}</code></p>
<div class="trio tune-pictures" aria-hidden="true"><img data-copy="picture-raster" alt=""><img data-copy="picture-raytraced" alt=""><img data-copy="picture-labels-0" alt=""></div>
${proofLine(tune)}${
    cost &&
    markup`<h2>What accuracy costs</h2>
<figure>${scrollRegion(
      "Error against time",
      cost,
    )}<figcaption>Each point is a map that was drawn, at the best bias found for it; the line joins
those that no other beats in both, the large point is the answer.</figcaption></figure>
`
  }<h2>What was tried</h2>
<p>${tune.renders} ${
    tune.films
      ? "films: each technique was searched over map sizes, with the bias that it has where none is asked for"
      : "drawings: each kind of bias was searched over map sizes, and one drawing tells the error of every constant bias"
  }. The star is the answer; beside each of the others stands why it is not.</p>
${familyTable(tune)}${
    biases &&
    markup`<h3>How the error depends on the bias</h3>
<figure>${scrollRegion(
      "Wrong pixels against the bias of each kind",
      biases,
    )}<figcaption>At most six kinds: of those that are good enough the cheapest, then the nearest. Each at the
map size of its row above; a dot marks the best constant bias. Texels of the one map are not as wide as those of another.</figcaption></figure>
`
  }<p>The answer and its rivals on <a href="sheet.html">one page to print</a>. What follows is the comparison at that answer.</p></section>
`;
}
