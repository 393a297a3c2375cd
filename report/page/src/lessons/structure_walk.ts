// Rays through the program's own structures, in the plane that lab/lessons/figures.h cut them by: the walks of
// raytrace/accel/*.h, step by step, with what they count there.
import { meetSegment, type Vec2 } from "./flatland";

type Ranges = number[]; // first, last, first, last, …
export type Box = readonly [number, number, number, number]; // left, right, bottom, top

export interface LeafJson {
  items: Ranges;
  box?: Box;
}
export interface KdJson {
  axis: 0 | 1 | 2;
  split?: number;
  children: [NodeJson | null, NodeJson | null];
}
export interface OctreeJson {
  middle: Vec2;
  children: (NodeJson | null)[];
}
export interface BspJson {
  normal: Vec2;
  offset: number;
  children: [NodeJson | null, NodeJson | null];
}
export interface BvhJson {
  box: Box;
  children: [NodeJson, NodeJson];
}
export type NodeJson = LeafJson | KdJson | OctreeJson | BspJson | BvhJson | { missed: true };
export interface GridJson {
  walls: [number[], number[]];
  cells: Ranges[][];
}

export interface StructureJson {
  kind: "grid" | "octree" | "kd" | "bsp" | "bvh";
  scene: string;
  plane: number;
  primitives: number;
  bounds: Box;
  slack?: number; // of a BSP tree's planes, world units
  segments: [number, number, number, number, number][];
  tree: NodeJson | GridJson;
  checks: { from: Vec2; to: Vec2; boxes: number; primitives: number; t: number | null }[];
}

/** A cell in which primitives were looked for: its outline, how many were tested, and the counts by then. */
export interface Visit {
  outline: Vec2[];
  tested: number;
  boxes: number;
  primitives: number;
}
export interface Walk {
  visits: Visit[];
  boxes: number; // nodes or cells
  primitives: number;
  t: number; // of the hit; infinity
}

export const outlineOf = ([left, right, bottom, top]: Box): Vec2[] => [
  [left, bottom],
  [right, bottom],
  [right, top],
  [left, top],
];

/** The part of a polygon on one side of a line: below (normal · p <= offset) or above. */
export function clipped(polygon: Vec2[], normal: Vec2, offset: number, below: boolean): Vec2[] {
  const height = (p: Vec2) => (normal[0] * p[0] + normal[1] * p[1] - offset) * (below ? 1 : -1),
    out: Vec2[] = [];
  polygon.forEach((b, i) => {
    const a = polygon.at(i - 1)!,
      ha = height(a),
      hb = height(b);
    if (ha <= 0 !== hb <= 0) out.push([a[0] + ((b[0] - a[0]) * ha) / (ha - hb), a[1] + ((b[1] - a[1]) * ha) / (ha - hb)]);
    if (hb <= 0) out.push(b);
  });
  return out;
}

class Walker {
  readonly walk: Walk = { visits: [], boxes: 0, primitives: 0, t: Infinity };
  private readonly recent = new Int32Array(64).fill(-1); // the ray's mailbox, as in raytrace/accel/crossing.h

  constructor(
    private readonly segments: Map<number, readonly [Vec2, Vec2]>,
    readonly origin: Vec2,
    readonly direction: Vec2,
  ) {}

  visit(outline: Vec2[], ranges: Ranges, mailbox = true): void {
    const { walk } = this,
      before = walk.primitives;
    for (let i = 0; i < ranges.length; i += 2)
      for (let item = ranges[i]!; item <= ranges[i + 1]!; ++item) {
        if (mailbox && this.recent[item % 64] === item) continue;
        this.recent[item % 64] = item;
        ++walk.primitives;
        const segment = this.segments.get(item);
        if (!segment) continue;
        const t = meetSegment(this.origin, this.direction, { from: segment[0], to: segment[1], normal: [0, 0] });
        if (t > 0) walk.t = Math.min(walk.t, t);
      }
    walk.visits.push({ outline, tested: walk.primitives - before, boxes: walk.boxes, primitives: walk.primitives });
  }

