// The first screen: the verdict, both pictures with their times, and for each light its error budget.
import { twoSidedBar } from "./bars";
import { beyondRounding, keyed, keyedCount, keyedDecrease } from "./document";
import { picture } from "./frame";
import { signedNumber } from "./number_text";
import { isBeside } from "./parts";
import { facts, ofLight, result, shadowSide, shadowTime, stepName, verdictBlock, type LightResult } from "./report_document";
import { flowing, markup, type Markup } from "./template";

/** The light whose labelled picture stands on the first screen: that with the most wrong pixels. */
export const labelledLight = (): number =>
  result.lights.reduce((most, { error }, i) => (error.wrong > result.lights[most]!.error.wrong ? i : most), 0);

export function labelFigure(i: number): Markup {
  return markup`<figure>${picture(`labels-${i}`, `picture-labels-${i}`)}<figcaption><b>Labels</b>${
    result.lights.length > 1 && `, light ${facts.light_facts[i]!.name}`
  }: each error in the colour of its cause, as strong as it is; grey is right.</figcaption></figure>\n`;
}

function rasterCaption(): Markup {
  const { lights, judged } = result;
  if (lights.length === 0) return markup`<b>Rasterizer</b>, shadow maps`;
  if (judged)
    return markup`<b>${judged.renderer.name}</b>${judged.renderer.version && ` ${judged.renderer.version}`}${
      judged.ratio ? ", with its shadow" : ": what it drew of the light, white lit and black shadowed"
    }`;
  if (lights[0]!.map.rays) return markup`<b>Rasterizer</b>, few rays and a denoiser`;
  return lights[0]!.map.hybrid ? markup`<b>Hybrid</b>, sheets and rays` : markup`<b>Rasterizer</b>, shadow map${lights.length > 1 && "s"}`;
}

// What the shadows of a frame take on both sides, of the light whose labels are shown.
function shadowCostLine(): Markup | null {
  const i = labelledLight(),
    light = result.lights[i];
  if (!light?.times_ms.shadows) return null;
  return markup`<dl class="shadow-costs">
${facts.shadow_situations.map(
  ({ key, words }) =>
    markup`<div><dt>Shadows${ofLight(i)}, ${words}</dt><dd>${shadowTime(light, i, `${key}_map`)} by the ${shadowSide(
      light,
    )}, ${shadowTime(light, i, `${key}_rays`)} by rays</dd></div>\n`,
)}</dl>
`;
}

const simulates = (effect: string): boolean => result.effects.some((entry) => entry.effect === effect && entry.simulated);

// What the two pictures show differently by design.
function rasterRemark(): Markup | null {
  if (result.judged) return null;
  if (simulates("refraction"))
    return markup`<small class="remark">Drawn plainly: what reflects or is seen through is matte grey here, and to the shadow map glass is opaque.</small>`;
  return simulates("reflection") ? markup`<small class="remark">Drawn plainly: what reflects is matte grey here.</small>` : null;
}
const raytracedRemark = (): Markup | null =>
  simulates("refraction")
    ? markup`<small class="remark">Light passes through glass here. The comparison counts glass as opaque, as the
map does: where glass alone casts a shadow, this picture is bright all the same.</small>`
    : null;

function settingLines(): Markup {
  const { width, height } = result.size,
    { triangles, shapes } = result.scene,
    dot = markup`<span aria-hidden="true">·</span>`;
  return markup`<p class="setting">${width} × ${height} pixels ${dot} ${facts.map} ${dot} ${keyedCount("scene.triangles")} triangle${triangles !== 1 && "s"}, ${keyedCount(
    "scene.shapes",
  )} shape${shapes !== 1 && "s"}</p>
${facts.reduced && markup`<p class="setting">${facts.reduced}</p>\n`}${
    isBeside &&
    markup`<p class="setting beside">The pixels would make this page too large for one file: its
pictures and data lie beside it, in its folder and in <code>report-data</code>. Keep them together.</p>
`
  }`;
}

