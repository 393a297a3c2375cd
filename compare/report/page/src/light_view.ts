// The geometry of a light's depth map: the twin of scene/light_view.h and compare/biased_test.cpp in the numbers that
// the page needs. Map positions (u, v) in texels, v upwards; depth along the face's forward axis, distance along the ray.

export type Vec3 = readonly [number, number, number];

export interface Face {
  right: Vec3;
  up: Vec3;
  forward: Vec3;
}

export interface LightView {
  perspective: boolean;
  size: number;
  faces: Face[];
  origin: Vec3;
  half_extent: readonly [number, number];
  near: number;
  far: number;
}

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const add = (a: Vec3, b: Vec3, scale = 1): Vec3 => [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => add(a, b, -1);
export const scaled = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const cross = (a: Vec3, b: Vec3): Vec3 =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a: Vec3): number => Math.sqrt(dot(a, a));
export const unit = (a: Vec3): Vec3 => scaled(a, 1 / length(a));

export interface Ray {
  origin: Vec3;
  direction: Vec3;
}

export function texelRay(view: LightView, face: number, u: number, v: number): Ray {
  const f = view.faces[face]!;
  const offset = add(
    scaled(f.right, ((2 * u) / view.size - 1) * view.half_extent[0]), f.up, ((2 * v) / view.size - 1) * view.half_extent[1]);
  if (!view.perspective) return { origin: add(view.origin, offset), direction: f.forward };
  return { origin: view.origin, direction: unit(add(f.forward, offset)) };
}

export interface MapPoint {
  u: number;
  v: number;
  depth: number;
}

export function project(view: LightView, face: number, point: Vec3): MapPoint {
  const f = view.faces[face]!, d = sub(point, view.origin), depth = dot(d, f.forward), w = view.perspective ? depth : 1;
  return {
    u: 0.5 * (dot(d, f.right) / (w * view.half_extent[0]) + 1) * view.size,
    v: 0.5 * (dot(d, f.up) / (w * view.half_extent[1]) + 1) * view.size,
    depth,
  };
}

/** World width of a texel along u (axis 0) or v (axis 1) at a depth. */
export const texelWidth = (view: LightView, axis: 0 | 1, depth: number): number =>
  (2 * view.half_extent[axis] * (view.perspective ? depth : 1)) / view.size;

/** How much longer the way along the ray through (u, v) is than its depth. */
export function alongRay(view: LightView, face: number, u: number, v: number): number {
  return view.perspective ? 1 / dot(texelRay(view, face, u, v).direction, view.faces[face]!.forward) : 1;
}

/** Depth at which the ray through (u, v) meets a plane from the front; infinity where it does not. */
export function planeDepth(view: LightView, face: number, u: number, v: number, point: Vec3, normal: Vec3): number {
  const ray = texelRay(view, face, u, v), facing = dot(normal, ray.direction);
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
