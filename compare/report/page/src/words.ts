// One pixel's story in words: what the map stores, what the test makes of it, and which step made it wrong.
import { page, wordsOf, type Light, type Pixel } from "./data";
import { number } from "./svg";

/** The step at which the visibility last became wrong (DESIGN.md, section 3), or 0 when it never did. */
export function decidingStep(rungs: number[]): number {
  let step = 0;
  for (let k = 1; k < rungs.length; ++k) {
    const wrong = (i: number) => Math.abs(rungs[i]! - rungs[0]!) > 0.5;
    if (wrong(k) && !wrong(k - 1)) step = k;
  }
  return step;
}

const brightness = (v: number): string => (v > 0.5 ? "lit" : "in shadow");

function mapTest(light: Light, pixel: Pixel, bias: number): string {
  const texels = (d: number) => `${number(d / light.json.texel_world, 2)} texels`;
  const outside = [pixel.at.u, pixel.at.v].some((t) => t < 0 || t >= light.json.view.size);
  if (pixel.gap === -Infinity)
    return outside ? "The pixel lies outside the map, so the test lets it be lit." : "The map stores nothing where this pixel looks, so the test lets it be lit.";
  const texel = `${Math.floor(pixel.at.u)}, ${Math.floor(pixel.at.v)}`;
  if (pixel.gap <= 0)
    return `Texel ${texel} stores a depth ${number(-pixel.gap, 3)} behind this point, so the test draws it ${pixel.gap > Math.fround(bias) ? "in shadow" : "lit"} at the bias of ${number(bias, 3)}.`;
  return `Texel ${texel} stores something ${number(pixel.gap, 3)} (${texels(pixel.gap)}) nearer the light. ` +
    (pixel.gap > Math.fround(bias) ? `That is more than the bias of ${number(bias, 3)}: the test draws it in shadow.`
                                   : `That is no more than the bias of ${number(bias, 3)}: the test draws it lit.`);
}

const decisions = [
  "In this texel another surface without an edge lies wholly before the pixel's own: surely in shadow, no ray was cast.",
  "In this texel nothing lies before the pixel's own surface, which has no edge there: surely lit, no ray was cast.",
  "The texel is not sure here, because of an edge or of surfaces that overlap in depth: a ray was cast.",
];

/** Techniques that decide exactly: how, and beside it what a hard test of a map of this size would make of the pixel. */
function exactly(light: Light, pixel: Pixel, bias: number): string {
  const [truth, drawn] = [pixel.rungs[0]!, pixel.rungs[6]!];
  const how = light.decision ? decisions[light.decision[pixel.index]!] ?? ""
                             : `${light.json.technique} tests this very point against all that the texel's list holds.`;
  const said = drawn === truth ? `Drawn ${number(drawn, 3)}, as the exact rays say.` : `Drawn ${number(drawn, 3)}; the exact rays give ${number(truth, 3)}.`;
  return `${how} ${said} A hard test without bias, for comparison: ${mapTest(light, pixel, bias)}`;
}

/** Where more than the one texel decides: the single test (V5) first, then what the technique makes of it (V6). */
function filtered(light: Light, pixel: Pixel, bias: number): string {
  const [truth, single, drawn] = [pixel.rungs[0]!, pixel.rungs[5]!, pixel.rungs[6]!], words = wordsOf(pixel.label);
  const looked = isFinite(pixel.gap) ? `${mapTest(light, pixel, bias)} ` : "";
  const test = `${looked}A single test at this bias gives ${number(single, 3)}; ` +
    (drawn === single ? `${light.json.technique} changes nothing here: drawn ${number(drawn, 3)}.` : `${light.json.technique} reads more of the map than that and draws ${number(drawn, 3)}.`) +
    ` The exact rays give ${number(truth, 3)}.`;
  if (pixel.label === 0) return `${test} So it is right to within one half.`;
  const step = decidingStep(pixel.rungs);
  return `${test} It went wrong on the step V${step - 1} to V${step}, ${page.rungs[step]!.step ?? ""}: ${words.what}.`;
}

export function story(light: Light, pixel: Pixel, bias: number): string {
  const words = wordsOf(pixel.label);
  if (pixel.label < 0) return `Not compared: ${words.what}.`;
  if (!light.json.compares_depths) return exactly(light, pixel, bias);
  if (!light.json.gaps_decide) return filtered(light, pixel, bias);
  const lit = pixel.rungs[0]! > 0.5, drawn = light.litAt(pixel.index, bias);
  const test = `${mapTest(light, pixel, bias)} The exact ray says: ${brightness(pixel.rungs[0]!)}.`;
  if (bias !== light.json.bias.constant) return `${test} With this bias it is drawn ${lit === drawn ? "right" : "wrong"}.`;
  if (pixel.label === 0) return `${test} So it is right.`;
  const step = decidingStep(pixel.rungs);
  return `${test} It went wrong on the step V${step - 1} to V${step}, ${page.rungs[step]!.step ?? ""}: ${words.what}.`;
}
