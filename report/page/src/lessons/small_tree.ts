// Structures over a handful of discs in a plane, small enough to be built split by split: where each split goes and why, how a line
// walks through the finished one, and what is on the stack at every step. Perimeters stand for the surface areas of space.
import { meetCircle, type Circle, type Vec2 } from "./flatland";
import type { Box } from "./structure_walk";

export type Kind = "grid" | "octree" | "kd" | "bvh";
export type Rule = "middle" | "area";

export interface SmallNode {
  name: string;  // "1", "1a", "1ab": the way from the root
  box: Box;
  items: number[];
  cut: Vec2[][];  // where it is split, lines
  children: SmallNode[];
}

const leafSize = 2, deepest = 6, stepCost = 1, testCost = 1;
export const perimeter = ([left, right, bottom, top]: Box): number => Math.max(0, right - left) + Math.max(0, top - bottom);
const boxOf = ({ center: [x, y], radius: r }: Circle): Box => [x - r, x + r, y - r, y + r];
export const boxAround = (boxes: Box[]): Box => [Math.min(...boxes.map((b) => b[0])), Math.max(...boxes.map((b) => b[1])), Math.min(...boxes.map((b) => b[2])), Math.max(...boxes.map((b) => b[3]))];
export const overlap = (a: Box, b: Box): number => Math.max(0, Math.min(a[1], b[1]) - Math.max(a[0], b[0])) * Math.max(0, Math.min(a[3], b[3]) - Math.max(a[2], b[2]));
const touches = (a: Box, b: Box): boolean => a[0] <= b[1] && b[0] <= a[1] && a[2] <= b[3] && b[2] <= a[3];
const part = ([left, right, bottom, top]: Box, axis: 0 | 1, at: number, high: boolean): Box => (axis === 0 ? (high ? [at, right, bottom, top] : [left, at, bottom, top]) : high ? [left, right, at, top] : [left, right, bottom, at]);
const across = ([left, right, bottom, top]: Box, axis: 0 | 1, at: number): Vec2[] => (axis === 0 ? [[at, bottom], [at, top]] : [[left, at], [right, at]]);

/** Expected cost of a node with two parts, by surface area (Goldsmith and Salmon 1987; MacDonald and Booth 1990). */
export const areaCost = (box: Box, low: Box, lowCount: number, high: Box, highCount: number): number =>
  stepCost + (testCost * (perimeter(low) * lowCount + perimeter(high) * highCount)) / Math.max(perimeter(box), 1e-9);

export class SmallTree {
  readonly root: SmallNode;
  readonly splits: SmallNode[] = [];  // in the order in which they were made
  private readonly boxes: Box[];

  constructor(readonly kind: Kind, readonly rule: Rule, readonly discs: Circle[]) {
    this.boxes = discs.map(boxOf);
    this.root = { name: "1", box: boxAround(this.boxes), items: discs.map((_, i) => i), cut: [], children: [] };
    // Breadth first, so that the splits appear from large to small.
    for (const waiting = [this.root]; waiting.length > 0;) {
      const node = waiting.shift()!;
      if (node.items.length <= leafSize || node.name.length > deepest) continue;
      this.split(node);
      if (node.children.length > 0) this.splits.push(node);
      waiting.push(...node.children);
    }
  }

  private inside(items: number[], box: Box): number[] { return items.filter((i) => touches(this.boxes[i]!, box)); }
  private around(items: number[]): Box { return boxAround(items.map((i) => this.boxes[i]!)); }

  private split(node: SmallNode): void {
    const parts = this.kind === "octree" ? this.quarters(node) : this.kind === "kd" ? this.halves(node) : this.kind === "bvh" ? this.groups(node) : null;
    if (!parts) return;
    node.cut = parts.cut;
    node.children = parts.parts.map(([box, items], i) => ({ name: node.name + "abcd"[i]!, box, items, cut: [], children: [] }));
  }

  private quarters({ box, items }: SmallNode): { cut: Vec2[][]; parts: [Box, number[]][] } {
    const x = (box[0] + box[1]) / 2, y = (box[2] + box[3]) / 2, cells = [false, true].flatMap((up) => [false, true].map((right) => part(part(box, 0, x, right), 1, y, up)));
    return { cut: [across(box, 0, x), across(box, 1, y)], parts: cells.map((cell) => [cell, this.inside(items, cell)]) };
  }

  /** A plane across one axis: in the middle of the longer one, or where it costs least; none where a leaf is cheaper. */
  private halves({ box, items }: SmallNode): { cut: Vec2[][]; parts: [Box, number[]][] } | null {
    const longer = box[1] - box[0] >= box[3] - box[2] ? 0 : 1, made = (axis: 0 | 1, at: number) => {
      const low = part(box, axis, at, false), high = part(box, axis, at, true), below = this.inside(items, low), above = this.inside(items, high);
      return { axis, at, low, high, below, above, cost: areaCost(box, low, below.length, high, above.length) };
    };
    if (this.rule === "middle") return this.asHalves(box, made(longer, (box[2 * longer]! + box[2 * longer + 1]!) / 2));
    const places = ([0, 1] as const).flatMap((axis) => items.flatMap((i) => [this.boxes[i]![2 * axis]!, this.boxes[i]![2 * axis + 1]!]).filter((at) => at > box[2 * axis]! && at < box[2 * axis + 1]!).map((at) => made(axis, at)));
    const best = places.reduce<ReturnType<typeof made> | null>((a, b) => (a && a.cost <= b.cost ? a : b), null);
    return best && best.cost < testCost * items.length ? this.asHalves(box, best) : null;
  }
  private asHalves(box: Box, { axis, at, low, high, below, above }: { axis: 0 | 1; at: number; low: Box; high: Box; below: number[]; above: number[] }): { cut: Vec2[][]; parts: [Box, number[]][] } {
    return { cut: [across(box, axis, at)], parts: [[low, below], [high, above]] };
  }

