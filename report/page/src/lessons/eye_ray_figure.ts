// The ray through a pixel's centre: the picture as the eye sees it, and the same from the side.
import { html, number } from "../svg";
import type { Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { frame } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

/** The unit direction through the centre of pixel (x, y), counted from the top left, of an eye that looks down −z; `fov`: of the picture's height, degrees. */
export function eyeRay(
  columns: number,
  rows: number,
  fov: number,
  x: number,
  y: number,
): { u: number; v: number; direction: [number, number, number] } {
  const half = Math.tan((fov * Math.PI) / 360),
    u = (2 * (x + 0.5)) / columns - 1,
    v = 1 - (2 * (y + 0.5)) / rows;
  const d = [u * half * (columns / rows), v * half, -1] as const,
    size = Math.hypot(...d);
  return { u, v, direction: [d[0] / size, d[1] / size, d[2] / size] };
}

declare global {
  var gnomonEyeRay: typeof eyeRay | undefined; // eslint-disable-line no-var
}
globalThis.gnomonEyeRay = eyeRay;

const window: [number, number, number, number] = [-4.4, 3.6, -1.5, 1.5];
const film = 1.5,
  eye: Vec2 = [-4.2, 0],
  front: Vec2 = [1.9, 0]; // how far the film is from the eye, and where both drawings stand

export function eyeRayFigure(_: FigureJson, id: string): HTMLElement {
  let at: Vec2 = [0, 0];
  const stage = new Stage(
    window,
    say("The picture's pixels, and the same from the side: the eye, the picture and a ray"),
    (place) => {
      const { columns, rows, side } = grid();
      sliders.set("x", Math.min(Math.max(Math.floor((place[0] - front[0]) / side + columns / 2), 0), columns - 1));
      sliders.set("y", Math.min(Math.max(Math.floor((front[1] - place[1]) / side + rows / 2), 0), rows - 1));
    },
    () => ({ at }),
  );
  const said = html("p", { class: "bias-counts", role: "status" }),
    whole = (name: string, from: number, to: number, value: number, drags = false) => ({
      name,
      from,
      to,
      step: 1,
      value,
      text: String,
      drags,
    });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      fov: { name: say("Field of view, of the height"), from: 20, to: 110, step: 1, value: 60, text: (v) => `${v}°` },
      columns: whole(say("Columns"), 1, 16, 8),
      rows: whole(say("Rows"), 1, 12, 6),
      x: whole(say("Pixel's column"), 0, 15, 6, true),
      y: whole(say("Pixel's row"), 0, 11, 1, true),
    },
    () => show(),
  );
  const grid = () => {
    const columns = sliders.value("columns"),
      rows = sliders.value("rows");
    return { columns, rows, side: Math.min(3.2 / columns, 2.6 / rows) };
  };
  const lines = (count: number, from: number, side: number, other: [number, number], upright: boolean): Vec2[][] =>
    Array.from({ length: count + 1 }, (_, i) => other.map((o): Vec2 => (upright ? [from + i * side, o] : [o, from + i * side])));
  const show = () => {
    const { columns, rows, side } = grid(),
      fov = sliders.value("fov"),
      x = Math.min(sliders.value("x"), columns - 1),
      y = Math.min(sliders.value("y"), rows - 1);
    const { u, v, direction } = eyeRay(columns, rows, fov, x, y),
      half = Math.tan((fov * Math.PI) / 360) * film,
      left = front[0] - (columns * side) / 2,
      top = front[1] + (rows * side) / 2,
      bottom = front[1] - (rows * side) / 2;
    at = [left + (x + 0.5) * side, top - (y + 0.5) * side];
    const pixel: Vec2[] = [
      [left + x * side, top - y * side],
      [left + (x + 1) * side, top - y * side],
      [left + (x + 1) * side, top - (y + 1) * side],
      [left + x * side, top - (y + 1) * side],
      [left + x * side, top - y * side],
    ];
    const plane = eye[0] + film,
      through: Vec2 = [plane, v * half],
      step = (2 * half) / rows,
      ticks = Array.from({ length: rows + 1 }, (_, i): Vec2[] => [
        [plane - 0.06, half - i * step],
        [plane + 0.06, half - i * step],
      ]);
    stage.put(
      stage.path("cells", [
        ...lines(columns, left, side, [bottom, top], true),
        ...lines(rows, bottom, side, [left, left + columns * side], false),
      ]),
      stage.path("visited tests", [pixel]),
      stage.path("ghost", [
        [eye, [eye[0] + 3, half * 2]],
        [eye, [eye[0] + 3, -half * 2]],
        [eye, [eye[0] + 3, 0]],
      ]),
      stage.path("profile thin", [
        [
          [plane, half],
          [plane, -half],
        ],
        ...ticks,
      ]),
      stage.path("ray", [[eye, [eye[0] + 2 * film, 2 * through[1]]]]),
      stage.circle("point", eye, 10),
      stage.label("middle", eye, say("eye"), -18),
      stage.circle("hit", through, 7),
      stage.circle("hit", at, 7),
    );
    Object.assign(said.dataset, {
      u: String(u),
      v: String(v),
      dx: String(direction[0]),
      dy: String(direction[1]),
      dz: String(direction[2]),
    });
    said.textContent = say`Pixel (${x}, ${y}) of ${columns} × ${rows}: its centre is at u = ${number(u, 3)}, v = ${number(v, 3)} of the half picture. tan(${fov}°/2) = ${number(half / film, 3)}, the aspect ${columns}/${rows} = ${number(columns / rows, 3)}: d = (${direction
      .map((c) => number(c, 3))
      .join(", ")}) of length 1.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say(
      "Choose a pixel in the picture on the right, or change the field of view and the number of pixels. On the left the same from the side.",
    ),
  );
}
