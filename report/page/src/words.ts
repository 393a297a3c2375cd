// One pixel's story in words: what the map stores, what the test makes of it, and which step made it wrong. The program
// tells the same story (twin: ../../pixel_words.cpp), from the same phrases.
import { page, wordsOf, type Light, type LightJson, type Pixel, type ShownMaterial } from "./data";
import phrases from "../../phrases.json";
import { texelsText } from "./number_text";
import { number } from "./svg";

const precision = 2, blur = 8, lightSize = 9, precisionStep = 4, filterStep = 6;  // labels' values; rungs

/** The step that the label of an error names (docs/labels.md), by the rung it leads to; 0: the pixel is right. */
export function decidingStep({ label, rungs }: Pixel): number {
  if (label <= 0) return 0;
  if (label === precision) return precisionStep;
  const error = rungs[6]! - rungs[0]!, most = Math.abs(error) > 0.5 ? 0.5 : Math.abs(error) / 2;
  if (Math.abs(error) <= 0.5 && (label === blur || label === lightSize)) return label === blur ? filterStep : 1;
  const wrong = (k: number) => (error < 0 ? rungs[0]! - rungs[k]! : rungs[k]! - rungs[0]!) > most;
  const rises = rungs.flatMap((_, k) => (k > 0 && wrong(k) && !wrong(k - 1) ? [k] : []));
  if (rungs[6]! < rungs[0]!) return rises.at(-1) ?? 0;
  return wrong(5) ? rises[0] ?? 0 : filterStep;
}

/** A phrase with its places filled in. */
const say = (name: keyof typeof phrases, places: Record<string, string | number> = {}): string =>
  phrases[name].replace(/\{(\w+)\}/g, (_, place: string) => String(places[place]));

function wentWrong(pixel: Pixel): string {
  const what = wordsOf(pixel.label).what, step = decidingStep(pixel);
  if (pixel.label === precision) return say("went_wrong_by_precision", { what });
  return say("went_wrong", { before: step - 1, step, change: page.rungs[step]!.step ?? "", what });
}

// Of what mirrors or transmits only the surface's own light and shadow are compared; the picture shows more.
const brightness = (pixel: Pixel, v: number): string =>
  pixel.material ? say(v > 0.5 ? "light_reaches" : "light_does_not_reach") : say(v > 0.5 ? "lit" : "in_shadow");
const testGives = (pixel: Pixel, dark: boolean): string =>
  pixel.material ? say(dark ? "gives_no_light" : "gives_light") : say(dark ? "draws_in_shadow" : "draws_lit");

/** What a bias is made of besides its constant; none where there is nothing. */
function partsOf({ slope, normal_offset: offset, receiver_plane: plane, adaptive }: LightJson["bias"]): string[] {
  return [slope !== 0 ? say("slope_bias") : "", offset !== 0 ? say("normal_offset") : "", plane ? say("receiver_plane") : "",
    adaptive !== null ? say("adaptive_bias") : ""].filter((part) => part !== "");
}
/** The same in words. */
export const otherParts = (bias: LightJson["bias"]): string => partsOf(bias).join(say("and"));

function mapTest(light: Light, pixel: Pixel, bias: number): string {
  const outside = [pixel.at.u, pixel.at.v].some((t) => t < 0 || t >= light.json.view.size);
  if (pixel.gap === -Infinity) return say(outside ? "outside" : "nothing_stored");
  const dark = pixel.gap > Math.fround(bias), parts = partsOf(light.json.bias);
  // The gap is what the other parts of the bias leave for its constant to cover.
  const allowed = say(parts.length === 1 ? "allowed_by_one" : "allowed_by_several", { parts: otherParts(light.json.bias) });
  const places = {
    texel: say("texel", { u: Math.floor(pixel.at.u), v: Math.floor(pixel.at.v) }),
    constant: say(parts.length === 0 ? "the_bias" : "the_constant_bias", { bias: number(bias, 3) }),
    distance: number(Math.abs(pixel.gap), 3), texels: texelsText(pixel.gap / light.json.texel_world),
    gives: testGives(pixel, dark), more: say(dark ? "more" : "no_more"), allowed,
  };
  if (pixel.gap <= 0) return say(parts.length === 0 ? "stores_behind" : "stores_nothing_nearer", places);
  return say(parts.length === 0 ? "stores_nearer" : "stores_nearer_than_allowed", places);
}

