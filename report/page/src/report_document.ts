// The document of a comparison, result.json (compare/result/result_schema.h), and what the program says beside it
// (../../facts.cpp).
import { keyed, resultDocument } from "./document";
import { milliseconds, percent, plainNumber, timeDifference } from "./number_text";
import type { Vec3 } from "./light_view";
import { pageData } from "./parts";
import { flowing, markup, Markup } from "./template";
import type { TuneFacts } from "./tune_sections";

export interface Times {
  median: number | null;
  runs: number[];
}

interface Unit {
  engine: string;
  setting: string;
  value: number | null;
  formula: string;
}

interface BiasLengths {
  world: number;
  texels: number;
  stored: number;
}

export interface DerivedBias {
  constant_texels: number;
  slope: number;
  normal_offset_texels: number;
  layers: { texel_world: number; drawn: BiasLengths; derived: BiasLengths }[];
  engine_units: Unit[];
}

interface BiasKind {
  kind: string;
  options: string;
  wrong_fraction: number;
  range_of: string;
  from: number;
  to: number | null;
}

export interface BiasPoint {
  bias: number;
  false_shadow: number;
  missed_shadow: number;
  wrong_fraction: number;
}

export interface BestBias {
  constant_world: number;
  constant_texels: number | null;
  wrong_fraction: number;
  feasible: boolean;
  needs_more_than: number | null;
  needs_less_than: number | null;
}

export interface LightResult {
  light: { type: string; position?: number[]; direction?: number[] };
  map: {
    technique: string;
    size: number | null; // null: not known
    inferred: boolean;
    faces: number;
    windows?: Vec3[][]; // of each map four corners at its near and four at its far depth
    bias: { constant_world: number | null; texel_world: number };
    hybrid?: { receivers: number; surely_lit: number; surely_shadowed: number; rays: number; all_rays: number; bytes: number };
    texel_world: { min: number; median: number; max: number };
  };
  pixels: Record<string, number> & { compared: number };
  error: {
    wrong: number;
    wrong_fraction: number;
    false_shadow: number;
    missed_shadow: number;
    ties: number;
    ssim: number | null;
    flip_compared: number | null;
    ssim_compared: number | null;
  };
  budget: { signed: number; absolute: number; darkened: number; lightened: number; false_shadow: number; missed_shadow: number }[];
  ladder: { mean: number }[];
  classes: Record<string, number>;
  class_errors: Record<string, number>; // by label, of the mean error
  edges: { count: number; mean_texels: number };
  detachment: { pixels: number };
  bleeding?: { pixels: number };
  penumbra?: { edges: number; umbra_edges: number; drawn_penumbra_world: number; drawn_umbra_world: number };
  seams?: object;
  terminator?: { dark: number; unlit: number };
  theory: { acne_free_bias: { count: number }; aliasing: { count: number }; measured_aliasing: { count: number } };
  bias_curve: BiasPoint[];
  bias_curve_withheld: string | null;
  best_bias: BestBias;
  bias_kinds: BiasKind[];
  engine_units: Unit[];
  derived_bias: DerivedBias | null;
  lookups: { total: number | null };
  times_ms: Record<string, Times> & { shadows?: Record<string, number | null> };
  shadow_samples?: number; // of a light with size
}

/** What a setting errs by from several views, and where: squares seen from above. */
export interface Views {
  measure: string;
  worst: string;
  worst_error: number | null;
  mean_error: number | null;
  each: { view: string; light: string; error: number | null; eye: [number, number, number]; direction: [number, number, number] }[];
  places?: {
    corner: [x: number, z: number];
    side: number;
    cells: [column: number, row: number, pixels: number, error: number][];
    worst: [column: number, row: number] | null;
    worst_share: number | null;
    pixels_beyond: number;
    mean_absolute_beyond: number | null;
  };
}

