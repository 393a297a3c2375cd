// Watch a ray visit the cells of a structure: the program's own one of a whole scene, in the plane that cuts it.
import { grouped } from "../number_text";
import { html, number } from "../svg";
import { pageData } from "../parts";
import { add, length, sub, unit, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { frame } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { cellsOf, segmentsOf, walkRay, type StructureJson, type Walk } from "./structure_walk";
import { many, say } from "./say";

const names = {
  grid: say("uniform grid"),
  octree: say("octree"),
  kd: say("kd-tree"),
  bsp: say("BSP tree"),
  bvh: say("bounding-volume hierarchy"),
};
/** What its walk counts, one and several. */
const asked: Record<StructureJson["kind"], [string, string]> = {
  grid: ["cell", "cells"],
  octree: ["box", "boxes"],
  kd: ["plane", "planes"],
  bsp: ["plane", "planes"],
  bvh: ["box", "boxes"],
};

declare global {
  var gnomonWalks: ((at: number) => { wanted: StructureJson["checks"][number]; walk: Walk }[]) | undefined; // eslint-disable-line no-var
}

/** The rays that the program itself counted, walked here: for the browser's console, and for tests. */
globalThis.gnomonWalks = (at) => {
  const json = pageData<{ figures: { data: StructureJson }[] }>().figures[at]!.data,
    segments = segmentsOf(json);
  return json.checks.map((wanted) => ({ wanted, walk: walkRay(json, segments, wanted.from, wanted.to) }));
};

export function structureFigure({ settings, data }: FigureJson, id: string): HTMLElement {
  const json = data as StructureJson,
    segments = segmentsOf(json),
    cells = cellsOf(json),
    lines = [...segments.values()];
  const [left, right, bottom, top] = json.bounds,
    width = right - left,
    ratio = Math.min(Math.max(0.45, (1.1 * (top - bottom)) / (1.04 * width)), 0.9),
    middle: Vec2 = [(left + right) / 2, bottom + 0.4 * (top - bottom)];
  // What is densest is looked at when the drawing is enlarged.
  const dense = densest(lines);
  const view = (zoom: number): [number, number, number, number] => {
    const w = (1.04 * width) / zoom,
      h = w * ratio,
      share = 1 - 1 / zoom;
    const x = middle[0] + share * (dense[0] - middle[0]),
      y = (top + bottom) / 2 + share * (dense[1] - (top + bottom) / 2);
    return [x - w / 2, x + w / 2, y - h / 2, y + h / 2];
  };
  const said = html("p", { class: "bias-counts", role: "status" }),
    first = view(Math.min(Number(settings.zoom ?? 1), zoomMost(lines, width)));
  const end = (key: string, name: string, value: number): Record<string, never> =>
    ({ [key]: { name, from: 0, to: 1, step: 0.001, value, text: (v: number) => number(v, 3), drags: true } }) as Record<string, never>;
  const sliders: Sliders<string> = new Sliders<string>(
    {
      step: { name: say("Cells visited"), from: 0, to: 1, step: 0.001, value: 1, text: (v) => `${Math.round(100 * v)} %` },
      zoom: {
        name: say("Enlarged"),
        from: 0,
        to: Math.log2(zoomMost(lines, width)),
        step: 0.05,
        value: Math.log2(Math.min(Number(settings.zoom ?? 1), zoomMost(lines, width))),
        text: (v) => `${number(2 ** v, 2)}×`,
      },
      ...end("fromX", say("Ray's start, left and right"), 0.06),
      ...end("fromY", say("Ray's start, up and down"), 0.86),
      ...end("toX", say("Ray's aim, left and right"), (dense[0] - first[0]) / (first[1] - first[0])),
      ...end("toY", say("Ray's aim, up and down"), (dense[1] - first[2]) / (first[3] - first[2])),
    },
    () => show(),
  );
  let shown = first,
    ends: [Vec2, Vec2] = [
      [0, 0],
      [0, 0],
    ];
  const share = (at: number, low: number, high: number) => (at - low) / (high - low);
  const dragged = (at: Vec2, handle: string) => {
    sliders.set(`${handle}X`, share(at[0], shown[0], shown[1]));
    sliders.set(`${handle}Y`, share(at[1], shown[2], shown[3]));
  };
  const stage = new Stage(shown, say`The ${names[json.kind]} of the scene ${json.scene}, and the cells that a ray visits`, dragged, () => ({
    to: ends[1],
    from: ends[0],
  }));
  const show = () => {
    stage.look((shown = view(2 ** sliders.value("zoom"))));
    const point = (key: string): Vec2 => [
      shown[0] + sliders.value(`${key}X`) * (shown[1] - shown[0]),
      shown[2] + sliders.value(`${key}Y`) * (shown[3] - shown[2]),
    ];
    ends = [point("from"), point("to")];
    const [from, to] = ends,
      way = unit(sub(to, from)),
      walk = walkRay(json, segments, from, length(sub(to, from)) > 0 ? to : add(from, way));
    const seen = Math.round(sliders.value("step") * walk.visits.length),
      visits = walk.visits.slice(0, seen),
      last = visits.at(-1),
      all = seen === walk.visits.length;
    const reach = Math.min(isFinite(walk.t) && all ? walk.t : Infinity, 10 * width),
      stop = add(from, way, reach);
    const closed = (outline: Vec2[]) => [...outline, ...outline.slice(0, 1)];
    stage.put(
      stage.path(
        "cells",
        cells.map((cell) => (json.kind === "grid" ? cell : closed(cell))),
      ),
      ...visits.map((visit) =>
        stage.path(`visited${visit.tested > 0 ? " tests" : ""}${visit === last ? " last" : ""}`, [closed(visit.outline)]),
      ),
      stage.path("profile thin", lines),
      stage.path("ray", [[from, stop]]),
      stage.circle("point", from, 11),
      stage.circle("moved", to, 9),
      ...(isFinite(walk.t) && all ? [stage.circle("hit", stop, 8)] : []),
    );
    const boxes = all ? walk.boxes : (last?.boxes ?? 0),
      primitives = all ? walk.primitives : (last?.primitives ?? 0);
    Object.assign(said.dataset, { boxes: String(boxes), primitives: String(primitives), cells: String(seen) });
    said.textContent =
      say`${seen} of ${many(
        walk.visits.length,
        "cell",
        "cells",
      )}: ${many(boxes, ...asked[json.kind])} and ${many(primitives, "triangle", "triangles")} tested. ` +
      say`Without a structure it would be all ${grouped(json.primitives)} triangles.${
        all ? (isFinite(walk.t) ? say(" The ray hits.") : say(" The ray hits nothing.")) : ""
      }`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say`Drag either end of the ray. The plane z = ${json.plane} cuts the scene and its ${names[json.kind]}; the counts are the program's own for this ray. Filled: cells that were visited, darker where triangles were tested in them.`,
  );
}

/** The middle of the shortest tenth of the segments. */
function densest(lines: (readonly [Vec2, Vec2])[]): Vec2 {
  const short = shortest(lines),
    mean = (k: 0 | 1) => short.reduce((sum, [a]) => sum + a[k], 0) / short.length;
  return [mean(0), mean(1)];
}
function shortest(lines: (readonly [Vec2, Vec2])[]): (readonly [Vec2, Vec2])[] {
  const size = ([a, b]: readonly [Vec2, Vec2]) => Math.hypot(b[0] - a[0], b[1] - a[1]);
  return [...lines].sort((a, b) => size(a) - size(b)).slice(0, Math.max(1, Math.ceil(lines.length / 10)));
}
/** So that they fill a third of the drawing. */
function zoomMost(lines: (readonly [Vec2, Vec2])[], width: number): number {
  const xs = shortest(lines).map(([a]) => a[0]);
  return Math.max(2, width / (3 * Math.max(Math.max(...xs) - Math.min(...xs), 1e-9)));
}