  /** When the ray is at a wall across an axis: before it the ray is on its near side. */
  wall(axis: 0 | 1, at: number): number {
    const t = (at - this.origin[axis]) / this.direction[axis];
    return Number.isNaN(t) ? -Infinity : t;
  }
  /** How far rounding may move the crossing of a line: the program's boxes and directions are floats, and who lies in a wall
      is looked for on both sides of it. */
  doubt(normal: Vec2, slack: number, t: number, reach: number): number {
    const epsilon = 2 ** -23,
      of = (axis: 0 | 1) => Math.abs(normal[axis]) * epsilon * (Math.abs(this.origin[axis]) + 2 * reach * Math.abs(this.direction[axis]));
    const slope = Math.abs(normal[0] * this.direction[0] + normal[1] * this.direction[1]);
    return (slack + of(0) + of(1)) / slope + 4 * epsilon * Math.abs(t);
  }
  backwards(axis: 0 | 1): boolean {
    return this.direction[axis] < 0 || Object.is(this.direction[axis], -0);
  }
  clip([left, right, bottom, top]: Box): [number, number] {
    const x = [this.wall(0, left), this.wall(0, right)].sort((a, b) => a - b),
      y = [this.wall(1, bottom), this.wall(1, top)].sort((a, b) => a - b);
    return [Math.max(0, x[0]!, y[0]!), Math.min(this.walk.t, x[1]!, y[1]!)];
  }
}

interface Entry<Node> {
  node: Node;
  begin: number;
  end: number;
  outline: Vec2[];
}

const axisNormal = (axis: number): Vec2 => (axis === 0 ? [1, 0] : [0, 1]);

/** Two children on the sides of a line: of a kd-tree and of a BSP tree. */
function walkHalves(walker: Walker, json: StructureJson): void {
  const [begin, end] = walker.clip(json.bounds),
    stack: Entry<NodeJson>[] = [];
  if (!(begin <= end)) return;
  let at: Entry<NodeJson> | undefined = { node: json.tree as NodeJson, begin, end, outline: outlineOf(json.bounds) };
  while (at) {
    const { node } = at as Entry<NodeJson>;
    if ("items" in node) {
      walker.visit(at.outline, node.items);
      do at = stack.pop();
      while (at && at.begin > walker.walk.t);
      continue;
    }
    ++walker.walk.boxes;
    const { children } = node as KdJson | BspJson,
      only = children.findIndex((child) => child === null);
    if (only >= 0) {
      at = { ...at, node: children[1 - only]! } as Entry<NodeJson>;
      continue;
    }
    const [normal, offset] = "axis" in node ? [axisNormal(node.axis), node.split!] : [(node as BspJson).normal, (node as BspJson).offset];
    const slope = normal[0] * walker.direction[0] + normal[1] * walker.direction[1],
      height = normal[0] * walker.origin[0] + normal[1] * walker.origin[1] - offset;
    const near = slope < 0 ? 1 : 0,
      t: number = slope === 0 ? (height <= 0 ? Infinity : -Infinity) : -height / slope,
      doubt = isFinite(t) ? walker.doubt(normal, json.slack ?? 0, t, Math.max(Math.abs(begin), Math.abs(end))) : 0;
    const child = (side: 0 | 1, from: number, to: number): Entry<NodeJson> => ({
      node: children[side]!,
      begin: from,
      end: to,
      outline: clipped((at as Entry<NodeJson>).outline, normal, offset, side === 0),
    });
    const far = child((1 - near) as 0 | 1, Math.max(at.begin, t - doubt), at.end);
    if (at.begin > t + doubt) at = far;
    else {
      if (t - doubt <= at.end) stack.push(far);
      at = child(near as 0 | 1, at.begin, Math.min(at.end, t + doubt));
    }
  }
}

function walkOctree(walker: Walker, json: StructureJson): void {
  const [begin, end] = walker.clip(json.bounds),
    stack: (Entry<NodeJson> & { box: Box })[] = [{ node: json.tree as NodeJson, begin, end, outline: [], box: json.bounds }];
  if (!(begin <= end)) return;
  while (stack.length > 0) {
    const at = stack.pop()!,
      { node } = at;
    if (at.begin > walker.walk.t) continue;
    if ("items" in node) {
      walker.visit(outlineOf(at.box), node.items);
      continue;
    }
    walker.walk.boxes += 8;
    const { middle, children } = node as OctreeJson,
      base = stack.length,
      way = [walker.backwards(0), walker.backwards(1)];
    for (let far = 0; far < 4; ++far) {
      let from = at.begin,
        to = at.end;
      for (const axis of [0, 1] as const) {
        const t = walker.wall(axis, middle[axis]);
        if ((far >> axis) & 1) from = Math.max(from, t);
        else to = Math.min(to, t);
      }
      const high = [0, 1].map((axis) => (((far >> axis) & 1) === 1) !== way[axis]),
        child = children[(high[0] ? 1 : 0) + (high[1] ? 2 : 0)];
      if (!(from <= to) || !child) continue;
      const [left, right, bottom, top] = at.box,
        box: Box = [high[0] ? middle[0] : left, high[0] ? right : middle[0], high[1] ? middle[1] : bottom, high[1] ? top : middle[1]];
      let place = stack.length;
      while (place > base && stack[place - 1]!.begin < from) --place;
      stack.splice(place, 0, { node: child, begin: from, end: to, outline: [], box });
    }
  }
}

