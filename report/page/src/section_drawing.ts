// The cross-section: the plane of light rays through the pixel's row (or column) of texels, cut through the real scene. Across, the
// map's texels; downwards, depth: light rays run straight down, whatever the light. Steps: what the map stores; below
// them, and the bias, the map takes everything for shadow. Dots: the pixels that look these texels up, by what came out.
import type { Geometry, Light, Pixel } from "./data";
import { alongRay, halfSlopes, texelWidth } from "./light_view";
import { sceneCut, type Curve } from "./scene_cut";
import { counted, grouped } from "./number_text";
import { html, niceTicks, number, svg, tickTexts } from "./svg";
import { gapScale } from "./texel_drawing";
import { otherParts } from "./words";

const width = 1160,
  height = 420,
  left = 72,
  right = 12,
  top = 34,
  bottom = 46;

type Outcome = "lit" | "dark" | "false" | "missed";
const outcomes: Record<Outcome, string> = {
  lit: "lit, rightly",
  dark: "in shadow, rightly",
  false: "false shadow",
  missed: "missed shadow",
};

/** Along the map's row (axis 0) or column (axis 1): by name, or where the receiver is steeper. */
export function sectionAxis(light: Light, pixel: Pixel, wanted: string): 0 | 1 {
  if (wanted === "row" || wanted === "column") return wanted === "row" ? 0 : 1;
  const [u, v] = halfSlopes(light.json.view, pixel.face, pixel.at, pixel.position, pixel.normal);
  return v > u ? 1 : 0;
}

/** Stored depth at position k of the line through the pixel's texel. */
function depthAt(light: Light, pixel: Pixel, axis: 0 | 1, k: number): number {
  return axis === 0 ? light.map.depth(pixel.face, k, Math.floor(pixel.at.v)) : light.map.depth(pixel.face, Math.floor(pixel.at.u), k);
}

interface Dot {
  t: number; // along the line, texels
  depth: number;
  outcome: Outcome;
  index: number;
}

/** What of a cross-section does not depend on the bias: the last one is kept, so that dragging the bias is quick. */
interface Line {
  key: string;
  pixels: number[]; // compared, of this row or column between two positions
  curves: Curve[];
}
const kept = new WeakMap<Light, Line>();

function lineThrough(light: Light, pixel: Pixel, axis: 0 | 1, scene: Geometry, from: number, to: number): Line {
  const across = axis === 0 ? pixel.at.v : pixel.at.u,
    number = Math.floor(across);
  const key = [pixel.face, axis, across, from, to].join(),
    before = kept.get(light);
  if (before?.key === key) return before;
  const pixels = light.pixelsOfLine(pixel.face, axis, number, from, to);
  const line = { key, pixels, curves: sceneCut(light.json.view, pixel.face, { axis, at: across }, scene, from, to) };
  kept.set(light, line);
  return line;
}

function dotOf(light: Light, axis: 0 | 1, index: number, bias: number): Dot {
  const wrong = light.wrongAt(index, bias);
  return {
    t: axis === 0 ? light.u(index) : light.v(index),
    depth: light.depth(index),
    index,
    outcome: wrong < 0 ? "false" : wrong > 0 ? "missed" : light.lit(index) ? "lit" : "dark",
  };
}

interface Frame {
  axis: 0 | 1;
  from: number; // texels
  to: number;
  low: number; // depth
  high: number;
  x: (t: number) => number;
  y: (depth: number) => number;
}

