// One pixel's story in words: what the map stores, what the test makes of it, and which step made it wrong.
import { page, wordsOf, type Light, type LightJson, type Pixel, type ShownMaterial } from "./data";
import { number, texelsText } from "./svg";

const precision = 2, precisionStep = 4, filterStep = 6;  // a label's value; rungs

/** The step that the label of a wrong pixel names (docs/labels.md), by the rung it leads to; 0: the pixel is right. */
export function decidingStep({ label, rungs }: Pixel): number {
  if (label <= 0) return 0;
  if (label === precision) return precisionStep;
  const wrong = (k: number) => Math.abs(rungs[k]! - rungs[0]!) > 0.5;
  const rises = rungs.flatMap((_, k) => (k > 0 && wrong(k) && !wrong(k - 1) ? [k] : []));
  if (rungs[6]! < rungs[0]!) return rises.at(-1) ?? 0;
  return wrong(5) ? rises[0] ?? 0 : filterStep;
}

function wentWrong(pixel: Pixel): string {
  const words = wordsOf(pixel.label), step = decidingStep(pixel);
  if (pixel.label === precision) return `With the exact depth in place of the stored one it would be right: ${words.what}.`;
  return `It went wrong on the step from V${step - 1} to V${step}, ${page.rungs[step]!.step ?? ""}: ${words.what}.`;
}

// Of what mirrors or transmits only the surface's own light and shadow are compared; the picture shows more.
const brightness = (pixel: Pixel, v: number): string =>
  pixel.material ? (v > 0.5 ? "the light reaches the surface" : "the light does not reach the surface")
                 : v > 0.5 ? "lit" : "in shadow";
const testGives = (pixel: Pixel, dark: boolean): string =>
  pixel.material ? `gives the surface ${dark ? "no light" : "the light"}` : `draws it ${dark ? "in shadow" : "lit"}`;

/** What a bias is made of besides its constant, in words; empty where there is nothing. */
export function otherParts({ slope, normal_offset: offset, receiver_plane: plane, adaptive }: LightJson["bias"]): string {
  const parts = [slope !== 0 ? "the slope bias" : "", offset !== 0 ? "the normal offset" : "", plane ? "the receiver's plane" : "", adaptive !== null ? "the adaptive bias" : ""];
  return parts.filter((part) => part !== "").join(" and ");
}

function mapTest(light: Light, pixel: Pixel, bias: number): string {
  const outside = [pixel.at.u, pixel.at.v].some((t) => t < 0 || t >= light.json.view.size);
  if (pixel.gap === -Infinity)
    return outside ? "The pixel lies outside the map, so the test lets it be lit." : "The map stores nothing where this pixel looks, so the test lets it be lit.";
  const texel = `Texel ${Math.floor(pixel.at.u)}, ${Math.floor(pixel.at.v)}`, dark = pixel.gap > Math.fround(bias);
  // The gap is what the other parts of the bias leave for its constant to cover.
  const parts = otherParts(light.json.bias), allowed = `than ${parts} allow${/ and /.test(parts) ? "" : "s"} for`;
  const constant = `the ${parts === "" ? "" : "constant "}bias of ${number(bias, 3)}`, distance = number(Math.abs(pixel.gap), 3);
  if (pixel.gap <= 0)
    return (parts === "" ? `${texel} stores a depth ${distance} behind this point` : `${texel} stores nothing nearer the light ${allowed}`) +
      `, so the test ${testGives(pixel, dark)} at ${constant}.`;
  return `${texel} stores something ${distance} (${texelsText(pixel.gap / light.json.texel_world)}) nearer the light${parts === "" ? "" : ` ${allowed}`}. ` +
    `That is ${dark ? "more" : "no more"} than ${constant}: the test ${testGives(pixel, dark)}.`;
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
  const [truth, single, drawn] = [pixel.rungs[0]!, pixel.rungs[5]!, pixel.rungs[6]!];
  const looked = isFinite(pixel.gap) ? `${mapTest(light, pixel, bias)} ` : "";
  const test = `${looked}A single test at this bias gives ${number(single, 3)}; ` +
    (drawn === single ? `${light.json.technique} changes nothing here: drawn ${number(drawn, 3)}.` : `${light.json.technique} reads more of the map than that and draws ${number(drawn, 3)}.`) +
    ` The exact rays give ${number(truth, 3)}.`;
  return `${test} ${pixel.label === 0 ? "So it is right to within one half." : wentWrong(pixel)}`;
}

/** Of a picture whose map is not known. */
function comparedAlone(pixel: Pixel): string {
  return `Drawn ${number(pixel.rungs[6]!, 3)}; the exact rays give ${number(pixel.rungs[0]!, 3)}. ` +
    (pixel.label === 0 ? "So it is right to within one half." : `${wordsOf(pixel.label).what}.`);
}

function compared(light: Light, pixel: Pixel, bias: number): string {
  if (!light.json.map_known) return comparedAlone(pixel);
  if (!light.json.compares_depths) return exactly(light, pixel, bias);
  if (!light.json.gaps_decide) return filtered(light, pixel, bias);
  const lit = pixel.rungs[0]! > 0.5, drawn = light.litAt(pixel.index, bias);
  const test = `${mapTest(light, pixel, bias)} The exact ray says: ${brightness(pixel, pixel.rungs[0]!)}.`;
  if (bias !== light.json.bias.constant) return `${test} With this bias it is drawn ${lit === drawn ? "right" : "wrong"}.`;
  return `${test} ${pixel.label === 0 ? "So it is right." : wentWrong(pixel)}`;
}

export function story(light: Light, pixel: Pixel, bias: number): string {
  return pixel.label < 0 ? `Not compared: ${wordsOf(pixel.label).what}.` : compared(light, pixel, bias);
}

const named = ({ name }: ShownMaterial, kind: string): string => (name === "" ? kind : `${kind} (material “${name}”)`);

/** What the pictures show here beside what is compared: mirrors and glass; empty for a plain surface in plain light. */
export function remarks(pixel: Pixel): string[] {
  const { material, storedGlass } = pixel, out: string[] = [];
  if (material) {
    const glass = material.transmission > 0, shows = glass ? "what is seen through it and mirrored in it" : "what is mirrored in it";
    out.push(`This surface is ${named(material, glass ? "glass" : "a mirror")}. The ray-traced picture adds ${shows}, so it may be bright here without any light of its own; ` +
      `the rasterizer draws matte grey in place of that.${glass ? " The map takes it for opaque." : ""} Compared is only the shadow on the surface itself.`);
  }
  if (storedGlass)
    out.push(`The texel looked up holds ${named(storedGlass, "glass")}, which the map and the comparison take for opaque. In the ray-traced picture light passes through it, so this pixel may be bright there though its shadow is counted as full.`);
  return out;
}
