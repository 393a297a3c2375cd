// Linear pictures: logarithms in steps of an octave (../../page_data.cpp) and what they look like at an exposure. A table
// of every step makes a change of it quick.
import { page, type PictureName, type Pixels } from "./data";

const table = new Float32Array(4096); // 24 octaves of 64 steps below one, as many above, and black
for (let k = 1; k < table.length; ++k) table[k] = 2 ** (page.darkest_octave + (k - 1) / page.colour_steps);

/** IEC 61966-2-1. */
export const srgbFromLinear = (v: number): number => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

const shown = new Uint8Array(table.length);
let shownAt = NaN;
/** The 8-bit sRGB value of each step at an exposure in stops over the comparison's own. */
function encoded(pixels: Pixels, stops: number): Uint8Array {
  const factor = pixels.comparison.exposure * 2 ** stops;
  if (factor === shownAt) return shown;
  for (let h = 0; h < shown.length; ++h) {
    const v = table[h]! * factor;
    shown[h] = Math.floor(255 * srgbFromLinear(Math.min(Math.max(v, 0) || 0, 1)) + 0.5);
  }
  shownAt = factor;
  return shown;
}

/** Linear red, green and blue of a pixel. */
export const linearAt = (pixels: Pixels, name: PictureName, index: number): number[] =>
  pixels.picture(name).map((channel) => table[channel[index]!]!);

export function colourAt(pixels: Pixels, name: PictureName, index: number): number[] {
  const bytes = encoded(pixels, 0);
  return pixels.picture(name).map((channel) => bytes[channel[index]!]!);
}

export function exposed(pixels: Pixels, name: PictureName, stops: number): ImageData {
  const bytes = encoded(pixels, stops),
    image = new ImageData(page.width, page.height),
    { data } = image;
  const [red, green, blue] = pixels.picture(name) as [Int16Array, Int16Array, Int16Array];
  for (let i = 0, o = 0; i < red.length; ++i, o += 4) {
    data[o] = bytes[red[i]!]!;
    data[o + 1] = bytes[green[i]!]!;
    data[o + 2] = bytes[blue[i]!]!;
    data[o + 3] = 255;
  }
  return image;
}
