// The light-space drawing of one pixel, to scale: light comes from above; across, the map's texels; downwards, depth.
// The thick steps are the stored depths, the slanted line is the receiver's own plane, cut through the pixel's point.
import type { Light, Pixel } from "./data";
import { alongRay, halfSlopes, planeDepth, texelWidth, add, project, length, cross, texelRay, type MapPoint } from "./light_view";
import { html, number, svg } from "./svg";

const width = 560,
  height = 400,
  top = 46,
  bottom = 44,
  side = 12;
const spans = [5, 9, 17, 33]; // texels shown: the fewest in which the gap and the bias have room

interface Frame {
  axis: 0 | 1;
  texel: number; // world width of a texel along the axis
  texels: number; // shown
  first: number; // number of the first texel shown
  x: (texels: number) => number;
  y: (depth: number) => number;
  low: number; // depth at the top edge
  high: number; // at the bottom edge
}

/** World units at a place of the map for one of its gap: where the bias scales with the texel, that is for a texel of texel_world. */
export function gapScale(light: Light, at: MapPoint & { face: number }): number {
  const { bias, texel_world, view } = light.json;
  if (!bias.scales) return 1;
  return Math.max(texelWidth(view, 0, at), texelWidth(view, 1, at)) / texel_world;
}

/** A part of the bias with its name, as depth along the face's axis. */
interface BiasPart {
  name: string;
  depth: number;
}

/** What the bias of this pixel is made of: its constant first, then what follows the slope of the surface. */
function biasParts(light: Light, pixel: Pixel, constant: number): BiasPart[] {
  const { view, bias } = light.json,
    { u, v } = pixel.at;
  const parts = [
    { name: "constant", depth: (gapScale(light, { ...pixel.at, face: pixel.face }) * constant) / alongRay(view, pixel.face, u, v) },
  ];
  if (bias.slope !== 0) {
    const [su, sv] = halfSlopes(view, pixel.face, pixel.at, pixel.position, pixel.normal);
    parts.push({ name: "slope", depth: bias.slope * (su + sv) });
  }
  if (bias.adaptive !== null) {
    const atCentre = planeDepth(view, pixel.face, Math.floor(u) + 0.5, Math.floor(v) + 0.5, pixel.position, pixel.normal);
    parts.push({ name: "adaptive", depth: Math.max(0, pixel.at.depth - atCentre) + bias.adaptive });
  }
  return parts;
}

const total = (parts: BiasPart[]): number => parts.reduce((sum, part) => sum + part.depth, 0);

/** The depth that the pixel's texel stores, along the face's axis: from its gap where that is a difference less parts known here. */
export function storedDepth(light: Light, pixel: Pixel): number {
  const { bias } = light.json;
  if (pixel.gap === -Infinity) return Infinity;
  if (bias.normal_offset === 0 && !bias.receiver_plane) return pixel.at.depth - total(biasParts(light, pixel, pixel.gap));
  return light.map.depth(pixel.face, Math.floor(pixel.at.u), Math.floor(pixel.at.v));
}

function frameFor(light: Light, pixel: Pixel, stored: number, bias: number): Frame {
  const view = light.json.view,
    [su, sv] = halfSlopes(view, pixel.face, pixel.at, pixel.position, pixel.normal);
  const axis = sv > su ? 1 : 0,
    texel = texelWidth(view, axis, { ...pixel.at, face: pixel.face });
  const room = height - top - bottom,
    tested = stored + bias;
  const least = Math.min(pixel.at.depth, isFinite(stored) ? stored : Infinity, isFinite(tested) ? tested : Infinity);
  const most = Math.max(pixel.at.depth, isFinite(tested) ? tested : -Infinity, isFinite(stored) ? stored : -Infinity);
  const scale = (texels: number) => (width - 2 * side) / (texels * texel);
  const texels = spans.find((n) => (most - least) * scale(n) < 0.7 * room) ?? spans[0]!;
  const s = scale(texels),
    fits = (most - least) * s < 0.7 * room;
  const middle = fits ? (least + most) / 2 : pixel.at.depth - (0.2 * room) / s;
  const centre = Math.floor(axis === 0 ? pixel.at.u : pixel.at.v),
    first = centre - (texels - 1) / 2;
  const low = middle - (0.5 * room) / s;
  return {
    axis,
    texel,
    texels,
    first,
    low,
    high: middle + (0.5 * room) / s,
    x: (t) => side + (t - first) * texel * s,
    y: (depth) => top + (depth - low) * s,
  };
}

/** Map position that is `t` along the frame's axis and the pixel's own across it. */
const along = (frame: Frame, pixel: Pixel, t: number): [number, number] => (frame.axis === 0 ? [t, pixel.at.v] : [pixel.at.u, t]);

function neighbour(light: Light, frame: Frame, pixel: Pixel, texel: number, own: number, stored: number): number {
  if (texel === own) return stored;
  const [u, v] = along(frame, pixel, texel + 0.5);
  return light.map.depth(pixel.face, Math.floor(u), Math.floor(v));
}

