// The document of a comparison, result.json, whose types are made from its schema (../result_types.mjs), and what the program says
// beside it (../../facts.cpp).
import type { Result, ResultLight, ResultTime } from "../generated/result";
import { keyed, resultDocument } from "./document";
import { milliseconds, percent, plainNumber, timeDifference } from "./number_text";
import { pageData } from "./parts";
import { flowing, markup, Markup } from "./template";
import type { TuneFacts } from "./tune_sections";

export type { ResultLight as LightResult, ResultTime as Times };
export type DerivedBias = NonNullable<ResultLight["derived_bias"]>;
export type BiasPoint = ResultLight["bias_curve"][number];
export type BestBias = ResultLight["best_bias"];
/** What a setting errs by from several views, and where: squares seen from above. */
export type Views = NonNullable<Result["views"]>;

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
/** What stands for the map in times, as the program says it (twin: shadow_side() of ../../../compare/result/shadow_cost.h). */
export const shadowSide = ({ map }: ResultLight): string => (map.rays ? "few rays" : map.hybrid ? "hybrid" : "map");
/** The name of the step that leads from rung k to the next. */
export const stepName = (k: number): string => (lacksMap() && k === 1 ? "unexplained" : facts.rungs[k + 1]!.step!);

/** ", NAME" where there are several lights. */
export const ofLight = (i: number): string => (result.lights.length > 1 ? `, ${facts.light_facts[i]!.name}` : "");

/** A pass by its key, or that it was not timed. */
export const timed = (key: string, { runs }: ResultTime): Markup =>
  runs.length === 0 ? markup`not timed` : keyed(`${key}.median`, milliseconds);

export const shareOf = (part: number, whole: number): string => percent(part / Math.max(whole, 1));

/** A side's time in a situation ("casters_move_rays"), with its interval. */
export function shadowTime({ times_ms }: ResultLight, i: number, side: string): Markup {
  const shadows: Record<string, number | null> | undefined = times_ms.shadows;
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
