// The cross-section: the plane of light rays through the pixel's row of texels, cut through the real scene. Across, the
// map's texels; downwards, depth: light rays run straight down, whatever the light. Steps: what the map stores; below
// them, and the bias, the map takes everything for shadow. Dots: the pixels that look this row up, by what came out.
import { page, type Geometry, type Light, type Pixel } from "./data";
import { alongRay, texelWidth } from "./light_view";
import { sceneCut, type Curve } from "./scene_cut";
import { html, niceTicks, number, svg } from "./svg";

const width = 1160, height = 420, left = 62, right = 12, top = 34, bottom = 46;

export type Outcome = "lit" | "dark" | "false" | "missed";
const outcomes: Record<Outcome, string> = {
  lit: "lit, rightly", dark: "in shadow, rightly", false: "false shadow", missed: "missed shadow",
};

export interface Dot {
  u: number;
  depth: number;
  outcome: Outcome;
  index: number;
}

/** The compared pixels that look up this row of the map between two columns. */
export function dotsOfRow(light: Light, face: number, row: number, from: number, to: number, bias: number): Dot[] {
  const dots: Dot[] = [];
  for (let i = 0; i < light.label.length; ++i) {
    if (light.label[i]! < 0 || Math.floor(light.v(i)) !== row || light.face(i) !== face) continue;
    const u = light.u(i);
    if (u < from || u >= to) continue;
    const lit = light.lit(i), drawn = light.litAt(i, bias);
    dots.push({ u, depth: light.depth(i), index: i, outcome: lit ? (drawn ? "lit" : "false") : drawn ? "missed" : "dark" });
  }
  return dots;
}

interface Frame {
  from: number;  // texels
  to: number;
  low: number;   // depth
  high: number;
  x: (u: number) => number;
  y: (depth: number) => number;
}

function frameFor(light: Light, pixel: Pixel, from: number, to: number, row: number, dots: Dot[]): Frame {
  let low = pixel.at.depth, high = low;
  const widen = (depth: number) => { low = Math.min(low, depth); high = Math.max(high, depth); };
  for (const dot of dots) widen(dot.depth);
  for (let k = from; k < to; ++k) {
    const depth = light.map.depth(pixel.face, k, row);
    if (isFinite(depth)) widen(depth);
  }
  const margin = Math.max(0.08 * (high - low), texelWidth(light.json.view, 0, pixel.at.depth));
  low -= margin;
  high += margin;
  return {
    from, to, low, high,
    x: (u) => left + ((u - from) / (to - from)) * (width - left - right),
    y: (depth) => top + ((depth - low) / (high - low)) * (height - top - bottom),
  };
}

function texelBars(frame: Frame): SVGElement {
  const group = svg("g"), w = frame.x(1) - frame.x(0);
  const every = w >= 3 ? 1 : 2 ** Math.ceil(Math.log2(3 / w));
  for (let k = Math.ceil(frame.from / every) * every; k < frame.to; k += every)
    group.append(svg("rect", { class: (k / every) % 2 ? "texel-bar odd" : "texel-bar", x: frame.x(k), y: top - 12, width: every * w, height: 8 }));
  return group;
}

// Stored depths as steps, and the map's shadow below them.
function storedSteps(light: Light, pixel: Pixel, frame: Frame, row: number, bias: number): SVGElement {
  let line = "", shade = "", before = NaN;
  const ratio = alongRay(light.json.view, pixel.face, pixel.at.u, pixel.at.v), floor = height - bottom;
  for (let k = frame.from; k < frame.to; ++k) {
    const depth = light.map.depth(pixel.face, k, row), x = frame.x(k), next = frame.x(k + 1);
    if (isFinite(depth)) {
      const y = frame.y(depth), tested = Math.min(frame.y(depth + bias / ratio), floor);
      line += `${isFinite(before) ? "L" : "M"}${x.toFixed(1)},${y.toFixed(1)}H${next.toFixed(1)}`;
      shade += `M${x.toFixed(1)},${tested.toFixed(1)}H${next.toFixed(1)}V${floor}H${x.toFixed(1)}Z`;
    }
    before = depth;
  }
  return svg("g", {}, svg("path", { class: "believed", d: shade }), svg("path", { class: "stored", d: line }));
}

const curvePath = (curve: Curve, frame: Frame): string =>
  curve.map((p, i) => `${i === 0 ? "M" : "L"}${frame.x(p.u).toFixed(1)},${frame.y(p.depth).toFixed(1)}`).join("");

