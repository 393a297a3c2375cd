// Structures over a handful of discs in a plane, small enough to be built split by split. Told is where each split goes and why, how a line
// walks through the finished one, and what is on the stack at every step. Perimeters stand for the surface areas of space.
import { add, dot, length, meetCircle, sub, unit, type Circle, type Vec2 } from "./flatland";
import { clipped, outlineOf, type Box } from "./structure_walk";

export type Kind = "grid" | "octree" | "kd" | "bsp" | "bvh";
export type Rule = "middle" | "area";

export interface SmallNode {
  name: string; // "1", "1a", "1ab": the way from the root
  outline: Vec2[]; // convex, counter-clockwise
  items: number[];
  cut: Vec2[][]; // where it is split, lines
  tried: number; // ways to split it whose costs were compared
  children: SmallNode[];
}
interface Part {
  outline: Vec2[];
  items: number[];
}
interface Split {
  cut: Vec2[][];
  parts: Part[];
}

const leafSize = 2,
  deepest = 6,
  stepCost = 1,
  testCost = 1;
export const perimeter = (outline: Vec2[]): number => outline.reduce((sum, p, i) => sum + length(sub(p, outline.at(i - 1)!)), 0);
const boxOf = ({ center: [x, y], radius: r }: Circle): Box => [x - r, x + r, y - r, y + r];
export const boxAround = (boxes: Box[]): Box => [
  Math.min(...boxes.map((b) => b[0])),
  Math.max(...boxes.map((b) => b[1])),
  Math.min(...boxes.map((b) => b[2])),
  Math.max(...boxes.map((b) => b[3])),
];
export const boxOfOutline = (outline: Vec2[]): Box => boxAround(outline.map(([x, y]): Box => [x, x, y, y]));
/** The area that two boxes share. */
export const overlap = (a: Box, b: Box): number =>
  Math.max(0, Math.min(a[1], b[1]) - Math.max(a[0], b[0])) * Math.max(0, Math.min(a[3], b[3]) - Math.max(a[2], b[2]));
const touches = (a: Box, b: Box): boolean => a[0] <= b[1] && b[0] <= a[1] && a[2] <= b[3] && b[2] <= a[3];
const part = ([left, right, bottom, top]: Box, axis: 0 | 1, at: number, high: boolean): Box =>
  axis === 0 ? (high ? [at, right, bottom, top] : [left, at, bottom, top]) : high ? [left, right, at, top] : [left, right, bottom, at];
const across = ([left, right, bottom, top]: Box, axis: 0 | 1, at: number): Vec2[] =>
  axis === 0
    ? [
        [at, bottom],
        [at, top],
      ]
    : [
        [left, at],
        [right, at],
      ];

/** Expected cost of a node with two parts, by surface area (Goldsmith and Salmon 1987; MacDonald and Booth 1990). */
const areaCost = (outline: Vec2[], parts: Part[]): number =>
  stepCost + (testCost * parts.reduce((sum, p) => sum + perimeter(p.outline) * p.items.length, 0)) / Math.max(perimeter(outline), 1e-9);

export class SmallTree {
  readonly root: SmallNode;
  readonly splits: SmallNode[] = []; // in the order in which they were made
  private readonly boxes: Box[];

  constructor(
    readonly kind: Kind,
    readonly rule: Rule,
    readonly discs: Circle[],
  ) {
    this.boxes = discs.map(boxOf);
    const everything = { outline: outlineOf(boxAround(this.boxes)), items: discs.map((_, i) => i) };
    this.root = { name: "1", ...everything, cut: [], tried: 0, children: [] };
    // Breadth first, so that the splits appear from large to small.
    for (const waiting = [this.root]; waiting.length > 0;) {
      const node = waiting.shift()!;
      if (node.items.length <= leafSize || node.name.length > deepest) continue;
      this.split(node);
      if (node.children.length > 0) this.splits.push(node);
      waiting.push(...node.children);
    }
  }

  private cell(items: number[], box: Box): Part {
    return { outline: outlineOf(box), items: items.filter((i) => touches(this.boxes[i]!, box)) };
  }
  private group(items: number[]): Part {
    return { outline: outlineOf(boxAround(items.map((i) => this.boxes[i]!))), items };
  }