export interface Result {
  command: string;
  version: string;
  size: { width: number; height: number };
  scene: { path: string; sha256: string; triangles: number; shapes: number; name: string; notes: string[] };
  machine: { cpu: string; cores: number; os: string; load?: number | null };
  shaders: { replaced: string; sha256: string }[];
  effects: { effect: string; called_for: boolean; simulated: boolean; reason: string }[];
  timing: { software_rasterizer: boolean };
  costs: Record<string, number>;
  times_ms: Record<string, Times>;
  lights: LightResult[];
  views?: Views;
  camera?: { eye: Vec3; forward: Vec3; corners: Vec3[]; finite_bounds: Vec3[] | null };
  time_budget?: { stage: string; wall_ms: number }[];
  judged?: { renderer: { name: string; version: string }; ratio: boolean; identified: object | null };
}

export interface LabelFacts {
  key: string; // of the document
  value: number; // 1 and more: an error
  name: string;
  letter: string;
  what: string;
  cause: string;
  cure: string;
  colour: string;
  lesson: string;
}

export interface LessonFacts {
  title: string;
  html: string;
  command: string;
}

/** What has moved since the last frame, and what each side then makes for the shadows. */
export interface ShadowSituation {
  key: string;
  words: string;
  made: string;
}

interface LightFacts {
  name: string;
  verdict: { headline: string; detail: string; whole: string };
  window: string; // what the map holds, in sentences
  contradiction: string; // of a best bias that is not right everywhere
  smaller: { constant_world: number; wrong_fraction: number } | null; // a constant that leaves hardly more than the best
  depth: { near: number; far: number; perspective: boolean; texels_per_pixel: number } | null;
}

export interface Facts {
  labels: LabelFacts[];
  rungs: { symbol: string; name: string; what: string; step?: string }[];
  lessons: Record<string, LessonFacts>;
  map: string; // what shadows are drawn with
  bias_parts: string[]; // beside the constant
  compares_depths: boolean;
  edge_scale_texels: number;
  detachment_scale_texels: number;
  reduced: string; // what the page leaves out of a large picture
  peak_memory_bytes: number;
  software_note: string;
  shadow_situations: ShadowSituation[];
  light_facts: LightFacts[];
  judged?: [name: string, value: string][];
  tune?: TuneFacts;
}

export const result = resultDocument<Result>(),
  facts = pageData<Facts>();

/** Another renderer's picture, whose depth map is not known: two steps are told apart, light size and all the rest. */
export const lacksMap = (): boolean => result.lights.some(({ map }) => map.size === null);
/** The name of the step that leads from rung k to the next. */
export const stepName = (k: number): string => (lacksMap() && k === 1 ? "unexplained" : facts.rungs[k + 1]!.step!);

/** ", NAME" where there are several lights. */
export const ofLight = (i: number): string => (result.lights.length > 1 ? `, ${facts.light_facts[i]!.name}` : "");

/** A pass by its key, or that it was not timed. */
export const timed = (key: string, { runs }: Times): Markup =>
  runs.length === 0 ? markup`not timed` : keyed(`${key}.median`, milliseconds);

export const shareOf = (part: number, whole: number): string => percent(part / Math.max(whole, 1));

/** A side's time in a situation ("casters_move_rays"), with its interval. */
export function shadowTime({ times_ms: { shadows } }: LightResult, i: number, side: string): Markup {
  const [low, median, high] = [`${side}_low`, side, `${side}_high`].map((key) => shadows?.[key] ?? null);
  if (low === null || median === null || high === null) return markup`not timed`;
  return keyed(`lights.${i}.times_ms.shadows.${side}`, () => timeDifference({ low: low!, median: median!, high: high!, told: low! > 0 }));
}

export function lessonDetails(name: string): Markup {
  const { title, html, command } = facts.lessons[name]!;
  return markup`<details class="lesson" data-lesson="${name}"><summary>Lesson: ${title}</summary>
${new Markup(html)}<p>Try <code>${command}</code>; the whole lesson is docs/lessons/${name}.md.</p></details>
`;
}

/** The headline large, what else there is to say below it. */
export const verdictBlock = ({ headline, detail }: LightFacts["verdict"]): Markup =>
  markup`<p class="verdict">${flowing(headline)}</p>\n${detail && markup`<p class="verdict-detail">${flowing(detail)}</p>\n`}`;

export const plain = (key: string): Markup => keyed(key, plainNumber);
