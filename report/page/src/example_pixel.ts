// Something to see before anybody has pointed at anything.
import { page, type Light, type Pixel } from "./data";

/** The pixel nearest to the picture's middle of a label, or of the one with most of the error; wrong if any is. */
export function examplePixel(light: Light, label?: number): Pixel {
  const counts = new Map<number, number>(),
    error = (i: number) => Math.abs(light.drawn[i]! - light.truth[i]!) / page.visibility_steps;
  if (label === undefined) light.label.forEach((l, i) => counts.set(l, (counts.get(l) ?? 0) + (l > 0 ? error(i) : 1)));
  const rank = (l: number) => (l > 0 ? 2e9 : l === 0 ? 1e9 : 0) + counts.get(l)!;
  const wanted = label ?? [...counts.keys()].sort((a, b) => rank(b) - rank(a))[0]!;
  let best = 0,
    least = Infinity;
  light.label.forEach((l, i) => {
    const away =
      Math.hypot((i % page.width) - page.width / 2, Math.floor(i / page.width) - page.height / 2) + (l > 0 && error(i) <= 0.5 ? 1e6 : 0);
    if (l === wanted && away < least) [best, least] = [i, away];
  });
  return light.pixel(best % page.width, Math.floor(best / page.width));
}