  private split(node: SmallNode): void {
    const made = this.choices(node),
      split = this.rule === "area" ? this.cheapest(node, made) : made[0]!;
    if (!split) return;
    if (this.rule === "area") node.tried = made.length;
    node.cut = split.cut;
    node.children = split.parts.map((p, i) => ({ name: node.name + "abcd"[i]!, ...p, cut: [], tried: 0, children: [] }));
  }
  /** None where a leaf is cheaper. */
  private cheapest({ outline, items }: SmallNode, made: Split[]): Split | null {
    const costs = made.map(({ parts }) => areaCost(outline, parts)),
      least = Math.min(...costs);
    return least < testCost * items.length ? made[costs.indexOf(least)]! : null;
  }
  private choices(node: SmallNode): Split[] {
    if (this.kind === "bsp") return this.lines(node);
    const { items } = node,
      box = boxOfOutline(node.outline),
      axes = [0, 1] as const,
      longer = box[1] - box[0] >= box[3] - box[2] ? 0 : 1;
    if (this.kind === "octree") return [this.quarters(box, items)];
    if (this.rule === "middle")
      return [
        this.kind === "bvh"
          ? this.groups(items, longer, items.length >> 1)
          : this.halves(box, items, longer, (box[2 * longer]! + box[2 * longer + 1]!) / 2),
      ];
    return axes.flatMap((axis) =>
      this.kind === "bvh"
        ? items.slice(1).map((_, i) => this.groups(items, axis, i + 1))
        : this.borders(box, items, axis).map((at) => this.halves(box, items, axis, at)),
    );
  }
  /** Where boxes begin and end: between two such places the cost is a straight line. */
  private borders(box: Box, items: number[], axis: 0 | 1): number[] {
    return items
      .flatMap((i) => [this.boxes[i]![2 * axis]!, this.boxes[i]![2 * axis + 1]!])
      .filter((at) => at > box[2 * axis]! && at < box[2 * axis + 1]!);
  }

  private quarters(box: Box, items: number[]): Split {
    const x = (box[0] + box[1]) / 2,
      y = (box[2] + box[3]) / 2,
      cells = [false, true].flatMap((up) => [false, true].map((right) => part(part(box, 0, x, right), 1, y, up)));
    return { cut: [across(box, 0, x), across(box, 1, y)], parts: cells.map((cell) => this.cell(items, cell)) };
  }
  private halves(box: Box, items: number[], axis: 0 | 1, at: number): Split {
    return { cut: [across(box, axis, at)], parts: [false, true].map((high) => this.cell(items, part(box, axis, at, high))) };
  }
  private groups(items: number[], axis: 0 | 1, count: number): Split {
    const sorted = [...items].sort((a, b) => this.discs[a]!.center[axis] - this.discs[b]!.center[axis] || a - b);
    return { cut: [], parts: [this.group(sorted.slice(0, count)), this.group(sorted.slice(count))] };
  }
  /** Lines of any direction: for each two discs the one midway between them, square to the line through their middles. */
  private lines({ outline, items }: SmallNode): Split[] {
    return items.flatMap((i, k) =>
      items.slice(k + 1).map((j): Split => {
        const a = this.discs[i]!,
          b = this.discs[j]!,
          normal = unit(sub(b.center, a.center)),
          gap = dot(normal, sub(b.center, a.center)) - a.radius - b.radius;
        const offset = dot(normal, a.center) + a.radius + gap / 2,
          foot: Vec2 = [normal[0] * offset, normal[1] * offset],
          along: Vec2 = [-normal[1], normal[0]];
        const side = (below: boolean): Part => ({
          outline: clipped(outline, normal, offset, below),
          items: items.filter((item) => {
            const { center, radius } = this.discs[item]!,
              height = dot(normal, center) - offset;
            return below ? height < radius : height > -radius;
          }),
        });
        return { cut: [lineInside(foot, along, outline).map((t) => add(foot, along, t))], parts: [side(true), side(false)] };
      }),
    );
  }

