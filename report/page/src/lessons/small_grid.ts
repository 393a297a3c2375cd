// A grid over a handful of discs, and the walk from cell to cell (Amanatides and Woo 1987). Along each axis the t of the next wall
// is known, the smaller one is crossed, and one addition gives that axis's next.
import { meetCircle, type Circle, type Vec2 } from "./flatland";
import { boxAround, lineInside, type WalkStep } from "./small_tree";
import { outlineOf, type Box } from "./structure_walk";

/** Cells along each axis: `k` for each disc and axis, as in k · N^(1/2) in a plane, so that they are about square. */
export function gridSize([left, right, bottom, top]: Box, count: number, k: number): [number, number] {
  const side = Math.sqrt(((right - left) * (top - bottom)) / count) / k;
  return [Math.max(1, Math.round((right - left) / side)), Math.max(1, Math.round((top - bottom) / side))];
}

export function walkCells(discs: Circle[], k: number, origin: Vec2, direction: Vec2): WalkStep[] & { lines: Vec2[][] } {
  const box = boxAround(discs.map(({ center: [x, y], radius: r }): Box => [x - r, x + r, y - r, y + r])),
    [left, , bottom] = box,
    [columns, rows] = gridSize(box, discs.length, k),
    wide = (box[1] - left) / columns,
    high = (box[3] - bottom) / rows;
  const lines = [
    ...Array.from({ length: columns + 1 }, (_, i): Vec2[] => [
      [left + i * wide, bottom],
      [left + i * wide, box[3]],
    ]),
    ...Array.from({ length: rows + 1 }, (_, i): Vec2[] => [
      [left, bottom + i * high],
      [box[1], bottom + i * high],
    ]),
  ];
  const steps: WalkStep[] = [],
    [entry, exit] = lineInside(origin, direction, outlineOf(box)),
    begin = Math.max(entry, 0);
  const tested = new Set<number>(); // the mailbox: each disc is tested once
  let t = Infinity;
  if (begin <= exit) {
    const size: Vec2 = [wide, high],
      corner: Vec2 = [left, bottom],
      counts = [columns, rows] as const;
    const at = ([0, 1] as const).map((axis) =>
      Math.min(Math.max(Math.floor((origin[axis] + begin * direction[axis] - corner[axis]) / size[axis]), 0), counts[axis] - 1),
    );
    const next = ([0, 1] as const).map((axis) =>
      direction[axis] === 0
        ? Infinity
        : (corner[axis] + (at[axis]! + (direction[axis] > 0 ? 1 : 0)) * size[axis] - origin[axis]) / direction[axis],
    );
    const more = ([0, 1] as const).map((axis) => Math.abs(size[axis] / direction[axis]));
    for (;;) {
      const [x, y] = at as [number, number],
        cell: Box = [left + x * wide, left + (x + 1) * wide, bottom + y * high, bottom + (y + 1) * high];
      const here = discs.flatMap(({ center, radius }, i) =>
        center[0] + radius >= cell[0] &&
        center[0] - radius <= cell[1] &&
        center[1] + radius >= cell[2] &&
        center[1] - radius <= cell[3] &&
        !tested.has(i)
          ? [i]
          : [],
      );
      for (const i of here) {
        tested.add(i);
        const hit = meetCircle(origin, direction, discs[i]!)?.find((d) => d > 0);
        if (hit !== undefined) t = Math.min(t, hit);
      }
      steps.push({
        node: { name: `(${x}, ${y})`, outline: outlineOf(cell), items: here, cut: [], tried: 0, children: [] },
        stack: [],
        tested: here,
        boxes: steps.length + 1,
        discs: tested.size,
        t,
      });
      const axis = next[0]! < next[1]! ? 0 : 1;
      if (next[axis]! > Math.min(exit, t)) break;
      at[axis]! += direction[axis] > 0 ? 1 : -1;
      if (at[axis]! < 0 || at[axis]! >= counts[axis]) break;
      next[axis]! += more[axis]!;
    }
  }
  return Object.assign(steps, { lines });
}
