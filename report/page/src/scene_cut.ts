// The scene cut by the plane of light rays through one row or column of the map. It is exact for spheres and planes, and for triangles
// up to the rounding of the corners that the page carries (2^-20 of the scene's size).
import type { Geometry } from "./data";
import {
  add,
  cross,
  dot,
  length,
  place,
  project,
  scaled,
  sub,
  texelRay,
  unit,
  type LightView,
  type MapPoint,
  type Vec3,
} from "./light_view";

/** A curve in the plane, as map positions with depths; behind a perspective light there is none. */
export type Curve = MapPoint[];

interface Cut {
  normal: Vec3;
  offset: number; // dot(normal, p - origin) = offset on the plane
}

/** A line across the map: along u (axis 0) at a fixed v, or along v (axis 1) at a fixed u. */
export interface Line {
  axis: 0 | 1;
  at: number; // the fixed coordinate, texels
}

function cutAt(view: LightView, face: number, line: Line): Cut {
  const f = view.faces[face]!,
    middle = view.size / 2;
  const [x, y] = line.axis === 0 ? place(view, face, middle, line.at) : place(view, face, line.at, middle);
  if (view.perspective) return { normal: unit(line.axis === 0 ? add(f.up, f.forward, -y) : add(f.right, f.forward, -x)), offset: 0 };
  if (line.axis === 0) return { normal: f.up, offset: y };
  // On a warped face x = c (1 + s y) with both from its centre: still a plane of parallel rays.
  const c = (x - f.center[0]) / (1 + f.warp * (y - f.center[1])),
    normal = add(f.right, f.up, -c * f.warp),
    size = length(normal);
  return { normal: scaled(normal, 1 / size), offset: (f.center[0] + c * (1 - f.warp * f.center[1])) / size };
}

const ahead = (view: LightView, point: MapPoint): boolean => !view.perspective || point.depth > 1e-3 * view.near;

function circle(view: LightView, face: number, axis: 0 | 1, cut: Cut, center: Vec3, radius: number): Curve[] {
  const away = dot(cut.normal, sub(center, view.origin)) - cut.offset;
  if (Math.abs(away) >= radius) return [];
  const middle = add(center, cut.normal, -away),
    r = Math.sqrt(radius * radius - away * away);
  const f = view.faces[face]!,
    a = !view.perspective ? f.forward : axis === 0 ? f.right : f.up,
    b = cross(cut.normal, a),
    bu = scaled(b, 1 / length(b)),
    curve: Curve = [];
  for (let i = 0; i <= 180; ++i) {
    const t = (i * Math.PI) / 90,
      p = project(view, face, add(add(middle, a, r * Math.cos(t)), bu, r * Math.sin(t)));
    if (ahead(view, p)) curve.push(p);
  }
  return [curve];
}

function planeCurve(view: LightView, face: number, line: Line, point: Vec3, normal: Vec3, from: number, to: number): Curve[] {
  const curve: Curve = [];
  for (let i = 0; i <= 64; ++i) {
    const t0 = from + ((to - from) * i) / 64,
      [u, v] = line.axis === 0 ? [t0, line.at] : [line.at, t0];
    const ray = texelRay(view, face, u, v),
      facing = dot(normal, ray.direction);
    if (facing === 0) continue;
    const t = dot(normal, sub(point, ray.origin)) / facing;
    const p = project(view, face, add(ray.origin, ray.direction, t));
    if (ahead(view, p)) curve.push({ ...p, u, v });
  }
  return [curve];
}

function triangleCurves(view: LightView, face: number, cut: Cut, scene: Geometry): Curve[] {
  const { positions, corners } = scene,
    heights = new Float64Array(positions.length / 3),
    curves: Curve[] = [];
  const [nx, ny, nz] = cut.normal,
    [ox, oy, oz] = view.origin,
    offset = cut.offset;
  for (let i = 0; i < heights.length; ++i)
    heights[i] = nx * (positions[3 * i]! - ox) + ny * (positions[3 * i + 1]! - oy) + nz * (positions[3 * i + 2]! - oz) - offset;
  const at = (i: number): Vec3 => [positions[3 * i]!, positions[3 * i + 1]!, positions[3 * i + 2]!];
  for (let t = 0; t < corners.length; t += 3) {
    const below = heights[corners[t]!]! < 0;
    if (heights[corners[t + 1]!]! < 0 === below && heights[corners[t + 2]!]! < 0 === below) continue; // nearly all
    const ends: Vec3[] = [];
    for (let k = 0; k < 3; ++k) {
      const i = corners[t + k]!,
        j = corners[t + ((k + 1) % 3)]!,
        a = heights[i]!,
        b = heights[j]!;
      if (a < 0 !== b < 0) ends.push(add(at(i), sub(at(j), at(i)), a / (a - b)));
    }
    if (ends.length === 2) curves.push(segment(view, face, ends[0]!, ends[1]!));
  }
  return curves;
}

// A straight line in the world is curved in a perspective map: eight pieces.
function segment(view: LightView, face: number, a: Vec3, b: Vec3): Curve {
  const pieces = view.perspective ? 8 : 1,
    curve: Curve = [];
  for (let i = 0; i <= pieces; ++i) {
    const p = project(view, face, add(a, sub(b, a), i / pieces));
    if (ahead(view, p)) curve.push(p);
  }
  return curve;
}

/** Every curve of the scene in the plane of a line across the map; planes between the positions `from` and `to` on it. */
export function sceneCut(view: LightView, face: number, line: Line, scene: Geometry, from: number, to: number): Curve[] {
  const cut = cutAt(view, face, line),
    curves = triangleCurves(view, face, cut, scene);
  for (const shape of scene.shapes)
    curves.push(
      ...("radius" in shape
        ? circle(view, face, line.axis, cut, shape.center, shape.radius)
        : planeCurve(view, face, line, shape.point, shape.normal, from, to)),
    );
  return curves;
}