function steps(light: Light, frame: Frame, pixel: Pixel, stored: number, bias: number): SVGElement {
  const group = svg("g"),
    own = Math.floor(frame.axis === 0 ? pixel.at.u : pixel.at.v);
  for (let k = frame.first; k < frame.first + frame.texels; ++k) {
    const x = frame.x(k),
      w = frame.x(k + 1) - x,
      depth = neighbour(light, frame, pixel, k, own, stored);
    group.append(svg("rect", { class: k === own ? "column own" : "column", x, y: top, width: w, height: height - top - bottom }));
    if (isFinite(depth)) {
      const y = Math.max(top, Math.min(frame.y(depth + bias), height - bottom));
      group.append(svg("rect", { class: "believed", x, y, width: w, height: height - bottom - y }));
      group.append(svg("line", { class: "tested", x1: x, x2: x + w, y1: frame.y(depth + bias), y2: frame.y(depth + bias) }));
      group.append(svg("line", { class: k === own ? "stored own" : "stored", x1: x, x2: x + w, y1: frame.y(depth), y2: frame.y(depth) }));
    }
    if (k >= 0 && k < light.json.view.size && (frame.texels <= 9 || k === own))
      group.append(svg("text", { class: "middle", x: x + w / 2, y: height - bottom + 17 }, String(k)));
  }
  return group;
}

function receiverLine(light: Light, frame: Frame, pixel: Pixel): SVGElement {
  const points: string[] = [],
    samples = 8 * frame.texels;
  for (let i = 0; i <= samples; ++i) {
    const t = frame.first + (i * frame.texels) / samples,
      [u, v] = along(frame, pixel, t);
    const depth = planeDepth(light.json.view, pixel.face, u, v, pixel.position, pixel.normal);
    if (isFinite(depth)) points.push(`${frame.x(t).toFixed(1)},${frame.y(depth).toFixed(1)}`);
  }
  return svg("polyline", { class: "receiver", points: points.join(" ") });
}

// A distance along the depth axis with its name behind it, or `before` it; further lines of text below the name.
function bracket(frame: Frame, x: number, from: number, to: number, kind: string, lines: string[], before = false): SVGElement {
  const onto = (depth: number) => Math.max(top, Math.min(frame.y(depth), height - bottom)),
    a = onto(from),
    b = onto(to);
  const flip = before || x > width - 150,
    last = 17 * (lines.length - 1);
  const y = Math.max(top + 12, Math.min((a + b) / 2 + 4 - last / 2, height - bottom - 4 - last));
  return svg(
    "g",
    { class: kind },
    svg("path", { class: "bracket", d: `M${x - 4},${a}h8M${x},${a}V${b}M${x - 4},${b}h8` }),
    ...lines.map((line, i) => svg("text", { x: flip ? x - 8 : x + 8, y: y + 17 * i, class: flip ? "end" : "" }, line)),
  );
}

// The whole bias, and what it is made of where that is more than a constant.
function biasMark(light: Light, frame: Frame, pixel: Pixel, x: number, stored: number, parts: BiasPart[]): SVGElement {
  const along = alongRay(light.json.view, pixel.face, pixel.at.u, pixel.at.v),
    text = (depth: number) => number(depth * along, 3);
  const whole = `bias ${text(total(parts))}`;
  const mark = bracket(
    frame,
    x,
    stored,
    stored + total(parts),
    "bias-mark",
    parts.length === 1 ? [whole] : [`${whole}:`, ...parts.map(({ name, depth }, i) => `${i > 0 ? "+ " : ""}${name} ${text(depth)}`)],
  );
  parts
    .slice(0, -1)
    .forEach((_, i) => mark.append(svg("path", { class: "bracket", d: `M${x - 3},${frame.y(stored + total(parts.slice(0, i + 1)))}h6` })));
  return mark;
}

function marks(light: Light, frame: Frame, pixel: Pixel, stored: number, parts: BiasPart[]): SVGElement {
  const t = frame.axis === 0 ? pixel.at.u : pixel.at.v,
    own = Math.floor(t);
  const x = frame.x(t),
    y = frame.y(pixel.at.depth),
    group = svg("g"),
    right = frame.x(own + 1);
  const centre = frame.x(own + 0.5);
  group.append(svg("line", { class: "centre-ray", x1: centre, x2: centre, y1: top, y2: height - bottom }));
  group.append(svg("line", { class: "own-ray", x1: x, x2: x, y1: top, y2: y }));
  if (light.json.bias.normal_offset > 0) group.append(movedPoint(light, frame, pixel));
  if (isFinite(stored)) {
    const away = (pixel.at.depth - stored) * alongRay(light.json.view, pixel.face, pixel.at.u, pixel.at.v);
    if (stored < frame.low || stored > frame.high) group.append(offScale(frame, right, stored, away));
    else if (isFinite(total(parts))) group.append(biasMark(light, frame, pixel, right + 8, stored, parts));
    group.append(
      bracket(
        frame,
        frame.x(own) - 8,
        stored,
        pixel.at.depth,
        "gap-mark",
        [`${parts.length === 1 ? "gap" : "distance"} ${number(away, 3)}`],
        true,
      ),
    );
  } else
    group.append(
      svg("text", { class: "note", x: right + 8, y: top + 20 }, "nothing stored here:"),
      svg("text", { class: "note", x: right + 8, y: top + 38 }, "never in shadow"),
    );
  group.append(svg("circle", { class: "point", cx: x, cy: y, r: 5 }));
  return group;
}

