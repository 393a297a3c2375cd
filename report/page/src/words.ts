// One pixel's story in words: what the map stores, what the test makes of it, and which step made it wrong. Here stands what
// holds of a pixel; what is said then is chosen in phrases.json, as in the program (../../pixel_words.cpp).
import { page, wordsOf, type Light, type LightJson, type Pixel, type ShownMaterial } from "./data";
import phrases from "../../phrases.json";
import { texelsText } from "./number_text";
import { number } from "./svg";

const precision = 2,
  blur = 8,
  lightSize = 9,
  blurOfRays = 3,
  precisionStep = 4,
  filterStep = 6; // labels' values; rungs

/** Whether few rays were cast and denoised: the rungs are those of the denoiser. */
export const ofRays = (): boolean => page.rungs[blurOfRays]!.step === "blur";

/** The step that the label of an error names (docs/labels.md), by the rung it leads to; 0: the pixel is right. */
export function decidingStep({ label, rungs }: Pixel): number {
  if (label <= 0) return 0;
  if (label === precision) return precisionStep;
  const error = rungs[6]! - rungs[0]!,
    most = Math.abs(error) > 0.5 ? 0.5 : Math.abs(error) / 2;
  if (!ofRays() && Math.abs(error) <= 0.5 && (label === blur || label === lightSize)) return label === blur ? filterStep : 1;
  const wrong = (k: number) => (error < 0 ? rungs[0]! - rungs[k]! : rungs[k]! - rungs[0]!) > most;
  const rises = rungs.flatMap((_, k) => (k > 0 && wrong(k) && !wrong(k - 1) ? [k] : []));
  if (rungs[6]! < rungs[0]!) return rises.at(-1) ?? 0;
  return wrong(5) ? (rises[0] ?? 0) : filterStep;
}

type Facts = Record<string, string | number | boolean>;

/** The first of a phrase's forms whose words all hold, its places filled in; a place that has no value is a phrase itself. */
function say(name: string, facts: Facts = {}): string {
  const phrase = (phrases as unknown as Record<string, string | [words: string, form: string][]>)[name]!;
  const form =
    typeof phrase === "string"
      ? phrase
      : phrase.find(([words]) => words.split(" ").every((word) => word === "" || facts[word] === true))![1];
  return form.replace(/\{(\w+)\}/g, (_, place: string) =>
    facts[place] === undefined || typeof facts[place] === "boolean" ? say(place, facts) : String(facts[place]),
  );
}

/** What a bias is made of besides its constant; none where there is nothing. */
function partsOf({ slope, normal_offset: offset, receiver_plane: plane, adaptive }: LightJson["bias"]): string[] {
  return [
    slope !== 0 ? say("slope_bias") : "",
    offset !== 0 ? say("normal_offset") : "",
    plane ? say("receiver_plane") : "",
    adaptive !== null ? say("adaptive_bias") : "",
  ].filter((part) => part !== "");
}
/** What a bias is made of besides its constant, in words. */
export const otherParts = (bias: LightJson["bias"]): string => partsOf(bias).join(say("and"));

function mapTest(light: Light, pixel: Pixel, bias: number): Facts {
  const parts = partsOf(light.json.bias);
  // The gap is what the other parts of the bias leave for its constant to cover.
  return {
    outside: [pixel.at.u, pixel.at.v].some((t) => t < 0 || t >= light.json.view.size),
    empty: !isFinite(pixel.gap),
    behind: pixel.gap <= 0,
    dark: pixel.gap > Math.fround(bias),
    with_parts: parts.length > 0,
    several_parts: parts.length > 1,
    parts: parts.join(say("and")),
    u: Math.floor(pixel.at.u),
    v: Math.floor(pixel.at.v),
    bias: number(bias, 3),
    distance: number(Math.abs(pixel.gap), 3),
    texels: texelsText(pixel.gap / light.json.texel_world),
  };
}

function wrongStep(pixel: Pixel): Facts {
  const step = decidingStep(pixel);
  return {
    what: wordsOf(pixel.label).what,
    by_precision: pixel.label === precision,
    before: step - 1,
    step,
    change: page.rungs[step]!.step ?? "",
  };
}

const decisions = ["surely_in_shadow", "surely_lit", "not_sure"];

export function story(light: Light, pixel: Pixel, bias: number): string {
  const { json, decision } = light,
    other_bias = json.gaps_decide && pixel.label >= 0 && bias !== json.bias.constant,
    [truth, single, drawn] = [pixel.rungs[0]!, pixel.rungs[5]!, pixel.rungs[6]!];
  return say("story", {
    not_compared: pixel.label < 0,
    without_map: !json.map_known,
    one_ray: ofRays() && !json.sized,
    few_rays: ofRays(),
    as_cast: json.as_cast,
    exact: !json.compares_depths,
    filtered: !json.gaps_decide,
    other_bias,
    drawn_right: other_bias && light.wrongAt(pixel.index, bias) === 0,
    right: pixel.label === 0,
    shows_more: pixel.material !== null,
    lit: truth > 0.5,
    as_rays: drawn === truth,
    unchanged: drawn === single,
    truth: number(truth, 3),
    single: number(single, 3),
    drawn: number(drawn, 3),
    through: number(pixel.rungs[4]!, 3),
    technique: json.technique,
    by_columns: Boolean(decision),
    [(decision && decisions[decision[pixel.index]!]) ?? "undecided"]: true,
    ...wrongStep(pixel),
    ...mapTest(light, pixel, bias),
  });
}

const remark = (name: string, material: ShownMaterial, glass: boolean): string =>
  say(name, { glass, named: material.name !== "", name: material.name });

/** What the pictures show here beside what is compared: mirrors and glass; empty for a plain surface in plain light. */
export const remarks = ({ seen, material, storedGlass }: Pixel): string[] =>
  !seen
    ? []
    : [
        ...(material ? [remark("shown", material, material.transmission > 0)] : []),
        ...(storedGlass ? [remark("stored_glass", storedGlass, true)] : []),
      ];
