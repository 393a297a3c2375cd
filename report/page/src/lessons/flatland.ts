// A flatland: segments and circles in a plane, which light crosses as it does in space. Rays, a sun's shadow map, and what
// came out for every piece of a surface. World units throughout; y is up.

export type Vec2 = readonly [number, number];

export interface Segment {
  from: Vec2;
  to: Vec2;
  normal: Vec2; // unit, outwards
  smooth?: readonly [Vec2, Vec2]; // unit normals at its ends, of what it stands for
}
export interface Circle {
  center: Vec2;
  radius: number;
}
export interface World2 {
  segments: Segment[];
  circles: Circle[];
}

export const add = (a: Vec2, b: Vec2, t = 1): Vec2 => [a[0] + t * b[0], a[1] + t * b[1]];
export const sub = (a: Vec2, b: Vec2): Vec2 => [a[0] - b[0], a[1] - b[1]];
export const dot = (a: Vec2, b: Vec2): number => a[0] * b[0] + a[1] * b[1];
export const cross = (a: Vec2, b: Vec2): number => a[0] * b[1] - a[1] * b[0];
export const length = (a: Vec2): number => Math.hypot(a[0], a[1]);
/** To the right where `a` has no length: both ends of a ray may be dragged to one place. */
export const unit = (a: Vec2): Vec2 => (length(a) > 0 ? [a[0] / length(a), a[1] / length(a)] : [1, 0]);

/** Where a ray meets a segment; infinity where it does not. */
export function meetSegment(origin: Vec2, direction: Vec2, { from, to }: Segment): number {
  const along = sub(to, from),
    across = cross(direction, along);
  if (across === 0) return Infinity;
  const away = sub(from, origin),
    s = cross(away, direction) / across;
  return s >= 0 && s <= 1 ? cross(away, along) / across : Infinity;
}

/** Where a ray of unit direction enters and leaves a circle; null where it passes. */
export function meetCircle(origin: Vec2, direction: Vec2, { center, radius }: Circle): Vec2 | null {
  const away = sub(center, origin),
    middle = dot(away, direction),
    past = cross(direction, away);
  const half = radius * radius - past * past;
  return half < 0 ? null : [middle - Math.sqrt(half), middle + Math.sqrt(half)];
}

/** A piece of a surface: which one, where, and how it is turned. */
export interface Place {
  surface: Segment | Circle;
  at: Vec2;
  normal: Vec2;
}

/** Whether anything but the place's own surface stands between it and a point, or before an endless way. A circle shadows
    itself where it is turned away, which is not asked here. */
export function occluded(world: World2, { surface, at }: Place, direction: Vec2, reach = Infinity): boolean {
  const first = 1e-9;
  for (const segment of world.segments) {
    if (segment === surface) continue;
    const t = meetSegment(at, direction, segment);
    if (t > first && t < reach) return true;
  }
  for (const circle of world.circles) {
    if (circle === surface) continue;
    const span = meetCircle(at, direction, circle);
    if (span && span[1] > first && span[0] < reach) return true;
  }
  return false;
}

/** The depth of the first surface ahead of a ray of unit direction: endless where there is none. */
export function firstDepth(world: World2, origin: Vec2, direction: Vec2): number {
  const meetings = [
    ...world.segments.map((segment) => meetSegment(origin, direction, segment)),
    ...world.circles.flatMap((circle) => meetCircle(origin, direction, circle) ?? []),
  ];
  return Math.min(...meetings.filter((t) => t > 0));
}

/** A sun's shadow map: `count` texels side by side, square to the light. Depth counts along the light from a line through
    the origin of the world. */
export class SunMap {
  readonly across: Vec2; // unit, the way in which the texels follow each other
  readonly from: number;
  readonly texel: number; // width
  readonly depths: number[];

  /** Over the part of the plane that the corners span. */
  constructor(
    world: World2,
    readonly light: Vec2,
    readonly count: number,
    corners: Vec2[],
  ) {
    this.across = [-light[1], light[0]];
    const places = corners.map((corner) => dot(corner, this.across));
    this.from = Math.min(...places);
    this.texel = (Math.max(...places) - this.from) / count;
    this.depths = Array.from({ length: count }, (_, k) => firstDepth(world, this.rayThrough(k + 0.5), light) - far);
  }

  /** Where the ray through a position on the map, in texels, begins. */
  rayThrough(position: number): Vec2 {
    const u = this.from + position * this.texel;
    return [u * this.across[0] - far * this.light[0], u * this.across[1] - far * this.light[1]];
  }
  /** The point of a position on the map at a depth. */
  point(position: number, depth: number): Vec2 {
    return add(this.rayThrough(position), this.light, far + depth);
  }
  position(at: Vec2): number {
    return (dot(at, this.across) - this.from) / this.texel;
  }
  depth(at: Vec2): number {
    return dot(at, this.light);
  }
  /** How much farther the place lies than what its texel holds: with nothing held, or outside, it is lit by any bias. The place is moved by
      the offset first, texels along its normal times the sine of its angle to the light. */
  gap(place: Place, offset: number): number {
    const sine = Math.abs(cross(place.normal, this.light));
    const at = add(place.at, place.normal, offset * this.texel * sine),
      k = Math.floor(this.position(at));
    return k < 0 || k >= this.count ? -Infinity : this.depth(at) - this.depths[k]!;
  }
}
const far = 1e3;

export type Outcome = "lit" | "dark" | "false" | "missed" | "away";

/** What a map makes of a place, beside the truth; "away": turned from the light, dark whatever is before it. */
export function outcomeAt(world: World2, place: Place, map: SunMap, bias: number, offset: number): Outcome {
  const toLight: Vec2 = [-map.light[0], -map.light[1]];
  if (dot(place.normal, toLight) <= 0) return "away";
  const truth = !occluded(world, place, toLight),
    drawn = !(map.gap(place, offset) > bias + 1e-9); // more than rounding
  return truth ? (drawn ? "lit" : "false") : drawn ? "missed" : "dark";
}

/** The middles of `count` equal pieces of each surface; a circle has as many as fit its length beside a segment's. */
export function* piecesOf(surface: Segment | Circle, count: number): Generator<Place> {
  for (let i = 0; i < count; ++i) {
    const t = (i + 0.5) / count;
    if ("radius" in surface) {
      const normal: Vec2 = [Math.cos(2 * Math.PI * t), Math.sin(2 * Math.PI * t)];
      yield { surface, normal, at: add(surface.center, normal, surface.radius) };
    } else yield { surface, normal: surface.normal, at: add(surface.from, sub(surface.to, surface.from), t) };
  }
}

export const lengthOf = (surface: Segment | Circle): number =>
  "radius" in surface ? 2 * Math.PI * surface.radius : length(sub(surface.to, surface.from));

/** A circle as a polygon of as many sides, with the circle's own normals at its corners. */
export function polygon({ center, radius }: Circle, sides: number): Segment[] {
  const corner = (i: number): Vec2 => [Math.cos((2 * Math.PI * i) / sides), Math.sin((2 * Math.PI * i) / sides)];
  return Array.from({ length: sides }, (_, i) => {
    const a = corner(i),
      b = corner(i + 1);
    return { from: add(center, a, radius), to: add(center, b, radius), normal: unit(add(a, b)), smooth: [a, b] as const };
  });
}
