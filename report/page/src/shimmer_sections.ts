// The sections of a film of shadows, from its result.json (studies/shimmer/shimmer.schema.json).
import { keyed, keyedCount, keyedSigned, keyedThings, numberAt, resultDocument } from "./document";
import { flipsChart } from "./flips_chart";
import { picture, type Section } from "./frame";
import { general, grouped, plainNumber, unsignedNumber } from "./number_text";
import { provenance } from "./provenance";
import { flowing, markup, scrollRegion, swatch, type Markup } from "./template";

export interface FlipLabel {
  key: string; // of the document
  name: string;
  colour: string;
  letter: string;
}

interface LightResult {
  light: { name: string };
  map: { technique: string; size: number };
  by_frame: { flips: number }[];
  worst: { x: number; y: number; flips: number; absolute: number }[];
}

export interface ShimmerResult {
  scene: { name: string };
  size: { width: number; height: number };
  frames: number;
  fps: number;
  path: { camera: string; light: string };
  anchors: number;
  lights: LightResult[];
}

/** What the program says beside the document. */
export interface ShimmerFacts {
  labels: FlipLabel[];
  verdicts: string[]; // by light
  most_flips: number[]; // of one receiver, by light
  film: { words: string; extension: string };
}

function overview({ scene, lights, frames, fps, path }: ShimmerResult): Markup {
  const map = lights[0]?.map;
  return markup`<section id="overview" aria-labelledby="title"><h1 id="title">Shimmer of ${scene.name}</h1>
<p class="setting">${map?.technique} map of ${map?.size}² texels, ${frames} frames at ${general(fps, 6)} a second, camera ${path.camera}, light ${path.light}.
Receivers stay where the first frame sees them; V6 is what was drawn of them, V0 the truth. A flip is a step of V6 that differs by more than one half
from that of V0.</p></section>
`;
}

function budgetTable(labels: FlipLabel[], light: string, i: number): Markup {
  // Both are empty where nothing was counted, and of the last label, which is no step.
  const means = (of: string): Markup => {
    const absolute = numberAt(`${of}.absolute`);
    if (Number.isNaN(absolute)) return markup`<td></td><td></td>`;
    return markup`<td class="n">${keyedSigned(`${of}.signed`, absolute)}</td><td class="n">${keyed(`${of}.absolute`, unsignedNumber)}</td>`;
  };
  const row = ({ key, name, colour, letter }: FlipLabel, k: number): Markup =>
    markup`<tr><th scope="row">${swatch(colour, letter)} ${name}</th>${means(
      `${light}.budget.${k}`,
    )}<td class="n">${keyedCount(`${light}.by_label.${key}`)}</td></tr>\n`;
  return scrollRegion(
    `Temporal budget ${i}`,
    markup`<table class="families"><thead><tr><th scope="col">step</th><th scope="col" class="n">signed</th><th
scope="col" class="n">absolute</th><th scope="col" class="n">flips</th></tr></thead><tbody>
${labels.map(row)}<tr><th scope="row">sum</th>${means(`${light}.error`)}<td class="n">${keyedCount(`${light}.flips`)}</td></tr>
</tbody></table>`,
  );
}

function worstTable({ worst }: LightResult, width: number, i: number): Markup | null {
  if (worst.length === 0) return null;
  return markup`<h3>The receivers that flip most</h3>
${scrollRegion(
  `Worst receivers ${i}`,
  markup`<table class="worst"><thead><tr><th scope="col">pixel</th><th scope="col" class="n">flips</th><th
scope="col" class="n">sum of |error|</th></tr></thead><tbody>
${worst.map(
  ({ x, y, flips, absolute }) => markup`<tr><th scope="row"><span class="place" data-pixel="${y * width + x}">${x}, ${y}</span></th><td
class="n">${grouped(flips)}</td><td class="n">${plainNumber(absolute)}</td></tr>\n`,
)}</tbody></table>`,
)}`;
}

function edgesLine(light: string): Markup {
  const drawn = `${light}.edges.drawn_texels_per_frame`;
  if (Number.isNaN(numberAt(drawn))) return markup`<p>There is no true shadow edge.</p>\n`;
  return markup`<p>Drawn shadow edges sweep ${keyedThings(drawn, "texel", plainNumber)} with each frame, the true ones ${keyed(
    `${light}.edges.true_texels_per_frame`,
    plainNumber,
  )}.</p>\n`;
}

function lightSection(result: ShimmerResult, facts: ShimmerFacts, i: number): Markup {
  const light = result.lights[i]!,
    { words, extension } = facts.film,
    key = `lights.${i}`,
    name = light.light.name;
  return markup`<section id="light-${i}" class="shimmer-light" data-light="${i}" aria-labelledby="light-${i}-title">
<h2 id="light-${i}-title">Light: ${name}</h2>
<p class="verdict">${flowing(facts.verdicts[i]!)}</p>
<div class="film" hidden></div>
<p class="setting">The films themselves lie beside this page, as ${words}: <code>film-${i}-drawn.${extension}</code>,
<code>film-${i}-truth.${extension}</code>, <code>film-${i}-flips.${extension}</code>.</p>
<h3>Flips from frame to frame</h3>
${scrollRegion(
  `Flips from frame to frame ${i}`,
  flipsChart(
    light.by_frame.map(({ flips }) => flips),
    name,
  ),
)}
${edgesLine(key)}<h3>Where it flips</h3>
<figure>${picture(`flips-${i}`, "", "flips-map")}
<figcaption>Flips of each receiver over the film, black none, pale yellow ${facts.most_flips[i]}.</figcaption></figure>
<h3>Which step does it</h3>
${budgetTable(facts.labels, key, i)}${worstTable(light, result.size.width, i)}</section>
`;
}

export function shimmerSections(facts: ShimmerFacts): Section[] {
  const result = resultDocument<ShimmerResult>();
  return [
    { id: "overview", link: "Overview", html: overview(result) },
    ...result.lights.map((light, i) => ({ id: `light-${i}`, link: `Light: ${light.light.name}`, html: lightSection(result, facts, i) })),
    { id: "provenance", link: "", html: provenance() },
  ];
}