const decisions = ["surely_in_shadow", "surely_lit", "not_sure"] as const;

/** Techniques that decide exactly: how, and beside it what a hard test of a map of this size would make of the pixel. */
function exactly(light: Light, pixel: Pixel, bias: number): string {
  const truth = number(pixel.rungs[0]!, 3), drawn = number(pixel.rungs[6]!, 3);
  const decided = light.decision ? decisions[light.decision[pixel.index]!] : undefined;
  const how = decided ? say(decided) : light.decision ? "" : say("tests_its_list", { technique: light.json.technique });
  const said = say(pixel.rungs[6] === pixel.rungs[0] ? "drawn_as_rays" : "drawn_not_as_rays", { drawn, truth });
  return `${how} ${said} ${say("for_comparison", { test: mapTest(light, pixel, bias) })}`;
}

/** Where more than the one texel decides: the single test (V5) first, then what the technique makes of it (V6). */
function filtered(light: Light, pixel: Pixel, bias: number): string {
  const [truth, single, drawn] = [pixel.rungs[0]!, pixel.rungs[5]!, pixel.rungs[6]!];
  const looked = isFinite(pixel.gap) ? `${mapTest(light, pixel, bias)} ` : "", technique = light.json.technique;
  const test = `${looked}${say("single_test", { single: number(single, 3) })} ` +
    `${say(drawn === single ? "changes_nothing" : "reads_more", { technique, drawn: number(drawn, 3) })} ` +
    say("rays_give", { truth: number(truth, 3) });
  return `${test} ${pixel.label === 0 ? say("right_within_half") : wentWrong(pixel)}`;
}

/** Of a picture whose map is not known. */
function comparedAlone(pixel: Pixel): string {
  return `${say("drawn_not_as_rays", { drawn: number(pixel.rungs[6]!, 3), truth: number(pixel.rungs[0]!, 3) })} ` +
    (pixel.label === 0 ? say("right_within_half") : say("label_alone", { what: wordsOf(pixel.label).what }));
}

function compared(light: Light, pixel: Pixel, bias: number): string {
  if (!light.json.map_known) return comparedAlone(pixel);
  if (!light.json.compares_depths) return exactly(light, pixel, bias);
  if (!light.json.gaps_decide) return filtered(light, pixel, bias);
  const test = `${mapTest(light, pixel, bias)} ${say("ray_says", { brightness: brightness(pixel, pixel.rungs[0]!) })}`;
  if (bias !== light.json.bias.constant) return `${test} ${say(light.wrongAt(pixel.index, bias) === 0 ? "with_this_bias_right" : "with_this_bias_wrong")}`;
  return `${test} ${pixel.label === 0 ? say("right") : wentWrong(pixel)}`;
}

export function story(light: Light, pixel: Pixel, bias: number): string {
  return pixel.label < 0 ? say("not_compared", { what: wordsOf(pixel.label).what }) : compared(light, pixel, bias);
}

const named = ({ name }: ShownMaterial, kind: string): string => (name === "" ? kind : say("named_material", { kind, name }));

/** What the pictures show here beside what is compared: mirrors and glass; empty for a plain surface in plain light. */
export function remarks({ seen, material, storedGlass }: Pixel): string[] {
  if (!seen) return [];
  const glass = (of: ShownMaterial) => ({ material: named(of, say("glass")) }), out: string[] = [];
  if (material) out.push(material.transmission > 0 ? say("shown_glass", glass(material)) : say("shown_mirror", { material: named(material, say("mirror")) }));
  if (storedGlass) out.push(say("stored_glass", glass(storedGlass)));
  return out;
}