  /** Two groups along an axis: as many in each along the longer one, or where it costs least. */
  private groups({ box, items }: SmallNode): { cut: Vec2[][]; parts: [Box, number[]][] } | null {
    const sorted = (axis: 0 | 1) => [...items].sort((a, b) => this.discs[a]!.center[axis] - this.discs[b]!.center[axis] || a - b);
    const made = (order: number[], count: number): { parts: [Box, number[]][]; cost: number } => {
      const [low, high] = [order.slice(0, count), order.slice(count)], parts: [Box, number[]][] = [[this.around(low), low], [this.around(high), high]];
      return { parts, cost: areaCost(box, parts[0]![0], low.length, parts[1]![0], high.length) };
    };
    const longer = box[1] - box[0] >= box[3] - box[2] ? 0 : 1, all = this.rule === "middle" ? [made(sorted(longer), items.length >> 1)] : ([0, 1] as const).flatMap((axis) => { const order = sorted(axis); return items.slice(1).map((_, i) => made(order, i + 1)); });
    const best = all.reduce((a, b) => (a.cost <= b.cost ? a : b));
    return this.rule === "area" && best.cost >= testCost * items.length ? null : { cut: [], parts: best.parts };
  }

  nodes(): SmallNode[] {
    const all: SmallNode[] = [], add = (node: SmallNode): void => { all.push(node); node.children.forEach(add); };
    add(this.root);
    return all;
  }
}

/** When a line is in a box: [entry, exit], empty where it passes it. */
export function lineInBox(origin: Vec2, direction: Vec2, box: Box): [number, number] {
  let [entry, exit] = [-Infinity, Infinity];
  for (const axis of [0, 1] as const) {
    const low = box[2 * axis]! - origin[axis], high = box[2 * axis + 1]! - origin[axis], d = direction[axis];
    if (d === 0) { if (low > 0 || high < 0) return [Infinity, -Infinity]; continue; }
    entry = Math.max(entry, Math.min(low / d, high / d));
    exit = Math.min(exit, Math.max(low / d, high / d));
  }
  return [entry, exit];
}

export interface WalkStep {
  node: SmallNode;
  stack: string[];  // what is still to be looked at, the next one last
  tested: number[];  // discs
  boxes: number;  // met by now
  discs: number;  // tested by now
  t: number;  // nearest hit by now; infinity
}

/** A ray through a tree, nearer parts first; parts that begin behind the hit are left out. */
export function walkTree(tree: SmallTree, origin: Vec2, direction: Vec2): WalkStep[] {
  const steps: WalkStep[] = [], stack: { node: SmallNode; entry: number }[] = [];
  let [t, boxes, discs] = [Infinity, 0, 0];
  const meet = (node: SmallNode) => { ++boxes; const [entry, exit] = lineInBox(origin, direction, node.box); return entry <= exit && exit >= 0 ? { node, entry: Math.max(entry, 0) } : null; };
  const first = meet(tree.root);
  if (first) stack.push(first);
  while (stack.length > 0) {
    const { node, entry } = stack.pop()!;
    if (entry > t) continue;
    const tested = node.children.length > 0 ? [] : node.items;
    for (const i of tested) {
      ++discs;
      const span = meetCircle(origin, direction, tree.discs[i]!), hit = span?.find((at) => at > 0);
      if (hit !== undefined) t = Math.min(t, hit);
    }
    stack.push(...node.children.flatMap((child) => meet(child) ?? []).sort((a, b) => b.entry - a.entry));
    steps.push({ node, stack: stack.map((at) => at.node.name), tested, boxes, discs, t });
  }
  return steps;
}

/** The nodes that a line through the root is expected to meet: the sum of their perimeters over the root's (Santaló 1976: of convex boxes it is exact). */
export const expectedNodes = (tree: SmallTree): number => tree.nodes().reduce((sum, { box }) => sum + perimeter(box), 0) / perimeter(tree.root.box);

/** The same counted: lines in `turns` directions, evenly beside each other. */
export function countedNodes(tree: SmallTree, turns: number): number {
  const nodes = tree.nodes(), [left, right, bottom, top] = tree.root.box, middle: Vec2 = [(left + right) / 2, (bottom + top) / 2], reach = Math.hypot(right - left, top - bottom) / 2, beside = 60;
  let [lines, met] = [0, 0];
  for (let k = 0; k < turns; ++k) {
    const angle = (Math.PI * (k + 0.5)) / turns, d: Vec2 = [Math.cos(angle), Math.sin(angle)];
    for (let j = 0; j < beside; ++j) {
      const off = reach * ((2 * (j + 0.5)) / beside - 1), o: Vec2 = [middle[0] - off * d[1], middle[1] + off * d[0]], meets = (box: Box) => { const [entry, exit] = lineInBox(o, d, box); return entry <= exit; };
      if (!meets(tree.root.box)) continue;
      ++lines;
      met += nodes.filter(({ box }) => meets(box)).length;
    }
  }
  return met / lines;
}
