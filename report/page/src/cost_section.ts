// What a comparison cost: passes, shadows alone, every stage of the run, and the work that is the same on every machine.
import { shareBar } from "./bars";
import { keyed, keyedCount, keyedThings } from "./document";
import { byteCount, counted, milliseconds } from "./number_text";
import { facts, ofLight, result, shadowSide, shadowTime, timed, type LightResult, type Times } from "./report_document";
import { markup, type Markup } from "./template";

interface TimeRow {
  key: string; // in result.json, of the times
  name: string;
  what: Markup | string;
  times: Times;
  kind: "raster" | "rays";
}

function lightRows(light: LightResult, i: number): TimeRow[] {
  const { map, times_ms: times, shadow_samples: samples } = light,
    key = `lights.${i}`,
    of = ofLight(i),
    soft = samples !== undefined;
  const row = (pass: keyof typeof times, name: string, what: Markup | string, kind: TimeRow["kind"]): TimeRow => ({
    key: `${key}.times_ms.${pass}`,
    name: name + of,
    what,
    times: times[pass] as Times,
    kind,
  });
  return [
    ...(map.rays
      ? []
      : [
          row(
            "map_pass",
            map.hybrid ? "sheets" : "depth map",
            map.size === null ? "its map is not known" : counted(map.faces! * map.size ** 2, "texel"),
            "raster" as const,
          ),
        ]),
    row(
      "shade_pass",
      "shading",
      map.rays ? "the picture with its few rays and their denoiser" : "the picture with its shadow lookups",
      "raster",
    ),
    ...(soft
      ? [
          row(
            "soft_shadow_rays",
            "exact shadows",
            markup`${keyedThings(`${key}.soft_shadow_rays`, "ray")}, of ${keyedThings(`${key}.soft_shadow_rays_asked`, "sample")} asked for (${keyedCount(
              `${key}.shadow_samples`,
            )} a receiver)`,
            "rays",
          ),
        ]
      : []),
    row(
      "shadow_rays",
      soft ? "the light as a point" : "exact shadows",
      markup`${soft ? markup`${keyedCount(`${key}.shadow_rays`)} to the light's centre` : keyedThings(`${key}.shadow_rays`, "exact ray")}`,
      "rays",
    ),
  ];
}

function timeTable(): Markup {
  const rows: TimeRow[] = [
    ...result.lights.flatMap(lightRows),
    {
      key: "times_ms.primary_rays",
      name: "primary rays",
      what: markup`${keyedThings("costs.primary_rays", "ray")}, one for each pixel`,
      times: result.times_ms.primary_rays,
      kind: "rays",
    },
  ];
  const longest = Math.max(1e-9, ...rows.map(({ times }) => times.median ?? 0));
  return markup`<table class="times"><caption>What the pictures took</caption><thead class="quiet"><tr><th
scope="col">pass</th><th scope="col">share of the longest</th><th scope="col"
class="n">median</th><th scope="col" class="n">of</th></tr></thead><tbody>
${rows.map(
  ({ key, name, what, times, kind }) => markup`<tr><th scope="row">${name}<small>${what}</small></th><td class="wide">${
    times.median !== null && shareBar(times.median / longest, kind)
  }</td><td class="n">${timed(key, times)}</td><td
class="n">${times.runs.length > 1 ? `${times.runs.length} runs` : times.runs.length === 1 && "1 run"}</td></tr>\n`,
)}</tbody></table>
`;
}

// What each side takes of a frame, by what has moved since the last one.
function shadowRows(light: LightResult, i: number): Markup | null {
  if (!light.times_ms.shadows) return null;
  const name = result.lights.length > 1 ? `${facts.light_facts[i]!.name}: ` : "";
  return markup`${facts.shadow_situations.map(
    ({ key, words, made }) =>
      markup`<tr><th scope="row">${name}${words}<small>${made}</small></th><td class="n">${shadowTime(
        light,
        i,
        `${key}_map`,
      )}</td><td class="n">${shadowTime(light, i, `${key}_rays`)}</td></tr>\n`,
  )}${estimateRows(light, i, name)}`;
}

// The same on a machine that is not here, by the rates of a file.
function estimateRows({ estimate }: LightResult, i: number, name: string): Markup | null {
  if (!estimate) return null;
  const ms = (key: string): Markup => keyed(`lights.${i}.estimate.${key}`, (value) => milliseconds(value));
  return markup`${(["nothing_moves", "light_moves"] as const).map(
    (key) =>
      markup`<tr><th scope="row">${name}${key === "nothing_moves" ? "nothing moves" : "light or camera moves"}<small>estimated from the counts, on ${estimate.rates}</small></th><td
class="n">${estimate[key].map_ms === null ? "not known" : ms(`${key}.map_ms`)}</td><td class="n">${
        estimate[key].rays_ms === null ? "not known" : ms(`${key}.rays_ms`)
      }</td></tr>\n`,
  )}`;
}

const oneTime = (name: string): Markup => keyed(`times_ms.${name}.median`, milliseconds);

function shadowTable(): Markup {
  const rows = result.lights.map(shadowRows),
    by = result.lights.map(shadowSide).find((side) => side !== "map") ?? "map";
  return markup`${
    rows.some((row) => row !== null) &&
    markup`<table class="times sides"><caption>The shadows of a frame, without what the picture costs</caption><thead><tr><th scope="col">since the last frame</th><th
scope="col" class="n">by the ${by}</th><th scope="col"
class="n">by rays</th></tr></thead><tbody>
${rows}</tbody></table>
`
  }<p class="hint">Before the first frame: ${oneTime("upload")} to upload the scene to the rasterizer, ${oneTime("accel_build")} to build the tracer’s hierarchy.${
    result.timing.software_rasterizer && ` ${facts.software_note}`
  }</p>
`;
}