function offScale(frame: Frame, x: number, stored: number, away: number): SVGElement {
  const above = stored < frame.low,
    y = above ? top + 4 : height - bottom - 4,
    d = above ? 14 : -14;
  const crowded = x + 16 + 230 > width,
    text = { x: crowded ? width - side : x + 16, class: crowded ? "end" : "" };
  return svg(
    "g",
    { class: "note" },
    svg("path", { class: "bracket", d: `M${x + 6},${y + d}v${-d}m-4,${d / 2}l4,${-d / 2}l4,${d / 2}` }),
    svg("text", { ...text, y: above ? y + 12 : y - 22 }, `stored: ${number(Math.abs(away), 3)} ${above ? "nearer the light" : "farther"},`),
    svg("text", { ...text, y: above ? y + 30 : y - 4 }, "off this drawing"),
  );
}

// Where the normal offset moves the point before it looks up the map.
function movedPoint(light: Light, frame: Frame, pixel: Pixel): SVGElement {
  const { view, bias } = light.json,
    ray = texelRay(view, pixel.face, pixel.at.u, pixel.at.v);
  const widest = Math.max(...([0, 1] as const).map((k) => texelWidth(view, k, { ...pixel.at, face: pixel.face })));
  const sine = length(cross(pixel.normal, ray.direction));
  const moved = project(view, pixel.face, add(pixel.position, pixel.normal, bias.normal_offset * widest * sine));
  return svg("circle", { class: "moved", cx: frame.x(frame.axis === 0 ? moved.u : moved.v), cy: frame.y(moved.depth), r: 4 });
}

export function texelDrawing(light: Light, pixel: Pixel, constant: number, id: string): HTMLElement {
  const stored = storedDepth(light, pixel),
    parts = biasParts(light, pixel, constant),
    bias = isFinite(total(parts)) ? total(parts) : 0;
  const frame = frameFor(light, pixel, stored, bias);
  const clip = `${id}-clip`,
    dark = pixel.gap > Math.fround(constant);
  const drawing = svg(
    "svg",
    { class: "light-space", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-labelledby": `${id}-title` },
    svg("title", { id: `${id}-title` }, `Light-space drawing of pixel ${pixel.x}, ${pixel.y}: ${dark ? "shadow" : "light"} by the map`),
    svg(
      "defs",
      {},
      svg("clipPath", { id: clip }, svg("rect", { x: side, y: top, width: width - 2 * side, height: height - top - bottom })),
    ),
    svg("text", { class: "middle", x: width / 2, y: 16 }, "light"),
    ...[-60, -30, 30, 60].map((dx) => svg("path", { class: "light-ray", d: `M${width / 2 + dx},6v26m-3,-6l3,6l3,-6` })),
    svg("g", { "clip-path": `url(#${clip})` }, steps(light, frame, pixel, stored, bias), receiverLine(light, frame, pixel)),
    marks(light, frame, pixel, stored, parts),
    svg(
      "text",
      { class: "middle", x: width / 2, y: height - 8 },
      `texels along the map's ${frame.axis === 0 ? "u (columns)" : "v (rows)"}`,
    ),
  );
  // The texel numbers stand below the clipped part.
  const numbers = drawing.querySelectorAll("g[clip-path] text");
  drawing.append(...numbers);
  return html(
    "figure",
    {},
    drawing,
    html(
      "figcaption",
      {},
      `To scale: a texel is ${number(frame.texel, 3)} wide here, depth has the same unit. Thick: stored depth. ` +
        `Dashed: stored depth and bias; what lies below it, the map takes for shadow. Slanted: the receiver's plane; ` +
        `dotted: the ray through the texel's centre. The point is the pixel: ${
          dark ? "below the dashed line, so the test takes it for shadowed" : "not below the dashed line, so the test takes it for lit"
        }.` +
        (light.json.bias.normal_offset > 0
          ? " Open circle: the point moved by the normal offset, which is what the map is asked about."
          : "") +
        (light.json.bias.receiver_plane ? " With receiver plane, the test compares the plane at the texel's centre." : "") +
        (light.map.step > 1 ? ` Neighbouring texels show the nearest depth of ${light.map.step} × ${light.map.step}.` : ""),
    ),
  );
}
