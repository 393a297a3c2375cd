// Pictures drawn from the pixels' numbers. Fixed scales: the same colours mean the same in every picture.
import { falseShadow, magma, missedShadow, rgbOf, type Rgb } from "./colour_maps";
import { page, wordsOf, type Light, type Pixels } from "./data";
import { exposed } from "./linear";

export const byId = (id: string): HTMLImageElement | null => document.getElementById(id) as HTMLImageElement | null;

export const hex = (colour: ArrayLike<number>): string => "#" + [0, 1, 2].map((k) => colour[k]!.toString(16).padStart(2, "0")).join("");

export function dataUrl(pixels: ImageData): string {
  const canvas = document.createElement("canvas");
  canvas.width = pixels.width;
  canvas.height = pixels.height;
  canvas.getContext("2d")!.putImageData(pixels, 0, 0);
  return canvas.toDataURL("image/png");
}

/** A picture of the frame's size from a colour for each pixel. */
export function painted(colour: (index: number) => Rgb, size = { width: page.width, height: page.height }): ImageData {
  const out = new ImageData(size.width, size.height);
  for (let i = 0, o = 0; o < out.data.length; ++i, o += 4) {
    const c = colour(i);
    out.data[o] = c[0];
    out.data[o + 1] = c[1];
    out.data[o + 2] = c[2];
    out.data[o + 3] = 255;
  }
  return out;
}

const unseen: Rgb = [60, 62, 66];

/** A picture of a light by its name in the viewer; null: none of these. */
export function lightPicture(light: Light, name: string): ImageData | null {
  const steps = page.visibility_steps,
    compared = (colour: (i: number) => Rgb) => painted((i) => (light.label[i]! < 0 ? unseen : colour(i)));
  const grey = (v: number): Rgb => [v, v, v];
  const mix = (c: Rgb, t: number): Rgb => c.map((v) => Math.round(255 + (v - 255) * t)) as unknown as Rgb;
  switch (name) {
    case "truth":
      return compared((i) => grey(Math.round((255 * light.truth[i]!) / steps)));
    case "drawn":
      return compared((i) => grey(Math.round((255 * light.drawn[i]!) / steps)));
    case "gap":
      return compared((i) => {
        const texels = light.gap[i]! / light.json.texel_world;
        return texels < 0 ? mix(missedShadow, Math.min(1, -texels / 4)) : mix(falseShadow, Math.min(1, texels / 4));
      });
    case "absolute error":
      return compared((i) => magma(Math.abs(light.drawn[i]! - light.truth[i]!) / steps));
    case "FLIP":
      return light.flip && painted((i) => magma(light.flip![i]! / 100));
    case "1 − SSIM":
      return light.ssim && painted((i) => (light.ssim![i] === -128 ? unseen : magma(1 - light.ssim![i]! / 100)));
    default:
      return null;
  }
}

/** The names of these pictures; those of what the page does not know of this light are left out. */
export const lightPictureNames = (light: Light): string[] => [
  "truth",
  "drawn",
  ...(light.json.map_known ? ["gap"] : []),
  "absolute error",
  ...(light.flip ? ["FLIP"] : []),
  ...(light.ssim ? ["1 − SSIM"] : []),
];

/** The label picture with every other label faded towards white. */
export function isolatedLabel(labels: ArrayLike<number>, wanted: number, size?: { width: number; height: number }): ImageData {
  const faded = new Map<number, Rgb>(),
    whole = rgbOf(wordsOf(wanted).colour);
  return painted((i) => {
    const label = labels[i]!;
    if (label === wanted) return whole;
    let colour = faded.get(label);
    if (!colour) {
      const [r, g, b] = rgbOf(wordsOf(label).colour),
        grey = Math.round(200 + 0.2 * (0.3 * r + 0.6 * g + 0.1 * b));
      faded.set(label, (colour = [grey, grey, grey]));
    }
    return colour;
  }, size);
}

export interface Recoloured {
  falseShadow: number;
  missedShadow: number;
  ties: number; // of which exactly half the light is seen: as near to right as to wrong at any bias
}

// A colour as one number, red in the lowest byte: ImageData's order on little-endian machines, which browsers run on.
const pixelOf = ([r, g, b]: Rgb): number => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** What a constant bias would draw wrong, over a backdrop; writes into `out`. Arrays of pixels as numbers. */
export function recolour(light: Light, bias: number, backdrop: Uint32Array, out: Uint32Array): Recoloured {
  const counts = { falseShadow: 0, missedShadow: 0, ties: 0 };
  const threshold = Math.fround(bias),
    half = 0.5 * page.visibility_steps,
    { gap, label, truth } = light;
  const orange = pixelOf(falseShadow),
    blue = pixelOf(missedShadow);
  out.set(backdrop);
  for (let i = 0; i < gap.length; ++i) {
    if (label[i]! < 0) continue;
    const dark = gap[i]! > threshold,
      seen = truth[i]!;
    if (seen === half) ++counts.ties;
    else if (dark && seen > half) {
      ++counts.falseShadow;
      out[i] = orange;
    } else if (!dark && seen < half) {
      ++counts.missedShadow;
      out[i] = blue;
    }
  }
  return counts;
}

/** Grey of the ray-traced picture, between 64 and 232, so that both error colours stand out from it. */
export function backdropOf(pixels: Pixels): Uint32Array {
  const { data } = exposed(pixels, "raytraced", 0),
    backdrop = new Uint32Array(data.length / 4);
  for (let i = 0, o = 0; i < backdrop.length; ++i, o += 4) {
    const grey = Math.floor(64.5 + ((0.2126 * data[o]! + 0.7152 * data[o + 1]! + 0.0722 * data[o + 2]!) * 168) / 255);
    backdrop[i] = pixelOf([grey, grey, grey]);
  }
  return backdrop;
}
