// One light: the viewer, the pictures of what is wrong, the labels and what causes and cures them; then its numbers.
import { biasBlock } from "./bias_section";
import { keyed, keyedCount, keyedThings } from "./document";
import { picture, pictureNamed } from "./frame";
import { layoutFigure } from "./layout_figure";
import { depthMapBlock, factsBlock, hybridBlock, ladderBlock, raysBlock } from "./light_numbers";
import { grouped, percent, plainNumber } from "./number_text";
import { labelFigure, labelledLight } from "./overview_section";
import { facts, lessonDetails, result, shareOf, type LabelFacts, type LightResult } from "./report_document";
import { palette } from "./parts";
import { flowing, markup, swatch, type Markup } from "./template";
import { viewerBlock } from "./viewer_block";

function viewer(i: number): Markup {
  const options = [
    ["picture-raster", "rasterized"],
    ["picture-raytraced", "ray traced"],
    [`picture-difference-${i}`, "difference"],
    [`picture-labels-${i}`, "labels"],
    ...(pictureNamed(`decisions-${i}`) ? [[`picture-decisions-${i}`, "who decided"]] : []),
  ];
  return viewerBlock(
    markup`${options.map(([id, name]) => markup`<option value="${id}">${name}</option>`)}`,
    i,
    markup`Point at a pixel to read it, click to pin it; its story is below. Drag to move the divider, or the
picture once it is enlarged; double-click enlarges. Keys: <kbd>F</kbd> flips, <kbd>+</kbd> <kbd>−</kbd>
<kbd>0</kbd> zoom, arrows move, <kbd>Shift</kbd> with arrows steps from pixel to pixel, <kbd>Esc</kbd> lets
go. Exposure is in stops, on linear light, of both pictures. Scales are fixed: the same colour means the same
in every picture.`,
    true,
  );
}

const differenceFigure = (i: number): Markup =>
  markup`<figure>${picture(`difference-${i}`, `picture-difference-${i}`)}<figcaption>${swatch(
    palette.false_shadow,
    "−",
  )} <b>False shadow</b>: drawn dark, truly lit, ${keyedThings(`lights.${i}.error.false_shadow`, "pixel")}. ${swatch(
    palette.missed_shadow,
    "+",
  )} <b>Missed shadow</b>: drawn lit, truly dark, ${keyedThings(`lights.${i}.error.missed_shadow`, "pixel")}.</figcaption></figure>\n`;

/** The errors that occur, those with most of the mean error first. */
const occurring = ({ classes, class_errors: errors }: Record<"classes" | "class_errors", Record<string, number>>): LabelFacts[] =>
  facts.labels
    .filter(({ key, value }) => value > 0 && (classes[key]! > 0 || errors[key]! > 0))
    .sort((a, b) => errors[b.key]! - errors[a.key]!);

const labelRow = ({ name, letter, colour, what }: LabelFacts, pixels: Markup, share: string, error: Markup | string = ""): Markup =>
  markup`<tr data-colour="${colour}" data-label="${name}"><td>${swatch(colour, letter)}</td><th scope="row">${name}<small>${what}</small></th><td
class="n">${pixels}</td><td class="n">${share}</td><td class="n">${error}</td></tr>\n`;