function frameFor(light: Light, pixel: Pixel, axis: 0 | 1, from: number, to: number, dots: Dot[]): Frame {
  let low = pixel.at.depth,
    high = low;
  const widen = (depth: number) => {
    low = Math.min(low, depth);
    high = Math.max(high, depth);
  };
  for (const dot of dots) widen(dot.depth);
  for (let k = from; k < to; ++k) {
    const depth = depthAt(light, pixel, axis, k);
    if (isFinite(depth)) widen(depth);
  }
  const margin = Math.max(0.08 * (high - low), texelWidth(light.json.view, axis, { ...pixel.at, face: pixel.face }));
  low -= margin;
  high += margin;
  return {
    axis,
    from,
    to,
    low,
    high,
    x: (t) => left + ((t - from) / (to - from)) * (width - left - right),
    y: (depth) => top + ((depth - low) / (high - low)) * (height - top - bottom),
  };
}

function texelBars(frame: Frame, size: number): SVGElement {
  const group = svg("g"),
    w = frame.x(1) - frame.x(0);
  const every = w >= 3 ? 1 : 2 ** Math.ceil(Math.log2(3 / w));
  const from = Math.max(0, frame.from),
    to = Math.min(size, frame.to);
  for (let k = Math.ceil(from / every) * every; k < to; k += every)
    group.append(
      svg("rect", { class: (k / every) % 2 ? "texel-bar odd" : "texel-bar", x: frame.x(k), y: top - 12, width: every * w, height: 8 }),
    );
  return group;
}

// Stored depths as steps, and the map's shadow below them.
function storedSteps(light: Light, pixel: Pixel, frame: Frame, bias: number): SVGElement {
  let line = "",
    shade = "",
    before = NaN;
  const { view } = light.json,
    { face } = pixel,
    floor = height - bottom;
  for (let k = frame.from; k < frame.to; ++k) {
    const depth = depthAt(light, pixel, frame.axis, k),
      x = frame.x(k),
      next = frame.x(k + 1);
    if (isFinite(depth)) {
      const [u, v] = frame.axis === 0 ? [k + 0.5, pixel.at.v] : [pixel.at.u, k + 0.5];
      const allowed = (gapScale(light, { u, v, depth, face }) * bias) / alongRay(view, face, u, v);
      const y = frame.y(depth),
        tested = Math.min(frame.y(depth + allowed), floor);
      line += `${isFinite(before) ? "L" : "M"}${x.toFixed(1)},${y.toFixed(1)}H${next.toFixed(1)}`;
      shade += `M${x.toFixed(1)},${tested.toFixed(1)}H${next.toFixed(1)}V${floor}H${x.toFixed(1)}Z`;
    }
    before = depth;
  }
  return svg("g", {}, svg("path", { class: "believed", d: shade }), svg("path", { class: "stored", d: line }));
}

const curvePath = (curve: Curve, frame: Frame): string =>
  curve.map((p, i) => `${i === 0 ? "M" : "L"}${frame.x(frame.axis === 0 ? p.u : p.v).toFixed(1)},${frame.y(p.depth).toFixed(1)}`).join("");

// Triangles for false shadow, squares for missed shadow, discs for what is right; `s` is their size.
function dotShape(dot: Dot, frame: Frame, s: number): string {
  const at = `M${frame.x(dot.t).toFixed(1)},${frame.y(dot.depth).toFixed(1)}`;
  if (dot.outcome === "false") return `${at}m${-3.5 * s},${3 * s}h${7 * s}l${-3.5 * s},${-6.5 * s}z`;
  if (dot.outcome === "missed") return `${at}m${-3 * s},${-3 * s}h${6 * s}v${6 * s}h${-6 * s}z`;
  return `${at}m${-2 * s},0a${2 * s},${2 * s} 0 1 0 ${4 * s},0a${2 * s},${2 * s} 0 1 0 ${-4 * s},0`;
}

/** From so many on, marks lie over each other: bars show what share of a spot's pixels came out how. */
const mostMarks = 600,
  spotWidth = 3,
  spotHeight = 9;

/** A small spot of the drawing and its pixels by outcome. */
interface Spot {
  x: number;
  y: number;
  counts: Record<Outcome, number>;
}

