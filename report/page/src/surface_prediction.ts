// Where a pixel looks in the map, predicted from the last pixel that shows the same primitive: that one's plane, met by
// this pixel's ray. The twin of ../../surface_prediction.cpp: the same operations in the same order, each of which IEEE
// 754 fixes to the last bit.
import type { Face, LightView, Vec3 } from "./light_view";
import type { Numbers } from "./packed";

/** Rays to pixel centres: from `eye` along corner + (x + 1/2) across + (y + 1/2) down. */
export interface PixelRays {
  eye: Vec3;
  corner: Vec3;
  across: Vec3;
  down: Vec3;
}

export interface PixelSurfaces {
  width: number;
  rays: PixelRays;
  primitives: Numbers;
  normals: [Numbers, Numbers, Numbers];
  sources: Int32Array;
}

const dot3 = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const sum = (a: Vec3, b: Vec3, scale: number): Vec3 => [a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale];

// The middle of the step that the numbers of a pixel stand for.
function position(light: LightView, f: Face, steps: number, u: number, v: number, distance: number): Vec3 {
  const size = light.size * steps;
  const across = (((u + 0.5) * 2) / size - 1) * f.half_extent[0];
  const up = (((v + 0.5) * 2) / size - 1) * f.half_extent[1];
  if (light.perspective) {
    const depth = distance / Math.sqrt(1 + across * across + up * up);
    return sum(sum(sum(light.origin, f.right, across * depth), f.up, up * depth), f.forward, depth);
  }
  const y = (up - f.warp * f.half_extent[1] * f.half_extent[1]) / (1 - f.warp * up);
  const x = f.center[0] + across * (1 + f.warp * y);
  return sum(sum(sum(light.origin, f.right, x), f.up, f.center[1] + y), f.forward, distance);
}

// u and v as shares of the map from -1 to 1, and the distance.
function lookedUp(light: LightView, f: Face, point: Vec3): Vec3 {
  const d = sum(point, light.origin, -1);
  const right = dot3(d, f.right),
    up = dot3(d, f.up),
    depth = dot3(d, f.forward);
  if (light.perspective) return [right / depth / f.half_extent[0], up / depth / f.half_extent[1], Math.sqrt(dot3(d, d))];
  const y = up - f.center[1],
    stretch = 1 + f.warp * y;
  return [
    (right - f.center[0]) / stretch / f.half_extent[0],
    (y + f.warp * f.half_extent[1] * f.half_extent[1]) / stretch / f.half_extent[1],
    depth,
  ];
}

const most = 2 ** 30,
  noPrimitive = -1;

/** Adds what is predicted to what is left of u, v and distance, in place. */
export function addPredicted(
  s: PixelSurfaces,
  light: LightView,
  steps: number,
  depthStep: number,
  us: Numbers,
  vs: Numbers,
  distances: Numbers,
  faces: Numbers,
): void {
  const {
      width,
      rays,
      primitives,
      normals: [nx, ny, nz],
      sources,
    } = s,
    half = light.size * steps * 0.5;
  for (let i = 1; i < us.length; ++i) {
    const from = sources[i]!;
    let u = us[from]!,
      v = vs[from]!,
      distance = distances[from]!;
    if (primitives[i] === primitives[from] && primitives[i] !== noPrimitive) {
      const normal: Vec3 = [nx[from]!, ny[from]!, nz[from]!];
      const known = position(light, light.faces[faces[from]!]!, steps, u, v, distance * depthStep);
      const ray = sum(sum(rays.corner, rays.across, (i % width) + 0.5), rays.down, Math.floor(i / width) + 0.5);
      const t = dot3(normal, sum(known, rays.eye, -1)) / dot3(normal, ray);
      const met = lookedUp(light, light.faces[faces[i]!]!, sum(rays.eye, ray, t));
      const [a, b, c] = [(met[0] + 1) * half, (met[1] + 1) * half, met[2] / depthStep + 0.5];
      if (Math.abs(a) < most && Math.abs(b) < most && Math.abs(c) < most) [u, v, distance] = [Math.floor(a), Math.floor(b), Math.floor(c)];
    }
    us[i] = us[i]! + u;
    vs[i] = vs[i]! + v;
    distances[i] = distances[i]! + distance;
  }
}