function dotShape(dot: Dot, frame: Frame): string {
  const x = frame.x(dot.u), y = frame.y(dot.depth), at = `M${x.toFixed(1)},${y.toFixed(1)}`;
  if (dot.outcome === "false") return `${at}m-3.5,3h7l-3.5,-6.5z`;
  if (dot.outcome === "missed") return `${at}m-3,-3h6v6h-6z`;
  return `${at}m-2,0a2,2 0 1 0 4,0a2,2 0 1 0 -4,0`;
}

function axes(frame: Frame, row: number): SVGElement {
  const group = svg("g");
  for (const depth of niceTicks(frame.low, frame.high, 5))
    group.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: frame.y(depth), y2: frame.y(depth) }),
      svg("text", { class: "end", x: left - 6, y: frame.y(depth) + 4 }, number(depth)));
  for (const u of niceTicks(frame.from, frame.to, 8))
    if (Number.isInteger(u)) group.append(svg("text", { class: "middle", x: frame.x(u), y: height - bottom + 17 }, number(u)));
  group.append(svg("text", { class: "middle", x: (left + width - right) / 2, y: height - 8 }, `texels of map row ${row}`),
    svg("text", { class: "end", x: left - 6, y: top - 12 }, "depth"),
    svg("text", { x: left, y: 14 }, "↓ light"));
  return group;
}

function legend(dots: Dot[]): HTMLElement {
  const list = html("p", { class: "key" });
  for (const [outcome, name] of Object.entries(outcomes) as [Outcome, string][]) {
    const count = dots.filter((dot) => dot.outcome === outcome).length;
    const mark = svg("svg", { viewBox: "-5 -5 10 10", "aria-hidden": "true", class: "mark" },
      svg("path", { class: `dot ${outcome}`, d: dotShape({ u: 0, depth: 0, outcome, index: 0 }, { x: () => 0, y: () => 0 } as unknown as Frame) }));
    list.append(html("span", {}, mark, ` ${name}: ${count}`));
  }
  return list;
}

export function sectionDrawing(light: Light, pixel: Pixel, scene: Geometry, halfWidth: number, bias: number, id: string): HTMLElement {
  const size = light.json.view.size, centre = Math.floor(pixel.at.u), row = Math.floor(pixel.at.v);
  const from = Math.max(0, centre - halfWidth), to = Math.min(size, centre + halfWidth + 1);
  const dots = dotsOfRow(light, pixel.face, row, from, to, bias), frame = frameFor(light, pixel, from, to, row, dots);
  const curves = sceneCut(light.json.view, pixel.face, pixel.at.v, scene, from, to);
  const clip = `${id}-clip`, x = frame.x(pixel.at.u), y = frame.y(pixel.at.depth);
  const stretch = ((height - top - bottom) / (frame.high - frame.low)) /
    ((width - left - right) / ((to - from) * texelWidth(light.json.view, 0, pixel.at.depth)));
  const drawing = svg("svg", { class: "section", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-labelledby": `${id}-title` },
    svg("title", { id: `${id}-title` }, `Cross-section along row ${row} of the map through pixel ${pixel.x}, ${pixel.y}`),
    svg("defs", {}, svg("clipPath", { id: clip }, svg("rect", { x: left, y: top, width: width - left - right, height: height - top - bottom }))),
    axes(frame, row), texelBars(frame),
    svg("g", { "clip-path": `url(#${clip})` },
      storedSteps(light, pixel, frame, row, bias),
      svg("path", { class: "profile", d: curves.map((curve) => curvePath(curve, frame)).join("") }),
      ...(Object.keys(outcomes) as Outcome[]).map((outcome) =>
        svg("path", { class: `dot ${outcome}`, d: dots.filter((d) => d.outcome === outcome).map((d) => dotShape(d, frame)).join("") }))),
    svg("line", { class: "own-ray", x1: x, x2: x, y1: top, y2: y }), svg("circle", { class: "ring", cx: x, cy: y, r: 8 }));
  return html("figure", {}, html("div", { class: "scroll", role: "region", tabindex: "0", "aria-label": `Cross-section, ${light.json.name}` }, drawing as unknown as Node), legend(dots),
    html("figcaption", {}, `Thin: the scene itself, cut exactly along the light rays through the pixel${scene.complete ? "" : " (its triangles are too many for this page; shapes and pixels only)"}. ` +
      `Thick steps: the depths stored in row ${row}${light.map.step > 1 ? `, the nearest of ${light.map.step} × ${light.map.step} texels` : ""}. Shaded: shadow by the map, from the bias on. ` +
      `Depth is drawn ${number(stretch, 2)} times as large as width. Marks: ${dots.length} of ${page.width * page.height} pixels.`));
}
