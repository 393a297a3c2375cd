// The three areas that decide about a triangle, as the ray sees it, or the two usual ways in their place. Shown are the numbers of
// each test, as the lesson derives them.
import { html, number } from "../svg";
import { add, cross, unit, type Vec2 } from "./flatland";
import { frame, type FlatlandJson } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

type Vec3 = readonly [number, number, number];
const sub3 = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot3 = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross3 = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The plane first, then on which side of each edge the point lies: t, and the three sides. */
function twoSteps(o: Vec3, d: Vec3, corners: readonly [Vec3, Vec3, Vec3]): { t: number; sides: number[] } {
  const [a, b, c] = corners,
    n = cross3(sub3(b, a), sub3(c, a)),
    t = dot3(n, sub3(a, o)) / dot3(n, d),
    p: Vec3 = [o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]];
  return { t, sides: corners.map((from, i) => dot3(n, cross3(sub3(corners[(i + 1) % 3]!, from), sub3(p, from))) / dot3(n, n)) };
}
/** Möller and Trumbore (1997): Cramer's rule for o + t d = a + u (b − a) + v (c − a). */
function mollerTrumbore(o: Vec3, d: Vec3, [a, b, c]: readonly [Vec3, Vec3, Vec3]): { det: number; t: number; u: number; v: number } {
  const e1 = sub3(b, a),
    e2 = sub3(c, a),
    p = cross3(d, e2),
    det = dot3(e1, p),
    s = sub3(o, a),
    q = cross3(s, e1);
  return { det, t: dot3(e2, q) / det, u: dot3(s, p) / det, v: dot3(d, q) / det };
}

/** Both ways, in words and numbers. */
function bothWays(corners: readonly [Vec3, Vec3, Vec3]): { words: string; numbers: Record<string, string> } {
  const o: Vec3 = [0, 0, 0],
    d: Vec3 = [0, 0, 1],
    two = twoSteps(o, d, corners),
    { det, t, u, v } = mollerTrumbore(o, d, corners),
    n3 = (x: number) => number(x, 3);
  const hit = det !== 0 && u >= 0 && v >= 0 && u + v <= 1;
  return {
    words:
      det === 0
        ? say("det = 0: the triangle has no area, or the ray runs in its plane; the ray misses.")
        : say`In two steps: the plane at t = ${n3(two.t)}, and the point's share of each side ${two.sides.map(n3).join(", ")}: ${
            two.sides.every((side) => side >= 0) ? say("none is negative") : say("one is negative")
          }. Möller and Trumbore: det = ${n3(det)}, u = ${n3(u)}, v = ${n3(v)}, t = ${n3(t)}: ${
            hit ? say("the ray hits.") : say("the ray misses.")
          }`,
    numbers: {
      hit: String(hit),
      z: String(t),
      u: String(u),
      v: String(v),
      det: String(det),
      twoSteps: String(two.t),
      sides: two.sides.join(" "),
    },
  };
}

/** Seen along the ray: the corners move, the ray is the origin. `both`: the two-step way and Möller's and Trumbore's, in place of the areas. */
export function triangleFigure(id: string, both: boolean, window: FlatlandJson["window"]): HTMLElement {
  let corners: Vec2[] = [];
  const names = ["A", "B", "C"],
    depths = [2, 3, 5];
  const stage = new Stage(
    window,
    say("A triangle seen along the ray, which is the middle point"),
    (at, handle) => {
      sliders.set(`${handle}x`, at[0]);
      sliders.set(`${handle}y`, at[1]);
    },
    () => Object.fromEntries(names.map((name, i) => [name, corners[i]!])),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const start: Vec2[] = [
    [-1.2, -0.7],
    [1.5, -0.4],
    [0.2, 1.1],
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
    const [A, B, C] = corners as [Vec2, Vec2, Vec2],
      u = cross(C, B),
      v = cross(A, C),
      w = cross(B, A),
      sum = u + v + w;
    const inside = ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) && sum !== 0,
      z = (u * depths[0]! + v * depths[1]! + w * depths[2]!) / sum;
    const area = (kind: string, p: Vec2, q: Vec2) => stage.path(`area ${kind}`, [[[0, 0], p, q, [0, 0]]]);
    stage.put(
      area("u", B, C),
      area("v", C, A),
      area("w", A, B),
      stage.path("profile thin", [[A, B, C, A]]),
      ...corners.map((p, i) => stage.label("middle", add(p, unit(Math.hypot(...p) > 0 ? p : [1, 0]), 0.16), names[i]!, 6)),
      ...corners.map((p) => stage.circle("point", p, 9)),
      stage.circle(inside ? "hit" : "moved", [0, 0], 9),
    );
    if (both) {
      const ways = bothWays([
        [...A, depths[0]!],
        [...B, depths[1]!],
        [...C, depths[2]!],
      ]);
      Object.assign(said.dataset, ways.numbers);
      said.textContent = ways.words;
      return;
    }
    Object.assign(said.dataset, { u: String(u), v: String(v), w: String(w), z: String(z), hit: String(inside) });
    said.textContent = say`u = ${number(u, 3)} (violet), v = ${number(v, 3)} (blue), w = ${number(w, 3)} (gold): ${
      inside
        ? say`none has another sign than the others, the ray hits, at z = (u·Az + v·Bz + w·Cz)/(u + v + w) = ${number(z, 4)} for corners at depths 2, 3 and 5.`
        : sum === 0
          ? say("their sum is 0, the triangle has no area, the ray misses.")
          : say("their signs differ, the ray misses.")
    }`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say`Drag a corner: seen along the ray the ray is the point in the middle. ${
      both ? say("The corners lie at depths 2, 3 and 5.") : say("Each coloured triangle is half of one of the three numbers.")
    }`,
  );
}
