// The geometry of a light's depth map: the twin of scene/light_map/light_view.h and compare/ladder/biased_test.cpp in the numbers that
// the page needs. Map positions (u, v) in texels, v upwards; depth along the face's forward axis, distance along the ray.

export type Vec3 = readonly [number, number, number];

export interface Face {
  right: Vec3;
  up: Vec3;
  forward: Vec3;
  center: readonly [number, number]; // of an orthographic face, along right and up from the view's origin
  half_extent: readonly [number, number]; // along right and up
  warp: number; // of an orthographic face along up; 0: none
}

/** Where light-space perspective shows a height, and back (see scene/light_map/light_view.h). */
const warped = (f: Face, y: number): number => (y + f.warp * f.half_extent[1] ** 2) / (1 + f.warp * y);
const unwarped = (f: Face, shown: number): number => (shown - f.warp * f.half_extent[1] ** 2) / (1 - f.warp * shown);

/** Position along right and up from the view's origin, at depth 1 of a perspective map. */
export function place(view: LightView, face: number, u: number, v: number): [number, number] {
  const f = view.faces[face]!,
    y = unwarped(f, ((2 * v) / view.size - 1) * f.half_extent[1]);
  return [f.center[0] + ((2 * u) / view.size - 1) * f.half_extent[0] * (1 + f.warp * y), f.center[1] + y];
}

export interface LightView {
  perspective: boolean;
  size: number;
  faces: Face[];
  origin: Vec3;
  near: number;
  far: number;
}

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const add = (a: Vec3, b: Vec3, scale = 1): Vec3 => [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => add(a, b, -1);
export const scaled = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a: Vec3): number => Math.sqrt(dot(a, a));
export const unit = (a: Vec3): Vec3 => scaled(a, 1 / length(a));

export interface Ray {
  origin: Vec3;
  direction: Vec3;
}

export function texelRay(view: LightView, face: number, u: number, v: number): Ray {
  const f = view.faces[face]!,
    [x, y] = place(view, face, u, v),
    offset = add(scaled(f.right, x), f.up, y);
  if (!view.perspective) return { origin: add(view.origin, offset), direction: f.forward };
  return { origin: view.origin, direction: unit(add(f.forward, offset)) };
}

export interface MapPoint {
  u: number;
  v: number;
  depth: number;
}

export function project(view: LightView, face: number, point: Vec3): MapPoint {
  const f = view.faces[face]!,
    d = sub(point, view.origin),
    depth = dot(d, f.forward),
    up = dot(d, f.up) - f.center[1];
  const [x, y] = view.perspective
    ? [dot(d, f.right) / depth, up / depth]
    : [(dot(d, f.right) - f.center[0]) / (1 + f.warp * up), warped(f, up)];
  return { u: 0.5 * (x / f.half_extent[0] + 1) * view.size, v: 0.5 * (y / f.half_extent[1] + 1) * view.size, depth };
}

/** World width of a texel along u (axis 0) or v (axis 1) where a point falls. */
export function texelWidth(view: LightView, axis: 0 | 1, at: MapPoint & { face: number }): number {
  const f = view.faces[at.face]!;
  if (f.warp === 0) return (2 * f.half_extent[axis] * (view.perspective ? at.depth : 1)) / view.size;
  const [near, far] =
    axis === 0
      ? [place(view, at.face, at.u - 0.5, at.v), place(view, at.face, at.u + 0.5, at.v)]
      : [place(view, at.face, at.u, at.v - 0.5), place(view, at.face, at.u, at.v + 0.5)];
  return Math.hypot(far[0] - near[0], far[1] - near[1]);
}

/** How much longer the way along the ray through (u, v) is than its depth. */
export function alongRay(view: LightView, face: number, u: number, v: number): number {
  return view.perspective ? 1 / dot(texelRay(view, face, u, v).direction, view.faces[face]!.forward) : 1;
}

/** Depth at which the ray through (u, v) meets a plane from the front; infinity where it does not. */
export function planeDepth(view: LightView, face: number, u: number, v: number, point: Vec3, normal: Vec3): number {
  const ray = texelRay(view, face, u, v),
    facing = dot(normal, ray.direction);
  if (!(facing < 0)) return Infinity;
  const t = dot(normal, sub(point, ray.origin)) / facing;
  if (!view.perspective) return t;
  return t > 0 ? t * dot(ray.direction, view.faces[face]!.forward) : Infinity;
}

/** Half the difference of a plane's depths across the texel, along u and v (see texel_depth_slope). */
export function halfSlopes(view: LightView, face: number, at: MapPoint, point: Vec3, normal: Vec3): [number, number] {
  const slope = (du: number, dv: number) => {
    const below = planeDepth(view, face, at.u - du, at.v - dv, point, normal);
    const above = planeDepth(view, face, at.u + du, at.v + dv, point, normal);
    return isFinite(below) && isFinite(above) ? 0.5 * Math.abs(above - below) : Infinity;
  };
  return [slope(0.5, 0), slope(0, 0.5)];
}
