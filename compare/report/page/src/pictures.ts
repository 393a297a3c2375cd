// The pixels of the page's pictures, and pictures drawn from the pixels' numbers. Fixed scales: the same colours mean
// the same in every picture (compare/palette.cpp).
import type { Light } from "./data";
import { page } from "./data";

export type Rgb = readonly [number, number, number];
export const falseShadow: Rgb = [213, 94, 0], missedShadow: Rgb = [86, 180, 233];

export const byId = (id: string): HTMLImageElement => document.getElementById(id) as HTMLImageElement;

const cache = new Map<string, ImageData>();
/** The pixels of an <img>, read once, from its first source. */
export function pixelsOf(image: HTMLImageElement): ImageData {
  const known = cache.get(image.id);
  if (known) return known;
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(image, 0, 0);
  const data = context.getImageData(0, 0, canvas.width, canvas.height);
  cache.set(image.id, data);
  return data;
}

export const hex = (colour: ArrayLike<number>, at = 0): string =>
  "#" + [0, 1, 2].map((k) => colour[at + k]!.toString(16).padStart(2, "0")).join("");

export function colourAt(image: HTMLImageElement, x: number, y: number): string {
  const pixels = pixelsOf(image);
  return hex(pixels.data, 4 * (y * pixels.width + x));
}

export function dataUrl(pixels: ImageData): string {
  const canvas = document.createElement("canvas");
  canvas.width = pixels.width;
  canvas.height = pixels.height;
  canvas.getContext("2d")!.putImageData(pixels, 0, 0);
  return canvas.toDataURL("image/png");
}

/** A picture of the frame's size from a colour for each pixel. */
export function painted(colour: (index: number) => Rgb): ImageData {
  const out = new ImageData(page.width, page.height);
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
export function truthPicture(light: Light): ImageData {
  return painted((i) => {
    if (light.label[i]! < 0) return unseen;
    const grey = Math.round((255 * light.truth[i]!) / page.visibility_steps);
    return [grey, grey, grey];
  });
}

/** Gap in texel widths, from -4 (light blue) over 0 (white) to 4 (orange). */
export function gapPicture(light: Light): ImageData {
  const mix = (c: Rgb, t: number): Rgb => c.map((v) => Math.round(255 + (v - 255) * t)) as unknown as Rgb;
  return painted((i) => {
    if (light.label[i]! < 0) return unseen;
    const texels = light.gap[i]! / light.json.texel_world;
    return texels < 0 ? mix(missedShadow, Math.min(1, -texels / 4)) : mix(falseShadow, Math.min(1, texels / 4));
  });
}

export interface Recoloured {
  falseShadow: number;
  missedShadow: number;
}

// A colour as one number, red in the lowest byte: ImageData's order on little-endian machines, which browsers run on.
const pixelOf = ([r, g, b]: Rgb): number => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** What a constant bias would draw wrong, over a backdrop; writes into `out`. Arrays of pixels as numbers. */
export function recolour(light: Light, bias: number, backdrop: Uint32Array, out: Uint32Array): Recoloured {
  const counts = { falseShadow: 0, missedShadow: 0 };
  const threshold = Math.fround(bias), half = 0.5 * page.visibility_steps, { gap, label, truth } = light;
  const orange = pixelOf(falseShadow), blue = pixelOf(missedShadow);
  out.set(backdrop);
  for (let i = 0; i < gap.length; ++i) {
    if (label[i]! < 0) continue;
    const dark = gap[i]! > threshold, lit = truth[i]! > half;
    if (dark && lit) {
      ++counts.falseShadow;
      out[i] = orange;
    } else if (!dark && !lit) {
      ++counts.missedShadow;
      out[i] = blue;
    }
  }
  return counts;
}

/** Grey of a picture, between 64 and 232, so that both error colours stand out from it. */
export function backdropOf(image: HTMLImageElement): Uint32Array {
  const { data } = pixelsOf(image), backdrop = new Uint32Array(data.length / 4);
  for (let i = 0, o = 0; i < backdrop.length; ++i, o += 4) {
    const grey = Math.floor(64.5 + ((0.2126 * data[o]! + 0.7152 * data[o + 1]! + 0.0722 * data[o + 2]!) * 168) / 255);
    backdrop[i] = pixelOf([grey, grey, grey]);
  }
  return backdrop;
}