function labelTable(light: LightResult, i: number): Markup {
  const { error } = light,
    classes: Record<string, number> = light.classes,
    pixels: Record<string, number> = light.pixels,
    { compared } = light.pixels,
    right = compared - error.wrong - error.ties;
  const labelled = (wanted: string): LabelFacts => facts.labels.find(({ key }) => key === wanted)!;
  const others = ["uncertain", "silhouette", "facing_away", "background"].filter((key) => pixels[key]! > 0);
  return markup`<table class="labels"><caption>Labels</caption><thead><tr><td></td><th scope="col">label</th><th
scope="col" class="n">pixels</th><th scope="col" class="n">share</th><th scope="col" class="n" title="What the label has of the mean absolute error">error</th></tr></thead><tbody>
${occurring(light).map((label) =>
  labelRow(
    label,
    keyedCount(`lights.${i}.classes.${label.key}`),
    shareOf(classes[label.key]!, compared),
    keyed(`lights.${i}.class_errors.${label.key}`, percent),
  ),
)}<tr class="sum"><td></td><th
scope="row">wrong</th><td class="n">${keyedCount(`lights.${i}.error.wrong`)}</td><td class="n">${keyed(
    `lights.${i}.error.wrong_fraction`,
    percent,
  )}</td><td class="n">${keyed(`lights.${i}.error.mean_absolute`, percent)}</td></tr>
${
  error.ties > 0 &&
  markup`<tr><td></td><th scope="row">off by exactly one half (two count as one wrong)</th><td
class="n">${keyedCount(`lights.${i}.error.ties`)}</td><td class="n">${shareOf(error.ties, compared)}</td><td></td></tr>
`
}${labelRow(
    labelled("right"),
    markup`${grouped(right)}`,
    shareOf(right, compared),
  )}<tr class="sum"><td></td><th scope="row">compared</th><td
class="n">${keyedCount(`lights.${i}.pixels.compared`)}</td><td class="n">${compared > 0 && "100 %"}</td><td></td></tr>
${others.map((key) => labelRow(labelled(key), keyedCount(`lights.${i}.pixels.${key}`), ""))}</tbody></table>
`;
}

function explanations(light: LightResult): Markup | null {
  const given = new Set<string>(); // each lesson once
  const items = occurring(light).map(({ name, letter, colour, cause, cure, lesson }) => {
    const known = given.has(lesson);
    given.add(lesson);
    return markup`<div><dt>${swatch(colour, letter)}${name}</dt><dd>${cause}</dd><dd class="cure"><b>Cure.</b> ${cure}</dd><dd>${
      known ? `Lesson: ${facts.lessons[lesson]!.title}, above.` : lessonDetails(lesson)
    }</dd></div>\n`;
  });
  return items.length > 0 ? markup`<h3>What causes it, what cures it</h3>\n<dl class="explain">\n${items}</dl>\n` : null;
}

function where({ light: { position, direction } }: LightResult): string {
  const text = (v: number[]): string => `(${v.map(plainNumber).join(", ")})`;
  return [position && `at ${text(position)}`, direction && `shining along ${text(direction)}`].filter(Boolean).join(", ");
}

function mapSize({ map: { size, inferred, faces, rays } }: LightResult): string {
  if (rays) return "few rays, no map";
  if (size === null) return "its map is not known";
  return `${inferred ? "inferred " : ""}map of ${size}\u202f×\u202f${size}${faces! > 1 ? `\u202f×\u202f${faces}` : ""} texels`;
}

export function lightSection(light: LightResult, i: number): Markup {
  const { name, verdict } = facts.light_facts[i]!,
    bias = light.map.bias.constant_world;
  const numbers =
    light.pixels.compared === 0
      ? labelTable(light, i)
      : markup`<div class="columns">
<div>${labelTable(light, i)}</div>
<div>${explanations(light)}</div>
</div>
${hybridBlock(light, i)}${raysBlock(light, i)}${ladderBlock(light, i)}${biasBlock(light, i)}${factsBlock(light, i)}`;
  // A single light's verdict stands right above, on the first screen, and so do one light's labels.
  return markup`<section id="light-${i}" aria-labelledby="light-${i}-title">
<h2 id="light-${i}-title">Light: ${name}</h2>
<p class="setting">${light.light.type}, ${where(light)}; ${mapSize(light)}${bias !== null && `, bias ${plainNumber(bias)} world units`}</p>
${result.lights.length > 1 && markup`<p class="lead">${flowing(verdict.whole)}</p>\n`}${viewer(i)}<div class="pair">
${differenceFigure(i)}${i !== labelledLight() && labelFigure(i)}</div>
${numbers}${layoutFigure(light, i)}${depthMapBlock(light, i)}</section>
`;
}