function walkBvh(walker: Walker, json: StructureJson): void {
  const stack: { node: LeafJson | BvhJson; begin: number }[] = [];
  const push = (node: NodeJson) => {
    ++walker.walk.boxes;
    if ("missed" in node) return;
    const [begin, end] = walker.clip((node as BvhJson).box);
    if (begin <= end) stack.push({ node: node as BvhJson, begin });
  };
  push(json.tree as NodeJson);
  while (stack.length > 0) {
    const { node, begin } = stack.pop()!;
    if (begin > walker.walk.t) continue;
    if ("items" in node) {
      walker.visit(outlineOf(node.box!), node.items, false);
      continue;
    }
    const base = stack.length;
    push(node.children[1]);
    push(node.children[0]);
    if (stack.length === base + 2 && stack[base]!.begin < stack[base + 1]!.begin) stack.push(stack.splice(base, 1)[0]!);
  }
}

function walkGrid(walker: Walker, json: StructureJson): void {
  const { walls, cells } = json.tree as GridJson,
    [begin, end] = walker.clip(json.bounds);
  if (!(begin <= end)) return;
  const place = ([0, 1] as const).map((axis) => {
    const at = walker.origin[axis] + begin * walker.direction[axis],
      after = walls[axis].findIndex((wall) => wall > at);
    return Math.min(Math.max((after < 0 ? walls[axis].length : after) - 1, 0), walls[axis].length - 2);
  });
  for (;;) {
    const [x, y] = place as [number, number];
    ++walker.walk.boxes;
    walker.visit(outlineOf([walls[0][x]!, walls[0][x + 1]!, walls[1][y]!, walls[1][y + 1]!]), cells[y]![x]!);
    const exits = ([0, 1] as const).map((axis) =>
      walker.direction[axis] === 0 ? Infinity : walker.wall(axis, walls[axis][place[axis]! + (walker.backwards(axis) ? 0 : 1)]!),
    );
    const axis = exits[0]! < exits[1]! ? 0 : 1;
    if (!(exits[axis]! <= Math.min(end, walker.walk.t))) return;
    place[axis]! += walker.backwards(axis) ? -1 : 1;
    if (place[axis]! < 0 || place[axis]! > walls[axis].length - 2) return;
  }
}

const walks = { grid: walkGrid, octree: walkOctree, kd: walkHalves, bsp: walkHalves, bvh: walkBvh };

/** The walk of a ray from a point on, in the direction of another. */
export function walkRay(json: StructureJson, segments: Map<number, readonly [Vec2, Vec2]>, from: Vec2, to: Vec2): Walk {
  const size = Math.hypot(to[0] - from[0], to[1] - from[1]),
    walker = new Walker(segments, from, [(to[0] - from[0]) / size, (to[1] - from[1]) / size]);
  walks[json.kind](walker, json);
  return walker.walk;
}

export const segmentsOf = (json: StructureJson): Map<number, readonly [Vec2, Vec2]> =>
  new Map(
    json.segments.map(([item, ax, ay, bx, by]) => [
      item,
      [
        [ax, ay],
        [bx, by],
      ] as const,
    ]),
  );

/** Outlines of all cells that hold something, or of all of a grid. */
export function cellsOf(json: StructureJson): Vec2[][] {
  const cells: Vec2[][] = [];
  if (json.kind === "grid") {
    const {
        walls: [xs, ys],
      } = json.tree as GridJson,
      [left, right, bottom, top] = json.bounds;
    return [
      ...xs.map((x): Vec2[] => [
        [x, bottom],
        [x, top],
      ]),
      ...ys.map((y): Vec2[] => [
        [left, y],
        [right, y],
      ]),
    ];
  }
  const add = (node: NodeJson | null | undefined, outline: Vec2[]): void => {
    if (!node || "missed" in node) return;
    if ("items" in node) {
      if (node.items.length > 0) cells.push(node.box ? outlineOf(node.box) : outline);
    } else if ("middle" in node) {
      const {
        middle: [x, y],
        children,
      } = node;
      children.forEach((child, i) => add(child, clipped(clipped(outline, [1, 0], x, (i & 1) === 0), [0, 1], y, (i & 2) === 0)));
    } else if ("box" in node) node.children.forEach((child) => add(child, []));
    else {
      const [normal, offset] = "axis" in node ? [axisNormal(node.axis), node.split] : [node.normal, node.offset];
      const parts = node.children.includes(null)
        ? [outline, outline]
        : [clipped(outline, normal, offset!, true), clipped(outline, normal, offset!, false)];
      node.children.forEach((child, i) => add(child, parts[i]!));
    }
  };
  add(json.tree as NodeJson, outlineOf(json.bounds));
  return cells;
}