/** The budget as a waterfall that adds up: one row per step that changes anything, and the sum. */
function budgetTable(light: LightResult, i: number): Markup {
  const { compared } = light.pixels,
    sides = (of: { false_shadow: number; missed_shadow: number }) => ({
      darker: of.false_shadow / compared,
      lighter: of.missed_shadow / compared,
    });
  const whole = sides(light.error),
    scale = Math.max(whole.darker, whole.lighter, 1e-9, ...light.budget.flatMap(({ darkened, lightened }) => [darkened, lightened]));
  const first = light.ladder[0]!.mean,
    last = light.ladder.at(-1)!.mean;
  const rows = light.budget.map(
    (step, k) =>
      (step.absolute > 0 || step.false_shadow + step.missed_shadow > 0) &&
      markup`<tr><th scope="row">${stepName(k)}</th><td class="wide">${twoSidedBar(
        { darker: step.darkened, lighter: step.lightened },
        sides(step),
        scale,
      )}</td><td
class="n">${keyedDecrease(`lights.${i}.budget.${k}.darkened`)}</td><td class="n">${keyed(
        `lights.${i}.budget.${k}.lightened`,
        signedNumber,
      )}</td></tr>\n`,
  );
  return markup`<table class="budget"><thead><tr><th scope="col">step</th><td class="wide"></td><th
scope="col" class="n">darker</th><th scope="col" class="n">lighter</th></tr></thead><tbody>
${rows}<tr class="sum"><th scope="row">sum</th><td class="wide">${twoSidedBar({ darker: 0, lighter: 0 }, whole, scale)}</td><td
class="n" colspan="2">${signedNumber(beyondRounding(last - first, last + first))}</td></tr></tbody></table>
`;
}

/** The verdict before the pictures: of several lights that of the worst, the others stand beside their budgets. */
function firstVerdict(): Markup | null {
  const { lights } = result,
    worst = labelledLight();
  if (lights.length === 0) return null;
  const { name, verdict } = facts.light_facts[worst]!;
  return lights.length === 1
    ? verdictBlock(verdict)
    : markup`<p class="verdict">Light ${name} is off most. ${flowing(verdict.headline)}</p>
`;
}

function card(light: LightResult, i: number): Markup {
  const { name, verdict } = facts.light_facts[i]!,
    several = result.lights.length > 1;
  return markup`<div class="card">${
    several &&
    markup`<div><p class="eyebrow">Light: <a href="#light-${i}">${name}</a></p>
${verdictBlock(verdict)}</div>`
  }${
    light.pixels.compared > 0 &&
    markup`<div class="card-budget"><p class="eyebrow">Where the error comes from: how far each step
darkens the picture and lightens it, as mean visibility. Pale: what later steps undo. Full colour: the wrong
pixels that are left.</p>
${budgetTable(light, i)}</div>
`
  }</div>
`;
}

// Where a setting was judged from several views: this page is of the worst of them.
function viewsLine(): Markup | null {
  const { views } = result;
  return views
    ? markup`<p class="setting">This is the worst of ${views.each.length} views: ${views.worst}. <a href="#views">${
        views.places?.worst ? "All of them, and where it fails" : "All of them"
      }</a></p>
`
    : null;
}

const figure = (name: string, caption: Markup, remark: Markup | null): Markup =>
  markup`<figure>${picture(name, `picture-${name}`)}<figcaption>${caption}${remark}</figcaption></figure>\n`;

export function overviewSection(): Markup {
  const { lights, scene } = result;
  return markup`<section id="overview" aria-labelledby="title">
<h1 id="title">${scene.name || "Scene without a name"}</h1>
${firstVerdict()}${viewsLine()}${settingLines()}<div class="${lights.length === 0 ? "pair" : "trio"}">
${figure("raster", rasterCaption(), rasterRemark())}${figure(
    "raytraced",
    markup`<b>Ray tracer</b>, exact shadows`,
    raytracedRemark(),
  )}${lights.length > 0 && labelFigure(labelledLight())}</div>
${shadowCostLine()}${lights.map(card)}${
    lights.length === 0 && markup`<p class="verdict">The scene has no light: there is no shadow to compare.</p>\n`
  }</section>
`;
}