function spotsOf(dots: Dot[], frame: Frame): Spot[] {
  const spots = new Map<number, Spot>();
  for (const dot of dots) {
    const column = Math.floor((frame.x(dot.t) - left) / spotWidth),
      row = Math.floor((frame.y(dot.depth) - top) / spotHeight),
      key = 4096 * row + column;
    let spot = spots.get(key);
    if (!spot)
      spots.set(
        key,
        (spot = { x: left + column * spotWidth, y: top + row * spotHeight, counts: { lit: 0, dark: 0, false: 0, missed: 0 } }),
      );
    ++spot.counts[dot.outcome];
  }
  return [...spots.values()];
}

// Each spot split from top to bottom in proportion.
function spotPaths(spots: Spot[]): SVGElement[] {
  const paths: Record<Outcome, string> = { lit: "", dark: "", false: "", missed: "" };
  for (const { x, y, counts } of spots) {
    const all = counts.lit + counts.dark + counts.false + counts.missed;
    let from = y;
    for (const outcome of Object.keys(outcomes) as Outcome[]) {
      const height = (spotHeight * counts[outcome]) / all;
      if (height > 0) paths[outcome] += `M${x.toFixed(1)},${from.toFixed(1)}h${spotWidth}v${height.toFixed(1)}h${-spotWidth}z`;
      from += height;
    }
  }
  return (Object.keys(outcomes) as Outcome[]).map((outcome) => svg("path", { class: `spot ${outcome}`, d: paths[outcome] }));
}

function marks(dots: Dot[], frame: Frame): SVGElement[] {
  if (dots.length > mostMarks) return spotPaths(spotsOf(dots, frame));
  return (Object.keys(outcomes) as Outcome[]).map((outcome) =>
    svg("path", {
      class: `dot ${outcome}`,
      d: dots
        .filter((d) => d.outcome === outcome)
        .map((d) => dotShape(d, frame, 1))
        .join(""),
    }),
  );
}

function axes(frame: Frame, line: string): SVGElement {
  const group = svg("g");
  const depths = niceTicks(frame.low, frame.high, 5),
    texts = tickTexts(depths);
  depths.forEach((depth, i) =>
    group.append(
      svg("line", { class: "grid", x1: left, x2: width - right, y1: frame.y(depth), y2: frame.y(depth) }),
      svg(
        "text",
        {
          class: "end",
          x: left - 6,
          y: frame.y(depth) + 4,
          ...(texts[i]!.length > 7 ? { textLength: left - 8, lengthAdjust: "spacingAndGlyphs" } : {}),
        },
        texts[i]!,
      ),
    ),
  );
  for (const t of niceTicks(frame.from, frame.to, 8))
    if (Number.isInteger(t)) group.append(svg("text", { class: "middle", x: frame.x(t), y: height - bottom + 17 }, number(t)));
  group.append(
    svg("text", { class: "middle", x: (left + width - right) / 2, y: height - 8 }, `texels of the map, ${line}`),
    svg("text", { class: "end", x: left - 6, y: top - 12 }, "depth"),
    svg("text", { x: left, y: 14 }, "↓ light"),
  );
  return group;
}

function legend(dots: Dot[]): HTMLElement {
  const list = html("p", { class: "key" });
  for (const [outcome, name] of Object.entries(outcomes) as [Outcome, string][]) {
    const count = dots.filter((dot) => dot.outcome === outcome).length;
    const mark = svg(
      "svg",
      { viewBox: "-5 -5 10 10", "aria-hidden": "true", class: "mark" },
      svg("path", {
        class: `dot ${outcome}`,
        d: dotShape({ t: 0, depth: 0, outcome, index: 0 }, { x: () => 0, y: () => 0 } as unknown as Frame, 1),
      }),
    );
    list.append(html("span", {}, mark, ` ${name}: ${grouped(count)}`));
  }
  return list;
}

const isOutside = (position: number, size: number): boolean => position < 0 || position >= size;

