// What the gaps should be, in depth steps, from map positions, distances, normals and the map. They are the twin of ExpectedGaps in
// ../../light_channels.cpp, by operations that IEEE 754 fixes to the last bit.
import { page, type LightJson } from "./data";
import type { Face, Vec3 } from "./light_view";
import type { Numbers } from "./packed";
import type { PixelSurfaces } from "./surface_prediction";

/** A texel without a depth, and the gap of a pixel that looks one up. */
export const nothingStored = -1,
  endless = -(2 ** 31);

/** What slope bias and receiver plane make of the tilt of a surface with this normal, (x, y) along right and up from the
    face's axis: per unit of distance of a perspective map. */
function tilt(light: LightJson, f: Face, normal: Vec3, u: number, v: number, x: number, y: number): number {
  const { bias, view } = light;
  if (bias.slope === 0 && !bias.receiver_plane) return 0;
  const across = (axis: Vec3) => normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2];
  const right = across(f.right),
    up = across(f.up),
    ahead = across(f.forward) + x * right + y * up;
  if (!(ahead < 0)) return Infinity; // the bias of what faces away has no bound
  const byU = (right * f.half_extent[0]) / view.size / ahead,
    byV = (up * f.half_extent[1]) / view.size / ahead;
  const toCentre = (number: number) => {
    const texels = (number + 0.5) / page.position_steps;
    return Math.floor(texels) + 0.5 - texels;
  };
  const plane = bias.receiver_plane ? 2 * (byU * toCentre(u) + byV * toCentre(v)) : 0;
  return 0 - bias.slope * (Math.abs(byU) + Math.abs(byV)) - plane;
}

export function expectedGaps(
  light: LightJson,
  { normals: [nx, ny, nz] }: PixelSurfaces,
  { u: us, v: vs, face: faces, distance: distances }: Record<string, Numbers>,
  map: Numbers,
): Int32Array {
  const {
      view,
      depth_step: unit,
      map: { step },
    } = light,
    steps = page.position_steps,
    size = steps * view.size,
    side = Math.ceil(view.size / step);
  const gaps = new Int32Array(us!.length).fill(endless);
  for (let i = 0; i < gaps.length; ++i) {
    const u = us![i]!,
      v = vs![i]!,
      face = faces![i]!;
    if (u < 0 || v < 0 || u >= size || v >= size) continue;
    const depth = map[(face * side + Math.floor(v / steps / step)) * side + Math.floor(u / steps / step)]!;
    if (depth === nothingStored) continue;
    const f = view.faces[face]!;
    const x = view.perspective ? ((2 * u) / size - 1) * f.half_extent[0] : 0,
      y = view.perspective ? ((2 * v) / size - 1) * f.half_extent[1] : 0;
    const along = Math.sqrt(1 + x * x + y * y),
      distance = distances![i]!;
    const stored = (view.near / unit + depth) * along;
    const gap = distance - stored + tilt(light, f, [nx[i]!, ny[i]!, nz[i]!], u, v, x, y) * (view.perspective ? distance : 1 / unit);
    if (Math.abs(gap) < 1e9) gaps[i] = Math.floor(gap + 0.5);
  }
  return gaps;
}
