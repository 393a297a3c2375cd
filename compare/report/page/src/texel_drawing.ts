// The light-space drawing of one pixel, to scale: light comes from above; across, the map's texels; downwards, depth.
// The thick steps are the stored depths, the slanted line is the receiver's own plane, cut through the pixel's point.
import type { Light, Pixel } from "./data";
import { alongRay, halfSlopes, planeDepth, texelWidth, add, project, length, cross, texelRay } from "./light_view";
import { html, number, svg } from "./svg";

const width = 560, height = 400, top = 46, bottom = 44, side = 12;
const spans = [5, 9, 17, 33];  // texels shown: the fewest in which the gap and the bias have room

interface Frame {
  axis: 0 | 1;
  texel: number;   // world width of a texel along the axis
  texels: number;  // shown
  first: number;   // number of the first texel shown
  x: (texels: number) => number;
  y: (depth: number) => number;
  low: number;     // depth at the top edge
  high: number;    // at the bottom edge
}

/** World units of this pixel for one of its gap: where the bias scales with the texel, that is for a texel of texel_world. */
function gapScale(light: Light, pixel: Pixel): number {
  const { bias, texel_world, view } = light.json;
  if (!bias.scales) return 1;
  const at = { ...pixel.at, face: pixel.face };
  return Math.max(texelWidth(view, 0, at), texelWidth(view, 1, at)) / texel_world;
}

/** The depth that the pixel's texel stores, along the face's axis, from its gap where that is a plain difference. */
export function storedDepth(light: Light, pixel: Pixel): number {
  const { bias, view } = light.json;
  if (pixel.gap === -Infinity) return Infinity;
  const plain = bias.slope === 0 && bias.normal_offset === 0 && !bias.receiver_plane;
  if (plain) return pixel.at.depth - (gapScale(light, pixel) * pixel.gap) / alongRay(view, pixel.face, pixel.at.u, pixel.at.v);
  return light.map.depth(pixel.face, Math.floor(pixel.at.u), Math.floor(pixel.at.v));
}

/** The whole bias of this pixel along the ray: constant and slope part, as depth. */
function biasDepth(light: Light, pixel: Pixel, constant: number): number {
  const { view, bias } = light.json;
  const [u, v] = halfSlopes(view, pixel.face, pixel.at, pixel.position, pixel.normal);
  return (gapScale(light, pixel) * constant) / alongRay(view, pixel.face, pixel.at.u, pixel.at.v) + (bias.slope === 0 ? 0 : bias.slope * (u + v));
}

function frameFor(light: Light, pixel: Pixel, stored: number, bias: number): Frame {
  const view = light.json.view, [su, sv] = halfSlopes(view, pixel.face, pixel.at, pixel.position, pixel.normal);
  const axis = sv > su ? 1 : 0, texel = texelWidth(view, axis, { ...pixel.at, face: pixel.face });
  const room = height - top - bottom, tested = stored + bias;
  const least = Math.min(pixel.at.depth, isFinite(stored) ? stored : Infinity, isFinite(tested) ? tested : Infinity);
  const most = Math.max(pixel.at.depth, isFinite(tested) ? tested : -Infinity, isFinite(stored) ? stored : -Infinity);
  const scale = (texels: number) => (width - 2 * side) / (texels * texel);
  const texels = spans.find((n) => (most - least) * scale(n) < 0.7 * room) ?? spans[0]!;
  const s = scale(texels), fits = (most - least) * s < 0.7 * room;
  const middle = fits ? (least + most) / 2 : pixel.at.depth - (0.2 * room) / s;
  const centre = Math.floor(axis === 0 ? pixel.at.u : pixel.at.v), first = centre - (texels - 1) / 2;
  const low = middle - (0.5 * room) / s;
  return {
    axis, texel, texels, first, low, high: middle + (0.5 * room) / s,
    x: (t) => side + (t - first) * texel * s,
    y: (depth) => top + (depth - low) * s,
  };
}

/** Map position that is `t` along the frame's axis and the pixel's own across it. */
const along = (frame: Frame, pixel: Pixel, t: number): [number, number] =>
  frame.axis === 0 ? [t, pixel.at.v] : [pixel.at.u, t];

function neighbour(light: Light, frame: Frame, pixel: Pixel, texel: number, own: number, stored: number): number {
  if (texel === own) return stored;
  const [u, v] = along(frame, pixel, texel + 0.5);
  return light.map.depth(pixel.face, Math.floor(u), Math.floor(v));
}