  nodes(): SmallNode[] {
    const all: SmallNode[] = [],
      add = (node: SmallNode): void => {
        all.push(node);
        node.children.forEach(add);
      };
    add(this.root);
    return all;
  }
}

/** When a line is in a convex outline: [entry, exit], empty where it passes it. */
export function lineInside(origin: Vec2, direction: Vec2, outline: Vec2[]): [number, number] {
  let [entry, exit] = [-Infinity, Infinity];
  outline.forEach((to, i) => {
    const from = outline.at(i - 1)!,
      out: Vec2 = [to[1] - from[1], from[0] - to[0]],
      height = dot(out, sub(origin, from)),
      slope = dot(out, direction);
    if (slope < 0) entry = Math.max(entry, -height / slope);
    else if (slope > 0) exit = Math.min(exit, -height / slope);
    else if (height > 0) exit = -Infinity;
  });
  return [entry, exit];
}

export interface WalkStep {
  node: SmallNode;
  stack: string[]; // what is still to be looked at, the next one last
  tested: number[]; // discs
  boxes: number; // met by now
  discs: number; // tested by now
  t: number; // nearest hit by now; infinity
}

/** A ray through a tree, nearer parts first; parts that begin behind the hit are left out. */
export function walkTree(tree: SmallTree, origin: Vec2, direction: Vec2): WalkStep[] {
  const steps: WalkStep[] = [],
    stack: { node: SmallNode; entry: number }[] = [];
  let [t, boxes, discs] = [Infinity, 0, 0];
  const meet = (node: SmallNode) => {
    ++boxes;
    const [entry, exit] = lineInside(origin, direction, node.outline);
    return entry <= exit && exit >= 0 ? { node, entry: Math.max(entry, 0) } : null;
  };
  const first = meet(tree.root);
  if (first) stack.push(first);
  while (stack.length > 0) {
    const { node, entry } = stack.pop()!;
    if (entry > t) continue;
    const tested = node.children.length > 0 ? [] : node.items;
    for (const i of tested) {
      ++discs;
      const span = meetCircle(origin, direction, tree.discs[i]!),
        hit = span?.find((at) => at > 0);
      if (hit !== undefined) t = Math.min(t, hit);
    }
    stack.push(...node.children.flatMap((child) => meet(child) ?? []).sort((a, b) => b.entry - a.entry));
    steps.push({ node, stack: stack.map((at) => at.node.name), tested, boxes, discs, t });
  }
  return steps;
}

/** The nodes that a line through the root is expected to meet: the sum of their perimeters over the root's (Santaló 1976: of convex boxes it is exact). */
export const expectedNodes = (tree: SmallTree): number =>
  tree.nodes().reduce((sum, { outline }) => sum + perimeter(outline), 0) / perimeter(tree.root.outline);

/** The same counted. */
export const countedNodes = (tree: SmallTree, turns: number): number =>
  meetingLines(
    tree.root.outline,
    tree.nodes().map(({ outline }) => outline),
    turns,
  );

/** How many of the outlines a line through `whole` meets, on average of lines in `turns` directions, evenly beside each other. */
export function meetingLines(whole: Vec2[], outlines: Vec2[][], turns: number): number {
  const [left, right, bottom, top] = boxOfOutline(whole),
    middle: Vec2 = [(left + right) / 2, (bottom + top) / 2],
    reach = Math.hypot(right - left, top - bottom) / 2,
    beside = 60;
  let [lines, met] = [0, 0];
  for (let k = 0; k < turns; ++k) {
    const angle = (Math.PI * (k + 0.5)) / turns,
      d: Vec2 = [Math.cos(angle), Math.sin(angle)];
    for (let j = 0; j < beside; ++j) {
      const off = reach * ((2 * (j + 0.5)) / beside - 1),
        o: Vec2 = [middle[0] - off * d[1], middle[1] + off * d[0]],
        meets = (outline: Vec2[]) => {
          const [entry, exit] = lineInside(o, d, outline);
          return entry <= exit;
        };
      if (!meets(whole)) continue;
      ++lines;
      met += outlines.filter(meets).length;
    }
  }
  return met / lines;
}
