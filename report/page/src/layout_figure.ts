// Where camera and maps lie, drawn from the side. These are what the camera sees, what each map covers, and the box around all that
// is finite, all as lines seen from where camera and light both look across.
import { fixed } from "./log_chart";
import { add, cross, dot, length, scaled, sub, unit, type Vec3 } from "./light_view";
import { facts, result, type LightResult } from "./report_document";
import { flowing, markup, type Markup } from "./template";

type Box = readonly Vec3[]; // four corners, and the four beside them
const width = 640,
  height = 400,
  margin = 14;

const edges = (corners: Box): [Vec3, Vec3][] =>
  [0, 1, 2, 3].flatMap((k): [Vec3, Vec3][] => [
    [corners[k]!, corners[k + 4]!],
    [corners[k]!, corners[(k + 1) % 4]!],
    [corners[k + 4]!, corners[((k + 1) % 4) + 4]!],
  ]);

const boxOf = ([low, high]: readonly Vec3[]): Box =>
  [low, high].flatMap((at) => {
    const z = at![2];
    return [
      [low![0], low![1], z],
      [high![0], low![1], z],
      [high![0], high![1], z],
      [low![0], high![1], z],
    ] as Vec3[];
  });

/** Across both ways, and a little from above; from the side of what is higher. */
function sight(camera: Vec3, light: Vec3): { right: Vec3; up: Vec3 } {
  const across = cross(camera, light),
    level: Vec3 = length(across) > 0.1 ? unit(across) : unit(cross(camera, Math.abs(camera[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
  const flat: Vec3 = Math.hypot(level[0], level[2]) > 0.2 ? unit([level[0], 0, level[2]]) : [1, 0, 0],
    forward = unit(sub(scaled(flat, -1), [0, 0.45, 0]));
  const right = unit(cross(forward, [0, 1, 0]));
  return { right, up: cross(right, forward) };
}

/** Of a light whose maps are known; a cube looks everywhere. */
export function layoutFigure(light: LightResult, i: number): Markup | null {
  const { camera } = result,
    { windows, rays } = light.map;
  if (rays || !camera || !windows || windows.length === 0 || light.light.type === "point") return null;
  const first = windows[0]!,
    { right, up } = sight(camera.forward, unit(sub(add(first[4]!, first[6]!), add(first[0]!, first[2]!))));
  const bounds = camera.finite_bounds && boxOf(camera.finite_bounds),
    at = (p: Vec3): [number, number] => [dot(p, right), -dot(p, up)];
  const all = [...camera.corners, ...windows.flat(), ...(bounds ?? [])].map(at),
    xs = all.map(([x]) => x),
    ys = all.map(([, y]) => y);
  const [left, top] = [Math.min(...xs), Math.min(...ys)],
    scale = Math.min((width - 2 * margin) / (Math.max(...xs) - left), (height - 2 * margin) / (Math.max(...ys) - top));
  const shown = (p: Vec3): string[] => at(p).map((v, k) => fixed(margin + (v - [left, top][k]!) * scale));
  const lines = (box: Box, kind: string): Markup =>
    markup`<path class="${kind}" d="${edges(box)
      .map(([a, b]) => `M${shown(a).join(",")}L${shown(b).join(",")}`)
      .join("")}"/>`;
  const [x, y] = shown(camera.eye),
    drawnHeight = (Math.max(...ys) - top) * scale + 2 * margin,
    cascades = windows.length > 1;
  return markup`<h3>Where the map lies</h3>
<p>${flowing(facts.light_facts[i]!.window)}</p>
<figure><svg class="chart layout" viewBox="0 0 ${width} ${fixed(drawnHeight)}" role="img" aria-label="Camera, light and scene as lines">${
    bounds && lines(bounds, "bounds")
  }${windows.map((box) =>
    lines(box, "window"),
  )}${lines(camera.corners, "seen")}<circle class="eye worst-eye" cx="${x}" cy="${y}" r="5"/></svg><figcaption>From
the side: the camera (dot) and what it sees, <b class="window-text">what the light's map${
    cascades ? "s cover, a box for each" : " covers"
  }</b> between its near and far depth, and,
dashed, the box around all that is finite. A caster outside the map's box casts no shadow; what is seen outside it is lit.</figcaption></figure>
`;
}