export function sectionDrawing(
  light: Light,
  pixel: Pixel,
  scene: Geometry,
  axis: 0 | 1,
  halfWidth: number,
  bias: number,
  id: string,
): HTMLElement {
  const [t, across] = axis === 0 ? [pixel.at.u, pixel.at.v] : [pixel.at.v, pixel.at.u];
  const size = light.json.view.size,
    centre = Math.floor(t),
    line = `${axis === 0 ? "row" : "column"} ${Math.floor(across)}`;
  const parts = otherParts(light.json.bias),
    outside = isOutside(t, size) || isOutside(across, size);
  // Of a pixel outside the map the scene beyond the map's edge is drawn.
  const from = outside ? centre - halfWidth : Math.max(0, centre - halfWidth),
    to = outside ? centre + halfWidth + 1 : Math.min(size, centre + halfWidth + 1);
  const { pixels, curves } = lineThrough(light, pixel, axis, scene, from, to);
  const dots = pixels.map((i) => dotOf(light, axis, i, bias));
  const frame = frameFor(light, pixel, axis, from, to, dots);
  const clip = `${id}-clip`,
    x = frame.x(t),
    y = frame.y(pixel.at.depth);
  const stretch =
    (height - top - bottom) /
    (frame.high - frame.low) /
    ((width - left - right) / ((to - from) * texelWidth(light.json.view, axis, { ...pixel.at, face: pixel.face })));
  const drawing = svg(
    "svg",
    { class: "section", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-labelledby": `${id}-title` },
    svg("title", { id: `${id}-title` }, `Cross-section along ${line} of the map through pixel ${pixel.x}, ${pixel.y}`),
    svg(
      "defs",
      {},
      svg("clipPath", { id: clip }, svg("rect", { x: left, y: top, width: width - left - right, height: height - top - bottom })),
    ),
    axes(frame, outside ? `in line with ${line}` : line),
    ...(isOutside(across, size) ? [] : [texelBars(frame, size)]),
    svg(
      "g",
      { "clip-path": `url(#${clip})` },
      storedSteps(light, pixel, frame, bias),
      svg("path", { class: "profile", d: curves.map((curve) => curvePath(curve, frame)).join("") }),
      ...marks(dots, frame),
    ),
    svg("line", { class: "own-ray", x1: x, x2: x, y1: top, y2: y }),
    svg("circle", { class: "ring", cx: x, cy: y, r: 8 }),
  );
  return html(
    "figure",
    {},
    html(
      "div",
      { class: "scroll", role: "region", tabindex: "0", "aria-label": `Cross-section, ${light.json.name}` },
      drawing as unknown as Node,
    ),
    legend(dots),
    html(
      "figcaption",
      {},
      `${
        outside ? "The pixel lies outside the map: no texel is asked about it. " : ""
      }Thin: the scene itself, cut exactly along the light rays through the pixel${
        scene.solidSectors > 0
          ? `, curved solids other than spheres as meshes of ${scene.solidSectors} sectors or ${scene.solidSectors / 2} cells across`
          : ""
      }${scene.complete ? "" : " (some of it is too much for this page and left out)"}. ` +
        `Thick steps: the depths stored in ${line}${
          light.map.step > 1 ? `, the nearest of ${light.map.step} × ${light.map.step} texels` : ""
        }. Shaded: shadow by the map, from the ${parts === "" ? "" : "constant "}bias on${
          parts === "" ? "" : `; ${parts}, which every pixel has its own of, cannot be drawn here`
        }. ` +
        `Depth is drawn ${number(stretch, 2)} times as large as width. ${
          dots.length > mostMarks ? "Coloured bars, each split by what came out" : "Marks"
        }: the ${counted(
          dots.length,
          "pixel",
        )} that look${dots.length === 1 ? "s" : ""} these texels up, from anywhere across the ${axis === 0 ? "row" : "column"}.`,
    ),
  );
}
