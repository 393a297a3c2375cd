// Two triangles that share an edge, seen along a ray: the edge's number is one product with two signs, so that the ray cannot pass
// between them. Beside it the same rays by Möller and Trumbore in single precision, where each triangle rounds by itself.
import { html, number } from "../svg";
import { add, cross, unit, type Vec2 } from "./flatland";
import { frame, type FlatlandJson } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

type Vec3 = readonly [number, number, number];
const f = Math.fround;
const sub3 = (a: Vec3, b: Vec3): Vec3 => [f(a[0] - b[0]), f(a[1] - b[1]), f(a[2] - b[2])];
const dot3 = (a: Vec3, b: Vec3): number => f(f(f(a[0] * b[0]) + f(a[1] * b[1])) + f(a[2] * b[2]));
const minus = (a: number, b: number, c: number, d: number): number => f(f(a * b) - f(c * d));
const cross3 = (a: Vec3, b: Vec3): Vec3 => [minus(a[1], b[2], a[2], b[1]), minus(a[2], b[0], a[0], b[2]), minus(a[0], b[1], a[1], b[0])];

type Triangle = readonly [Vec3, Vec3, Vec3];
/** Möller and Trumbore (1997), every operation rounded to a float. */
function mollerTrumbore(o: Vec3, d: Vec3, [a, b, c]: Triangle): boolean {
  const e1 = sub3(b, a),
    e2 = sub3(c, a),
    p = cross3(d, e2),
    det = dot3(e1, p),
    s = sub3(o, a),
    u = f(dot3(s, p) / det),
    v = f(dot3(d, cross3(s, e1)) / det);
  return u >= 0 && v >= 0 && f(u + v) <= 1;
}
/** Woop, Benthin and Wald (2013): corners sheared so that the ray is the z axis, in floats, then signs of products, which are exact here. */
function bySigns(o: Vec3, d: Vec3, corners: Triangle): boolean {
  const [A, B, C] = corners.map((corner): Vec2 => {
    const at = sub3(corner, o);
    return [f(at[0] - f(f(d[0] / d[2]) * at[2])), f(at[1] - f(f(d[1] / d[2]) * at[2]))];
  }) as [Vec2, Vec2, Vec2];
  return oneSign(cross(C, B), cross(A, C), cross(B, A));
}
const oneSign = (...numbers: number[]): boolean => numbers.every((n) => n >= 0) || numbers.every((n) => n <= 0);

const aimed = 1000;
/** Of rays aimed at the shared edge, how many pass between the two triangles. */
function lost(corners: readonly Vec3[], meets: (o: Vec3, d: Vec3, triangle: Triangle) => boolean): number {
  const [A, B, C, D] = corners as [Vec3, Vec3, Vec3, Vec3],
    o: Vec3 = [f(0.1), f(0.2), -1];
  let count = 0;
  for (let i = 0; i < aimed; ++i) {
    const at = (i + 0.5) / aimed,
      d = sub3([0, 1, 2].map((k) => f(B[k]! + at * (C[k]! - B[k]!))) as unknown as Vec3, o);
    if (!meets(o, d, [A, B, C]) && !meets(o, d, [D, C, B])) ++count;
  }
  return count;
}

const names = ["A", "B", "C", "D"],
  depths = [2, 3, 5, 4];

export function edgeFigure(id: string, window: FlatlandJson["window"]): HTMLElement {
  let corners: Vec2[] = [];
  const stage = new Stage(
    window,
    say("Two triangles that share an edge, seen along the ray, which is the middle point"),
    (at, handle) => {
      sliders.set(`${handle}x`, at[0]);
      sliders.set(`${handle}y`, at[1]);
    },
    () => Object.fromEntries(names.map((name, i) => [name, corners[i]!])),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const start: Vec2[] = [
    [-1.7, 0.1],
    [0.6, -1.1],
    [-0.3, 1.1],
    [1.9, -0.2],
  ];
  const sliders: Sliders<string> = new Sliders<string>(
    Object.fromEntries(
      names.flatMap((name, i) =>
        ([0, 1] as const).map((k) => [
          `${name}${"xy"[k]}`,
          {
            name: say`Corner ${name}, ${k === 0 ? say("left and right") : say("up and down")}`,
            from: window[2 * k]!,
            to: window[2 * k + 1]!,
            step: 0.005,
            value: start[i]![k],
            text: (v: number) => number(v, 3),
            drags: true,
          },
        ]),
      ),
    ),
    () => show(),
  );
  const show = () => {
    corners = names.map((name): Vec2 => [sliders.value(`${name}x`), sliders.value(`${name}y`)]);
    const [A, B, C, D] = corners as [Vec2, Vec2, Vec2, Vec2],
      own = cross(C, B),
      other = cross(B, C),
      left = oneSign(own, cross(A, C), cross(B, A)) && own + cross(A, C) + cross(B, A) !== 0,
      right = oneSign(other, cross(C, D), cross(D, B)) && other + cross(C, D) + cross(D, B) !== 0;
    const deep = corners.map(([x, y], i): Vec3 => [f(x), f(y), depths[i]!]),
      [byFormula, byNumbers] = [lost(deep, mollerTrumbore), lost(deep, bySigns)];
    stage.put(
      stage.path(left ? "area u" : "area none", [[A, B, C, A]]),
      stage.path(right ? "area v" : "area none", [[D, C, B, D]]),
      stage.path("profile thin", [
        [A, B, C, A],
        [B, D, C],
      ]),
      ...corners.map((p, i) => stage.label("middle", add(p, unit(Math.hypot(...p) > 0 ? p : [1, 0]), 0.16), names[i]!, 6)),
      ...corners.map((p) => stage.circle("point", p, 9)),
      stage.circle(left || right ? "hit" : "moved", [0, 0], 9),
    );
    Object.assign(said.dataset, {
      hit: String(left),
      other: String(right),
      u: String(own),
      u2: String(other),
      formula: String(byFormula),
      signs: String(byNumbers),
    });
    said.textContent = say`The shared edge's number Cx·By − Cy·Bx is ${number(own, 3)} for ABC and ${number(other, 3)} for DCB: one product, two signs. The ray hits ${
      left && right ? say("both") : left ? say("ABC") : right ? say("DCB") : say("neither")
    }. Of ${aimed} rays at the edge ${byFormula} pass between both by Möller and Trumbore in floats, ${byNumbers} by signs.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say("Drag a corner: seen along the ray the ray is the point in the middle. The corners lie at depths 2, 3, 5 and 4."),
  );
}
