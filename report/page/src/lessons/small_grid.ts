// A grid over a handful of discs, and the walk from cell to cell (Amanatides and Woo 1987). Along each axis the t of the next wall
// is known, the smaller one is crossed, and one addition gives that axis's next.
import { meetCircle, type Circle, type Vec2 } from "./flatland";
import { boxAround, lineInside, type WalkStep } from "./small_tree";
import { outlineOf, type Box } from "./structure_walk";

/** Cells along each axis: `k` for each disc and axis, as in k · N^(1/2) in a plane, so that they are about square; for k = 0 one cell. */
export function gridSize([left, right, bottom, top]: Box, count: number, k: number): [number, number] {
  const side = Math.sqrt(((right - left) * (top - bottom)) / count) / k;
  return [Math.max(1, Math.round((right - left) / side)), Math.max(1, Math.round((top - bottom) / side))];
}

const boxOf = ({ center: [x, y], radius: r }: Circle): Box => [x - r, x + r, y - r, y + r];

interface SmallGrid {
  box: Box;
  columns: number;
  rows: number;
  wide: number; // of a cell
  high: number;
}
function gridOver(discs: Circle[], k: number): SmallGrid {
  const box = boxAround(discs.map(boxOf)),
    [columns, rows] = gridSize(box, discs.length, k);
  return { box, columns, rows, wide: (box[1] - box[0]) / columns, high: (box[3] - box[2]) / rows };
}
const cellOf = ({ box: [left, , bottom], wide, high }: SmallGrid, x: number, y: number): Box => [
  left + x * wide,
  left + (x + 1) * wide,
  bottom + y * high,
  bottom + (y + 1) * high,
];
/** Whether the disc's box touches the cell. */
const touches = (disc: Circle, [left, right, bottom, top]: Box): boolean => {
  const [from, to, low, high] = boxOf(disc);
  return to >= left && from <= right && high >= bottom && low <= top;
};

/** The cells of a grid with lists: those that each disc is entered into, as outlines, and how many there are in all. */
export function fillCells(discs: Circle[], k: number): { all: number; lists: { name: string; outline: Vec2[] }[][] } {
  const grid = gridOver(discs, k),
    cells = Array.from({ length: grid.columns * grid.rows }, (_, i) => [i % grid.columns, Math.floor(i / grid.columns)] as const);
  const lists = discs.map((disc) =>
    cells
      .filter(([x, y]) => touches(disc, cellOf(grid, x, y)))
      .map(([x, y]) => ({ name: `(${x}, ${y})`, outline: outlineOf(cellOf(grid, x, y)) })),
  );
  return { all: cells.length, lists };
}

export function walkCells(discs: Circle[], k: number, origin: Vec2, direction: Vec2): WalkStep[] & { lines: Vec2[][] } {
  const grid = gridOver(discs, k),
    { box, columns, rows, wide, high } = grid,
    [left, , bottom] = box;
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
        cell = cellOf(grid, x, y),
        here = discs.flatMap((disc, i) => (touches(disc, cell) && !tested.has(i) ? [i] : []));
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
