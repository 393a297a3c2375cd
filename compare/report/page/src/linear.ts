// Linear pictures: 16-bit floats (compare/report/page_data.cpp) and what they look like at an exposure. One table of
// 65536 entries per exposure makes a change of it quick.
import { page, type PictureName, type Pixels } from "./data";

const table = new Float32Array(65536);
for (let h = 0; h < table.length; ++h) {
  const sign = h & 0x8000 ? -1 : 1, exponent = (h >> 10) & 31, fraction = h & 1023;
  table[h] = sign * (exponent === 0 ? fraction * 2 ** -24 : exponent === 31 ? (fraction ? NaN : Infinity) : (1 + fraction / 1024) * 2 ** (exponent - 15));
}

/** IEC 61966-2-1. */
export const srgbFromLinear = (v: number): number => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

const shown = new Uint8Array(65536);
let shownAt = NaN;
/** The 8-bit sRGB value of each 16-bit float at an exposure in stops over the page's own. */
function encoded(stops: number): Uint8Array {
  if (stops === shownAt) return shown;
  const factor = page.exposure * 2 ** stops;
  for (let h = 0; h < shown.length; ++h) {
    const v = table[h]! * factor;
    shown[h] = Math.floor(255 * srgbFromLinear(Math.min(Math.max(v, 0) || 0, 1)) + 0.5);
  }
  shownAt = stops;
  return shown;
}

/** Linear red, green and blue of a pixel. */
export const linearAt = (pixels: Pixels, name: PictureName, index: number): number[] =>
  pixels.picture(name).map((channel) => table[channel[index]! & 0xffff]!);

export function colourAt(pixels: Pixels, name: PictureName, index: number): number[] {
  const bytes = encoded(0);
  return pixels.picture(name).map((channel) => bytes[channel[index]! & 0xffff]!);
}

export function exposed(pixels: Pixels, name: PictureName, stops: number): ImageData {
  const bytes = encoded(stops), image = new ImageData(page.width, page.height), { data } = image;
  const [red, green, blue] = pixels.picture(name) as [Int16Array, Int16Array, Int16Array];
  for (let i = 0, o = 0; i < red.length; ++i, o += 4) {
    data[o] = bytes[red[i]! & 0xffff]!;
    data[o + 1] = bytes[green[i]! & 0xffff]!;
    data[o + 2] = bytes[blue[i]! & 0xffff]!;
    data[o + 3] = 255;
  }
  return image;
}
