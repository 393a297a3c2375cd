// The fixed scales of the pictures that show numbers, each with its legend; their colours are the program's.
import { palette } from "./parts";
import { html } from "./svg";

export type Rgb = readonly [number, number, number];
export const rgbOf = (colour: string): Rgb => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16)) as unknown as Rgb;
export const falseShadow = rgbOf(palette.false_shadow),
  missedShadow = rgbOf(palette.missed_shadow);

const magmaStops = palette.magma.map(rgbOf);

/** Dark: no error; pale: 1. */
export function magma(t: number): Rgb {
  const x = Math.min(Math.max(t, 0), 1) * (magmaStops.length - 1),
    i = Math.min(Math.floor(x), magmaStops.length - 2);
  const a = magmaStops[i]!,
    b = magmaStops[i + 1]!;
  return [0, 1, 2].map((k) => Math.floor(a[k]! + (b[k]! - a[k]!) * (x - i) + 0.5)) as unknown as Rgb;
}

const css = ([r, g, b]: Rgb): string => `rgb(${r} ${g} ${b})`;
const gradient = (stops: Rgb[]): string => `linear-gradient(to right, ${stops.map(css).join(", ")})`;

interface Scale {
  from: string;
  to: string;
  gradient: string;
}
const error: Omit<Scale, "to"> = { from: "0", gradient: gradient(magmaStops) };

/** The scales of the pictures that have one, by the names of these in the viewer. */
export const scales: Record<string, Scale> = {
  truth: {
    from: "0, in shadow",
    to: "1, lit",
    gradient: gradient([
      [0, 0, 0],
      [255, 255, 255],
    ]),
  },
  drawn: {
    from: "0, in shadow",
    to: "1, lit",
    gradient: gradient([
      [0, 0, 0],
      [255, 255, 255],
    ]),
  },
  gap: { from: "−4 texels, nearer than stored", to: "4 texels, beyond", gradient: gradient([missedShadow, [255, 255, 255], falseShadow]) },
  "absolute error": { ...error, to: "1" },
  FLIP: { ...error, to: "1, nothing alike" },
  "1 − SSIM": { ...error, to: "1, nothing alike" },
};

export function legend(name: string): HTMLElement | null {
  const scale = scales[name];
  if (!scale) return null;
  const bar = html("span", { class: "scale" });
  bar.style.background = scale.gradient;
  return html("span", { class: "scale-row" }, html("b", {}, name), html("span", {}, scale.from), bar, html("span", {}, scale.to));
}
