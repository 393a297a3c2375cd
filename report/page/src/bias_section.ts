// How one light's error depends on the bias: in words and as a chart, by the kind of bias, and in the units of engines.
import { biasChart } from "./bias_chart";
import { keyed } from "./document";
import { general, percent, plainNumber, texelsText } from "./number_text";
import { facts, lessonDetails, plain, type DerivedBias, type LightResult } from "./report_document";
import { markup, scrollRegion, type Markup } from "./template";

function biasWords({ best_bias: best, map: { bias } }: LightResult, i: number): Markup {
  const { contradiction, smaller } = facts.light_facts[i]!,
    key = `lights.${i}.best_bias`;
  const inTexels = (world: number): string => (bias.texel_world ? ` (${texelsText(world / bias.texel_world)})` : "");
  return markup`A hard test shadows a pixel when its gap, the distance to the light minus the stored one${
    facts.bias_parts.length > 0 && " and the other parts of the bias"
  }, is
larger than the constant bias. Sorting the gaps of one render gives the exact error of every constant bias.
The best is ${plain(`${key}.constant_world`)}${inTexels(best.constant_world!)}, which leaves ${keyed(
    `${key}.wrong_fraction`,
    percent,
  )} wrong.${
    smaller &&
    ` The smaller ${plainNumber(
      smaller.constant_world,
    )}${inTexels(smaller.constant_world)} is nearly as good: ${percent(smaller.wrong_fraction)}.`
  } ${best.feasible ? "Some constant bias makes every compared pixel right." : contradiction}`;
}

function kindsTable({ bias_kinds: kinds }: LightResult, i: number): Markup | null {
  if (kinds.length === 0) return null;
  const range = ({ range_of, from, to }: LightResult["bias_kinds"][number]): string => {
    const unit = range_of === "slope" ? "" : " world units";
    return to === null ? `${plainNumber(from)}${unit} and more` : `${plainNumber(from)} to ${plainNumber(to)}${unit}`;
  };
  return markup`<h3>Which kind of bias</h3>
<p>For each kind of bias the smallest setting that is hardly worse than the best of its kind. The numbers follow from
this drawing's own map. A slope bias stands beside the automatic constant, every other kind with the constant that suits
it.</p>
${scrollRegion(
  `Kinds of bias of light ${i + 1}`,
  markup`<table><thead><tr><th scope="col">kind</th><th scope="col">options</th><th scope="col"
class="n">wrong</th><th scope="col">hardly differs</th></tr></thead><tbody>${kinds.map(
    (kind) =>
      markup`<tr><th scope="row">${kind.kind}</th><td><code>${kind.options}</code></td><td class="n">${percent(
        kind.wrong_fraction,
      )}</td><td>${range(kind)}</td></tr>\n`,
  )}</tbody></table>`,
)}`;
}

/** One constant is one number of texels on every layer, and another length and stored number on each. */
function layersTable({ derived_bias: derived }: LightResult, i: number): Markup | null {
  if (derived === null) return null;
  const lengths = ({ world, texels, stored }: DerivedBias["layers"][number]["drawn"]): Markup =>
    markup`${[world, texels, stored].map((value) => markup`<td class="n">${general(value, 3)}</td>`)}`;
  return markup`<p>A constant bias on each layer of the map, as it was drawn and as it follows from the map alone: ${general(
    derived.constant_texels,
    3,
  )}
texels, beside a slope bias of ${plainNumber(derived.slope)} or a normal offset of ${general(derived.normal_offset_texels, 3)} texels.</p>
${scrollRegion(
  `The bias on each layer of light ${i + 1}`,
  markup`<table><thead><tr><th scope="col">layer</th><th scope="col" class="n">texel, world units</th>${["drawn", "from the map"].map(
    (of) =>
      markup`<th scope="col" class="n">${of}, world units</th><th scope="col" class="n">texels</th><th scope="col" class="n">stored depth</th>`,
  )}</tr></thead><tbody>${derived.layers.map(
    (layer, at) =>
      markup`<tr><th scope="row">${at + 1}</th><td class="n">${general(
        layer.texel_world,
        3,
      )}</td>${lengths(layer.drawn)}${lengths(layer.derived)}</tr>\n`,
  )}</tbody></table>`,
)}`;
}

function engineUnits(light: LightResult, i: number): Markup | null {
  const { engine_units: units } = light;
  if (units.length === 0) return null;
  return markup`<details><summary>This bias in the units of engines</summary>
<p>For a light whose map has this size, width and depths; docs/engine-units.md explains the symbols.</p>
${scrollRegion(
  `Engine units of light ${i + 1}`,
  markup`<table><thead><tr><th scope="col">engine</th><th scope="col">setting</th><th scope="col"
class="n">value</th><th scope="col">formula</th></tr></thead><tbody>${units.map(
    ({ engine, setting, value, formula }) =>
      markup`<tr><th scope="row">${engine}</th><td>${setting}</td><td class="n">${
        value === null ? "–" : plainNumber(value)
      }</td><td>${formula}</td></tr>\n`,
  )}</tbody></table>`,
)}${layersTable(light, i)}</details>
`;
}

export function biasBlock(light: LightResult, i: number): Markup | null {
  if (light.bias_curve_withheld !== null)
    return markup`<h3>How the error depends on the bias</h3>\n<p>${light.bias_curve_withheld}</p>\n${engineUnits(light, i)}`;
  const chart = biasChart(light, `bias-${i}`);
  return (
    chart &&
    markup`<h3>How the error depends on the bias, from this one render</h3>
<p>${biasWords(light, i)}</p>
${scrollRegion(
  `Chart of wrong pixels against the bias of light ${i + 1}`,
  chart,
)}${kindsTable(light, i)}${engineUnits(light, i)}${lessonDetails("bias")}`
  );
}
