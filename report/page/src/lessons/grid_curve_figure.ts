// How many cells: what grids of 1 to 125 cells for each primitive cost the same rays, counted by the program.
import { html, number, svg } from "../svg";
import type { FigureJson } from "./figures";
import { say } from "./say";

interface CurveJson {
  scene: string;
  primitives: number;
  points: { density: number; cells: number; triangles: number }[]; // means of a ray
}

const width = 960,
  height = 430,
  left = 70,
  right = 30,
  top = 60,
  bottom = 70;

export function gridCurveFigure({ data }: FigureJson, id: string): HTMLElement {
  const { points, scene } = data as CurveJson,
    first = points[0]!,
    last = points.at(-1)!,
    eight = points.find(({ density }) => density === 8)!;
  const formula = (density: number) => eight.cells * Math.cbrt(density / 8),
    high = Math.max(...points.flatMap((p) => [p.cells, p.triangles]), formula(last.density)) * 1.05;
  const x = (density: number) =>
      left + (Math.log(density / first.density) / Math.log(last.density / first.density)) * (width - left - right),
    y = (value: number) => height - bottom - (value / high) * (height - top - bottom);
  const range = html("input", {
    type: "range",
    min: "0",
    max: String(points.length - 1),
    step: "1",
    value: String(points.findIndex(({ density }) => density === 27)),
  });
  const said = html("p", { class: "bias-counts", role: "status" });
  const drawing = svg("svg", {
    class: "flatland",
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": say`Cells and triangles of a ray in the scene ${scene}, for 1 to 125 cells a primitive`,
  }) as SVGSVGElement;
  const line = (kind: string, of: (p: CurveJson["points"][number]) => number) =>
    svg("path", {
      class: kind,
      "stroke-width": 4,
      d: points.map((p, i) => `${i === 0 ? "M" : "L"}${x(p.density).toFixed(1)},${y(of(p)).toFixed(1)}`).join(""),
    });
  const show = () => {
    const shown = points[Number(range.value)]!,
      text = (kind: string, at: number, up: number, words: string) => svg("text", { class: kind, x: at, y: up }, words);
    drawing.replaceChildren(
      svg("path", { class: "cells bold", d: `M${left},${top}V${height - bottom}H${width - right}` }),
      line("ghost", (p) => formula(p.density)),
      line("tree refracted", (p) => p.cells),
      line("tree eye", (p) => p.triangles),
      ...points.map(({ density }) => text("middle", x(density), height - bottom + 34, String(density))),
      text("end", width - right, y(last.cells) - 18, say("cells")),
      text("", x(first.density) + 16, y(first.triangles) - 22, say("triangles")),
      svg("circle", { class: "hit", cx: x(shown.density), cy: y(shown.triangles), r: 9 }),
      svg("circle", { class: "moved", cx: x(shown.density), cy: y(shown.cells), r: 9 }),
    );
    range.setAttribute("aria-valuetext", say`${shown.density} cells a primitive`);
    Object.assign(said.dataset, {
      density: String(shown.density),
      cells: String(shown.cells),
      triangles: String(shown.triangles),
      formula: String(formula(shown.density)),
    });
    said.textContent = say`${shown.density} cells a primitive: a ray passes ${number(shown.cells, 3)} cells and tests ${number(shown.triangles, 3)} triangles. From 8 cells on, the cube root foretells ${number(
      formula(shown.density),
      3,
    )} cells.`;
  };
  range.addEventListener("input", show);
  show();
  return html(
    "div",
    { id },
    drawing as unknown as HTMLElement,
    html("div", { class: "bias-bar" }, html("label", {}, say("Cells a primitive "), range)),
    said,
    html(
      "p",
      { class: "hint" },
      say`Counted for 64 x 36 eye rays of the scene ${scene} and their shadow rays. Blue: cells that a ray passes; orange: triangles that it tests; dotted: n = k·∛N, by the cube root from 8 on.`,
    ),
  );
}
