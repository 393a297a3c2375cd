// What is said of the state: the verdict, the wrong pixels by label, the error of every constant bias, what it took, and
// one pixel explained.
import { biasChart } from "../bias_chart";
import { grouped, percent, plainNumber, signedNumber } from "../number_text";
import type { LabelFacts, LightResult } from "../report_document";
import { markup, scrollRegion, swatch, type Markup } from "../template";
import type { Cut, Drawn, LabFacts, PixelStory, TimeWords } from "./engine";

function labelRows(light: LightResult, labels: LabelFacts[]): Markup {
  const { compared } = light.pixels,
    classes: Record<string, number> = light.classes,
    seen = labels.filter(({ key, value }) => value > 0 && (classes[key] ?? 0) > 0).sort((a, b) => classes[b.key]! - classes[a.key]!);
  if (seen.length === 0) return markup`<p>No compared pixel is wrong.</p>`;
  return markup`<table class="labels"><caption>Wrong pixels, and why</caption><tbody>${seen.map(
    ({ key, name, colour, letter, what, cause, cure }) =>
      markup`<tr><td>${swatch(
        colour,
        letter,
      )}</td><th scope="row"><details><summary>${name}</summary><p>${what}. ${cause} ${cure}</p></details></th><td class="n">${grouped(classes[key]!)}</td><td class="n">${percent(
        classes[key]! / Math.max(compared, 1),
      )}</td></tr>`,
  )}</tbody></table>`;
}

function budget(light: LightResult, facts: LabFacts): Markup {
  const rungs = light.budget.some(({ cause }) => cause === "noise") ? facts.ray_rungs : facts.rungs;
  return markup`<table class="numbers"><caption>Mean error by step, and its sign</caption><tbody>${light.budget.map(
    ({ absolute, signed }, k) =>
      markup`<tr><th scope="row">${
        rungs[k + 1]!.step!
      }</th><td class="n">${percent(absolute)}</td><td class="n">${signed === 0 ? "0" : signedNumber(signed)}</td></tr>`,
  )}</tbody></table>`;
}

function timeTable({ rows, by }: TimeWords): Markup {
  return markup`<table class="numbers" id="lab-times"><caption>What the shadows took</caption><tbody>${rows.map(
    ([name, time]) => markup`<tr><th scope="row">${name}</th><td class="n">${time}</td></tr>`,
  )}</tbody></table><p class="hint">${by}</p>`;
}

function engineUnits({ engine_units: units }: LightResult): Markup | null {
  const known = units.filter(({ value }) => value !== null);
  if (known.length === 0) return null;
  return markup`<details><summary>This bias in your engine</summary><table class="numbers"><tbody>${known.map(
    ({ engine, setting, value, formula }) =>
      markup`<tr><th scope="row">${engine}<small>${setting}; ${formula}</small></th><td class="n">${plainNumber(value!)}</td></tr>`,
  )}</tbody></table></details>`;
}

/** The constant bias, in texels, at this place of the chart of every bias; null beside its plot. */
export function biasAt(chart: SVGElement, clientX: number, light: LightResult): number | null {
  const { left, right, from, to } = Object.fromEntries(Object.entries(chart.dataset).map(([key, text]) => [key, Number(text)])) as Record<
    string,
    number
  >;
  const box = chart.getBoundingClientRect(),
    width = Number(chart.getAttribute("viewBox")!.split(" ")[2]);
  const share = (((clientX - box.left) * width) / box.width - left!) / (right! - left!),
    texel = light.map.bias.texel_world;
  return share < 0 || share > 1 || !texel ? null : (from! + share * (to! - from!)) / texel;
}

export function resultsMarkup(drawn: Drawn, facts: LabFacts): Markup {
  const light = drawn.result?.lights[0];
  if (!light) return markup`<p>Comparing…</p>`;
  const chart = biasChart(light, "lab-bias");
  return markup`${labelRows(light, facts.labels)}${budget(light, facts)}${
    chart &&
    markup`<h2>Every constant bias</h2>${scrollRegion(
      "Wrong pixels at every constant bias",
      chart,
    )}<p class="hint">A click takes the bias there.</p>`
  }${engineUnits(light)}${drawn.times && timeTable(drawn.times)}`;
}

/** Stored depths of the texels as steps, the same with the bias, and the receiver: the light is above. */
function cutDrawing({ stored, receiver, first, at, distance, bias, along }: Cut): Markup {
  const known = [...stored.filter((depth): depth is number => depth !== null), ...receiver.map(([, depth]) => depth), distance];
  const least = Math.min(...known),
    most = Math.max(...known) + bias,
    span = Math.max(most - least, 1e-12);
  const width = 320,
    height = 130,
    x = (texel: number): number => (width * (texel - first)) / stored.length,
    y = (depth: number): number => 8 + ((height - 16) * (depth - least)) / span;
  const steps = (add: number): string =>
    stored
      .map((depth, i) => (depth === null ? "" : `M${x(first + i).toFixed(1)} ${y(depth + add).toFixed(1)}H${x(first + i + 1).toFixed(1)}`))
      .join("");
  return markup`<svg class="cut" viewBox="0 0 ${width} ${height}" role="img" aria-label="Cut through the map along ${along}: stored depths, the same with the bias, and the receiver"><path class="stored" d="${steps(
    0,
  )}"/><path class="biased" d="${steps(bias)}"/><polyline class="receiver" points="${receiver
    .map(([texel, depth]) => `${x(texel).toFixed(1)},${y(depth).toFixed(1)}`)
    .join(" ")}"/><circle cx="${x(at).toFixed(
    1,
  )}" cy="${y(distance).toFixed(1)}" r="4"/></svg><p class="hint">Thick: stored depths; thin: the same with a bias of ${plainNumber(bias)}; line: the receiver. The light is above.</p>`;
}

export function pixelMarkup(story: PixelStory, facts: LabFacts): Markup {
  const label = facts.labels.find(({ value }) => value === story.label),
    rungs = story.of_rays ? facts.ray_rungs : facts.rungs;
  return markup`<h2>Pixel ${story.pixel[0]}, ${story.pixel[1]}${label && markup`: ${label.name}`}</h2><p>${story.words}</p>${story.remarks.map(
    (remark) => markup`<p>${remark}</p>`,
  )}${story.cure !== "" && markup`<p><b>What helps:</b> ${story.cure}</p>`}${story.cut && cutDrawing(story.cut)}${
    story.seen &&
    markup`<table class="numbers"><caption>Visibility, step by step</caption><tbody>${story.rungs.map(
      (value, k) =>
        markup`<tr${
          k === story.deciding && k > 0 ? markup` class="deciding"` : ""
        }><th scope="row">${rungs[k]!.symbol} ${rungs[k]!.name}</th><td class="n">${plainNumber(value)}</td></tr>`,
    )}</tbody></table>`
  }`;
}