/** What goes on in a stage, where its name alone does not say it. */
const stageWords: Record<string, string> = {
  start: "until the command begins",
  rest: "what belongs to no other stage",
  load: "reading and preparing the scene",
  context: "making the OpenGL context",
  upload: "handing the scene to OpenGL",
  "driver translation": "what the driver makes of shaders when it first draws with them, once for a machine",
  drawing: "memory for a frame and what else drawing needs around its passes",
  "map runs": "the depth map, timed, the runs after the first",
  "shading runs": "the picture with its shadows, timed, all runs",
  "shading with records": "the picture once more, with what each pixel looked up",
  "read-back": "fetching pictures and maps from OpenGL",
  build: "the ray tracer's hierarchy",
  "build repeats": "the same again, where it takes no time to speak of",
  "soft shadow rays": "shadow rays to points all over the light",
  "ray-traced picture": "shading, reflection and refraction",
  topology: "which triangles hang together",
  "columns and sheets": "what lies in the texels that pixels look up",
  labels: "naming the cause of each wrong pixel",
  metrics: "FLIP, SSIM, edges and penumbrae",
  "rows kept": "what a picture in bands needs later, on the disk and for this page",
  curve: "the error of every bias",
  exit: "giving memory back, so far",
};

function timeBudget(): Markup | null {
  const stages = result.time_budget;
  if (!stages) return null;
  const longest = Math.max(1e-9, ...stages.map(({ wall_ms }) => wall_ms));
  return markup`<table class="times"><caption>The time budget: every stage of the run, up to this page</caption><thead><tr><th scope="col">stage</th><th scope="col">share of the longest</th><th
scope="col" class="n">wall clock</th><th scope="col" class="n">processor</th></tr></thead><tbody>
${stages.map(
  ({ stage, wall_ms }, i) => markup`<tr><th scope="row">${stage}<small>${stageWords[stage]}</small></th><td class="wide">${shareBar(
    wall_ms / longest,
    "sum",
  )}</td><td
class="n">${keyed(`time_budget.${i}.wall_ms`, milliseconds)}</td><td
class="n">${keyed(`time_budget.${i}.cpu_ms`, milliseconds)}</td></tr>\n`,
)}<tr class="sum"><th scope="row">sum: the process</th><td class="wide"></td><td
class="n">${keyed("process.wall_ms", milliseconds)}</td><td
class="n">${keyed("process.cpu_ms", milliseconds)}</td></tr></tbody></table>
<p class="hint">Processor time is that of all threads. What comes after this point, putting the page together,
writing it and giving the memory back, is in <code>result.json</code> beside this page, which is written
last.</p>
`;
}

const plainRow = (name: string, value: Markup | string): Markup =>
  markup`<tr><th scope="row">${name}</th><td class="n">${value}</td></tr>\n`;

function workTable(): Markup {
  const { costs, lights } = result,
    row = (name: string, key: string): Markup => plainRow(name, keyedCount(`costs.${key}`));
  return markup`<table><caption>Work, the same on every machine</caption><tbody>
${
  lights.some(({ map }) => !map.rays) &&
  markup`${row("depth-map texels rendered", "map_texels")}${plainRow("depth-map memory", keyed("costs.map_bytes", byteCount))}`
}${row("primary rays", "primary_rays")}${row("shadow rays", "shadow_rays")}${
    costs.soft_shadow_rays_asked! > 0 &&
    markup`${row("rays to lights with size", "soft_shadow_rays")}${row("samples asked for", "soft_shadow_rays_asked")}`
  }${lights.map(
    ({ lookups }, i) =>
      lookups.total !== null && plainRow(`map lookups of compared pixels${ofLight(i)}`, keyedCount(`lights.${i}.lookups.total`)),
  )}${row(
    "reflection rays",
    "reflection_rays",
  )}${row("refraction rays", "refraction_rays")}${costs.glossy_rays! > 0 && row("glossy rays", "glossy_rays")}${
    costs.indirect_rays! > 0 && row("indirect rays", "indirect_rays")
  }</tbody></table>
`;
}

const wholeTable = (): Markup => markup`<table><caption>The rest of the run</caption><tbody>
${plainRow("loading the scene", oneTime("load"))}${plainRow("building the ray tracer's hierarchy", oneTime("accel_build"))}${plainRow("shading the ray-traced picture", oneTime("picture"))}${result.lights.map(
  ({ times_ms }, i) =>
    plainRow(`finding each pixel's ladder and label${ofLight(i)}`, timed(`lights.${i}.times_ms.classify`, times_ms.classify!)),
)}${plainRow(
  "whole process, up to this page",
  oneTime("total"),
)}${plainRow("peak memory", byteCount(facts.peak_memory_bytes))}</tbody></table>
`;

export const costSection = (): Markup => markup`<section id="cost" aria-labelledby="cost-title">
<h2 id="cost-title">Time and work</h2>
<p>Wall-clock medians on this machine, each pass finished before the clock stops.</p>
${timeTable()}${shadowTable()}${timeBudget()}<div class="columns">
<div>${workTable()}</div>
<div>${wholeTable()}</div>
</div>
</section>
`;