function steps(light: Light, frame: Frame, pixel: Pixel, stored: number, bias: number): SVGElement {
  const group = svg("g"), own = Math.floor(frame.axis === 0 ? pixel.at.u : pixel.at.v);
  for (let k = frame.first; k < frame.first + frame.texels; ++k) {
    const x = frame.x(k), w = frame.x(k + 1) - x, depth = neighbour(light, frame, pixel, k, own, stored);
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
  const points: string[] = [], samples = 8 * frame.texels;
  for (let i = 0; i <= samples; ++i) {
    const t = frame.first + (i * frame.texels) / samples, [u, v] = along(frame, pixel, t);
    const depth = planeDepth(light.json.view, pixel.face, u, v, pixel.position, pixel.normal);
    if (isFinite(depth)) points.push(`${frame.x(t).toFixed(1)},${frame.y(depth).toFixed(1)}`);
  }
  return svg("polyline", { class: "receiver", points: points.join(" ") });
}

// A distance along the depth axis with its name behind it, or `before` it.
function bracket(frame: Frame, x: number, from: number, to: number, kind: string, text: string, before = false): SVGElement {
  const a = Math.max(top, Math.min(frame.y(from), height - bottom)), b = Math.max(top, Math.min(frame.y(to), height - bottom));
  const flip = before || x > width - 150;
  return svg("g", { class: kind },
    svg("path", { class: "bracket", d: `M${x - 4},${a}h8M${x},${a}V${b}M${x - 4},${b}h8` }),
    svg("text", { x: flip ? x - 8 : x + 8, y: Math.max(top + 12, Math.min((a + b) / 2 + 4, height - bottom - 4)), class: flip ? "end" : "" }, text));
}

function marks(light: Light, frame: Frame, pixel: Pixel, stored: number, bias: number, constant: number): SVGElement {
  const t = frame.axis === 0 ? pixel.at.u : pixel.at.v, own = Math.floor(t);
  const x = frame.x(t), y = frame.y(pixel.at.depth), group = svg("g"), right = frame.x(own + 1);
  const centre = frame.x(own + 0.5);
  group.append(svg("line", { class: "centre-ray", x1: centre, x2: centre, y1: top, y2: height - bottom }));
  group.append(svg("line", { class: "own-ray", x1: x, x2: x, y1: top, y2: y }));
  if (light.json.bias.normal_offset > 0) group.append(movedPoint(light, frame, pixel));
  if (isFinite(stored)) {
    if (stored < frame.low || stored > frame.high) group.append(offScale(frame, right, stored, pixel));
    else group.append(bracket(frame, right + 8, stored, stored + bias, "bias-mark", `bias ${number(constant, 3)}`));
    group.append(bracket(frame, frame.x(own) - 8, stored, pixel.at.depth, "gap-mark", `gap ${number(pixel.gap, 3)}`, true));
  } else group.append(svg("text", { class: "note", x: right + 8, y: top + 20 }, "nothing stored here:"),
    svg("text", { class: "note", x: right + 8, y: top + 38 }, "never in shadow"));
  group.append(svg("circle", { class: "point", cx: x, cy: y, r: 5 }));
  return group;
}

function offScale(frame: Frame, x: number, stored: number, pixel: Pixel): SVGElement {
  const above = stored < frame.low, y = above ? top + 4 : height - bottom - 4, d = above ? 14 : -14;
  const crowded = x + 16 + 230 > width, text = { x: crowded ? width - side : x + 16, class: crowded ? "end" : "" };
  return svg("g", { class: "note" },
    svg("path", { class: "bracket", d: `M${x + 6},${y + d}v${-d}m-4,${d / 2}l4,${-d / 2}l4,${d / 2}` }),
    svg("text", { ...text, y: above ? y + 12 : y - 22 }, `stored: ${number(Math.abs(pixel.at.depth - stored), 3)} ${above ? "nearer the light" : "farther"},`),
    svg("text", { ...text, y: above ? y + 30 : y - 4 }, "off this drawing"));
}

// Where the normal offset moves the point before it looks up the map.
function movedPoint(light: Light, frame: Frame, pixel: Pixel): SVGElement {
  const { view, bias } = light.json, ray = texelRay(view, pixel.face, pixel.at.u, pixel.at.v);
  const widest = Math.max(...([0, 1] as const).map((k) => texelWidth(view, k, { ...pixel.at, face: pixel.face })));
  const sine = length(cross(pixel.normal, ray.direction));
  const moved = project(view, pixel.face, add(pixel.position, pixel.normal, bias.normal_offset * widest * sine));
  return svg("circle", { class: "moved", cx: frame.x(frame.axis === 0 ? moved.u : moved.v), cy: frame.y(moved.depth), r: 4 });
}

export function texelDrawing(light: Light, pixel: Pixel, constant: number, id: string): HTMLElement {
  const stored = storedDepth(light, pixel), bias = biasDepth(light, pixel, constant);
  const frame = frameFor(light, pixel, stored, isFinite(bias) ? bias : 0);
  const clip = `${id}-clip`, dark = pixel.gap > Math.fround(constant);
  const drawing = svg("svg", { class: "light-space", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-labelledby": `${id}-title` },
    svg("title", { id: `${id}-title` }, `Light-space drawing of pixel ${pixel.x}, ${pixel.y}: ${dark ? "in shadow" : "lit"} by the map`),
    svg("defs", {}, svg("clipPath", { id: clip }, svg("rect", { x: side, y: top, width: width - 2 * side, height: height - top - bottom }))),
    svg("text", { class: "middle", x: width / 2, y: 16 }, "light"),
    ...[-60, -30, 30, 60].map((dx) => svg("path", { class: "light-ray", d: `M${width / 2 + dx},6v26m-3,-6l3,6l3,-6` })),
    svg("g", { "clip-path": `url(#${clip})` }, steps(light, frame, pixel, stored, isFinite(bias) ? bias : 0), receiverLine(light, frame, pixel)),
    marks(light, frame, pixel, stored, isFinite(bias) ? bias : 0, constant),
    svg("text", { class: "middle", x: width / 2, y: height - 8 }, `texels along the map's ${frame.axis === 0 ? "u (columns)" : "v (rows)"}`));
  // The texel numbers stand below the clipped part.
  const numbers = drawing.querySelectorAll("g[clip-path] text");
  drawing.append(...numbers);
  return html("figure", {}, drawing, html("figcaption", {},
    `To scale: a texel is ${number(frame.texel, 3)} wide here, depth has the same unit. Thick: stored depth. ` +
    `Dashed: stored depth and bias; what lies below it, the map takes for shadow. Slanted: the receiver's plane; ` +
    `dotted: the ray through the texel's centre. The point is the pixel: ${dark ? "below the dashed line, so in shadow" : "not below the dashed line, so lit"}.` +
    (light.json.bias.receiver_plane ? " With receiver plane, the test compares the plane at the texel's centre." : "") +
    (light.map.step > 1 ? ` Neighbouring texels show the nearest depth of ${light.map.step} × ${light.map.step}.` : "")));
}
