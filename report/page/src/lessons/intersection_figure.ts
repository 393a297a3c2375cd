// A ray dragged before a box, a ball, a plane, a polygon and a surface that is given by a function. Shown are the numbers of each test,
// as the lesson derives them.
import { html, number } from "../svg";
import { add, cross, dot, meetCircle, sub, unit, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { edgeFigure } from "./edge_figure";
import { frame } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import type { FlatlandJson } from "./flatland_figure";
import { many, say } from "./say";
import { triangleFigure } from "./triangle_figure";

type Interval = readonly [number, number];

/** The interval of the ray in the slab between two planes, ordered by the sign of its direction; a parallel ray is in it for ever or never. */
export function slab(origin: number, direction: number, low: number, high: number): Interval {
  if (direction === 0) return origin >= low && origin <= high ? [-Infinity, Infinity] : [Infinity, -Infinity];
  const [near, far] = direction < 0 ? [high, low] : [low, high];
  return [(near - origin) / direction, (far - origin) / direction];
}

/** The ray and a ball, by the point of the ray nearest to the centre (Haines et al. 2019). */
export function sphereRoots(
  origin: Vec2,
  direction: Vec2,
  center: Vec2,
  radius: number,
): { foot: Vec2; discriminant: number; roots: number[] } {
  const f = sub(origin, center),
    b = -dot(f, direction),
    l = add(f, direction, b),
    discriminant = radius * radius - dot(l, l);
  if (discriminant < 0) return { foot: add(center, l), discriminant, roots: [] };
  const q = b + Math.sign(b || 1) * Math.sqrt(discriminant),
    roots = [q, q === 0 ? 0 : (dot(f, f) - radius * radius) / q]; // 0: it touches the ball where it begins
  return { foot: add(center, l), discriminant, roots: roots.sort((a, c) => a - c) };
}

const times = ([a, b]: Interval, [c, d]: Interval): Interval => {
  const all = [a * c, a * d, b * c, b * d];
  return [Math.min(...all), Math.max(...all)];
};
const square = ([a, b]: Interval): Interval => (a <= 0 && b >= 0 ? [0, Math.max(a * a, b * b)] : a > 0 ? [a * a, b * b] : [b * b, a * a]);
const plus = (a: Interval, b: Interval): Interval => [a[0] + b[0], a[1] + b[1]];
const scaled = (s: number, [a, b]: Interval): Interval => (s < 0 ? [s * b, s * a] : [s * a, s * b]);

// Cassini's ovals: the product of the distances to (-c, 0) and (c, 0) is a². Two ovals, for a < c: a ray meets up to four walls.
const c2 = 1,
  a4 = 0.985 ** 4;
export const cassini = ([x, y]: Vec2): number => (x * x + y * y) ** 2 - 2 * c2 * (x * x - y * y) - (a4 - c2 * c2);
function cassiniBounds(x: Interval, y: Interval): Interval {
  const xx = square(x),
    yy = square(y);
  return plus(plus(square(plus(xx, yy)), scaled(-2 * c2, plus(xx, scaled(-1, yy)))), [c2 * c2 - a4, c2 * c2 - a4]);
}
/** Bounds of the surface function's derivative along the ray. */
function slopeBounds(x: Interval, y: Interval, d: Vec2): Interval {
  const sum = plus(square(x), square(y)),
    byX = plus(scaled(4, times(x, sum)), scaled(-4 * c2, x)),
    byY = plus(scaled(4, times(y, sum)), scaled(4 * c2, y));
  return plus(scaled(d[0], byX), scaled(d[1], byY));
}

export interface Stretch {
  from: number;
  to: number;
  verdict: "none" | "one" | "split";
}
/** Halves a ray until every stretch is proved to hold no root, or one alone, which is then found by halving. */
export function implicitRoots(origin: Vec2, direction: Vec2, from: number, to: number): { stretches: Stretch[]; roots: number[] } {
  const stretches: Stretch[] = [],
    roots: number[] = [],
    at = (t: number) => add(origin, direction, t);
  const search = (a: number, b: number, depth: number): void => {
    const span = (k: 0 | 1): Interval => {
      const p = at(a)[k],
        q = at(b)[k];
      return [Math.min(p, q), Math.max(p, q)];
    };
    const x = span(0),
      y = span(1),
      f = cassiniBounds(x, y),
      slope = slopeBounds(x, y, direction),
      holds = (i: Interval) => i[0] <= 0 && i[1] >= 0;
    if (!holds(f)) return void stretches.push({ from: a, to: b, verdict: "none" });
    if (!holds(slope) || depth > 40) {
      stretches.push({ from: a, to: b, verdict: "one" });
      let [low, high] = [a, b];
      if (cassini(at(low)) > 0 === cassini(at(high)) > 0) return; // its one root, if any, lies beyond
      for (let i = 0; i < 60; ++i) {
        const middle = (low + high) / 2;
        if (cassini(at(middle)) > 0 === cassini(at(low)) > 0) low = middle;
        else high = middle;
      }
      roots.push((low + high) / 2);
      return;
    }
    stretches.push({ from: a, to: b, verdict: "split" });
    search(a, (a + b) / 2, depth + 1);
    search((a + b) / 2, b, depth + 1);
  };
  search(from, to, 0);
  return { stretches, roots: roots.sort((a, b) => a - b) };
}

const window: FlatlandJson["window"] = [-3, 3, -1.5, 1.5];
const box = { low: [-0.9, -0.6] as Vec2, high: [0.9, 0.6] as Vec2 },
  ball = { center: [0.2, 0] as Vec2, radius: 0.9 };
const arc = (center: Vec2, radius: number): Vec2[] =>
  Array.from({ length: 121 }, (_, i) => add(center, [Math.cos((i * Math.PI) / 60), Math.sin((i * Math.PI) / 60)], radius));
const list = (roots: number[]): string => (roots.length === 0 ? say("none") : roots.map((t) => number(t, 4)).join(", "));

interface Drawn {
  elements: SVGElement[];
  words: string;
  numbers: Record<string, string>;
}

function drawBox(stage: Stage, o: Vec2, d: Vec2): Drawn {
  const intervals = ([0, 1] as const).map((k) => slab(o[k], d[k], box.low[k], box.high[k])),
    last = Math.max(...intervals.map((i) => i[0])),
    entry = Math.max(0, last),
    exit = Math.min(...intervals.map((i) => i[1])),
    overlaps = last <= exit,
    hit = overlaps && exit >= 0;
  const shown = (i: Interval): Vec2[] => [add(o, d, Math.min(Math.max(i[0], 0), 9)), add(o, d, Math.min(Math.max(i[1], 0), 9))],
    side: Vec2 = [-d[1], d[0]];
  const corners: Vec2[] = [box.low, [box.high[0], box.low[1]], box.high, [box.low[0], box.high[1]], box.low];
  const planes: Vec2[][] = [
    ...[box.low[0], box.high[0]].map((x): Vec2[] => [
      [x, -9],
      [x, 9],
    ]),
    ...[box.low[1], box.high[1]].map((y): Vec2[] => [
      [-9, y],
      [9, y],
    ]),
  ];
  return {
    elements: [
      stage.path("ghost", planes),
      stage.path("profile thin", [corners]),
      ...intervals.map((i, k) =>
        stage.path(k === 0 ? "slab x" : "slab y", i[0] <= i[1] ? [shown(i).map((p) => add(p, side, 0.05 + 0.06 * k))] : []),
      ),
      ...(hit ? [stage.circle("hit", add(o, d, entry), 8), stage.circle("hit far", add(o, d, exit), 6)] : []),
    ],
    words: say`In the slab of x for t in [${intervals[0]!.map((t) => number(t, 4)).join(", ")}] (violet), of y for t in [${intervals[1]!
      .map((t) => number(t, 4))
      .join(", ")}] (blue): the last entry ${number(last, 4)} is ${
      !overlaps
        ? say("after the first exit")
        : hit
          ? say("not after the first exit")
          : say("not after the first exit, which lies before the start")
    }, ${number(exit, 4)}: the ray ${hit ? say("hits") : say("misses")} the box.`,
    numbers: { entry: String(entry), exit: String(exit), hit: String(hit) },
  };
}

function drawSphere(stage: Stage, o: Vec2, d: Vec2): Drawn {
  const { foot, discriminant, roots } = sphereRoots(o, d, ball.center, ball.radius),
    ahead = roots.filter((t) => t > 0),
    check = meetCircle(o, d, ball);
  return {
    elements: [
      stage.path("profile thin", [arc(ball.center, ball.radius)]),
      stage.path("ghost", [[ball.center, foot]]),
      stage.circle("moved", foot, 7),
      stage.label("middle", add(foot, sub(ball.center, foot), 0.5), "l", -8),
      ...ahead.map((t, i) => stage.circle(i === 0 ? "hit" : "hit far", add(o, d, t), 8)),
    ],
    words: say`From the ray's foot to the centre |l| = ${number(
      Math.hypot(...sub(ball.center, foot)),
      4,
    )}, the radius is ${ball.radius}: Δ = r² − l·l = ${number(discriminant, 4)}${
      discriminant < 0 ? say(" < 0, the ray misses.") : say`, and t = ${list(roots)}.`
    }`,
    numbers: { discriminant: String(discriminant), roots: roots.join(" "), check: check ? check.join(" ") : "" },
  };
}

function drawImplicit(stage: Stage, o: Vec2, d: Vec2): Drawn {
  const { stretches, roots } = implicitRoots(o, d, 0, 8),
    side: Vec2 = [-d[1], d[0]],
    leaves = stretches.filter((s) => s.verdict !== "split"),
    empty = leaves.filter((s) => s.verdict === "none");
  const inner = Math.sqrt(c2 - Math.sqrt(a4)),
    outer = Math.sqrt(c2 + Math.sqrt(a4));
  const body = [-1, 1].map((sign) =>
    Array.from({ length: 241 }, (_, i): Vec2 => {
      // twice along x, once above and once below
      const turn = (i * Math.PI) / 120,
        x = 0.5 * (inner + outer) - 0.5 * (outer - inner) * Math.cos(turn),
        yy = Math.sqrt(4 * c2 * x * x + a4) - x * x - c2;
      return [sign * x, Math.sign(Math.sin(turn)) * Math.sqrt(Math.max(0, yy))];
    }),
  );
  const ticks = leaves.map((s): Vec2[] => [add(add(o, d, s.to), side, -0.05), add(add(o, d, s.to), side, 0.05)]);
  return {
    elements: [
      stage.path("profile thin", body),
      stage.path(
        "stretch none",
        empty.map((s) => [add(o, d, s.from), add(o, d, s.to)]),
      ),
      stage.path(
        "stretch one",
        leaves.filter((s) => s.verdict === "one").map((s) => [add(o, d, s.from), add(o, d, s.to)]),
      ),
      stage.path("normals", ticks),
      ...roots.map((t, i) => stage.circle(i === 0 ? "hit" : "hit far", add(o, d, t), 8)),
    ],
    words: say`${many(leaves.length, "stretch", "stretches")} after ${many(
      stretches.length - leaves.length,
      "halving",
      "halvings",
    )}: ${empty.length} ${
      empty.length === 1 ? say("is") : say("are")
    } proved to hold no root (grey), in the others (blue) there is at most one each. Roots: t = ${list(roots)}.`,
    numbers: { roots: roots.join(" "), stretches: String(leaves.length) },
  };
}

const plane = { point: [0.3, -0.2] as Vec2, normal: [-0.6, 0.8] as Vec2 };

function drawPlane(stage: Stage, o: Vec2, d: Vec2): Drawn {
  const { point: p, normal: n } = plane,
    across: Vec2 = [-n[1], n[0]],
    height = dot(n, sub(p, o)),
    slope = dot(n, d),
    t = height / slope,
    hit = slope !== 0 && t > 0;
  return {
    elements: [
      stage.path("profile", [[add(p, across, -9), add(p, across, 9)]]),
      stage.path("normals", [[p, add(p, n, 0.5)]]),
      stage.label("middle", add(p, n, 0.62), "n"),
      stage.path("ghost", [[o, add(o, n, height)]]),
      stage.circle("moved", p, 7),
      stage.label("middle", p, "p", 30),
      ...(hit ? [stage.circle("hit", add(o, d, t), 8)] : []),
    ],
    words: say`n·(p − o) = ${number(height, 4)}, how far the start is from the plane, and n·d = ${number(slope, 4)}, how fast the ray comes to it: ${
      slope === 0
        ? say("the ray is parallel and never comes.")
        : `t = ${number(t, 4)}${hit ? "." : say(" lies behind the start, the ray misses.")}`
    }`,
    numbers: { roots: hit ? String(t) : "" },
  };
}

// A body that is not convex; lab/lessons/intersection.cpp has the same corners.
const zigzag: Vec2[] = [
  [-1.6, -0.9],
  [1.6, -0.9],
  [1.6, 0.9],
  [0.9, 0.9],
  [0.9, -0.3],
  [0.3, -0.3],
  [0.3, 0.9],
  [-0.4, 0.9],
  [-0.4, -0.3],
  [-1, -0.3],
  [-1, 0.9],
  [-1.6, 0.9],
];

function drawParity(stage: Stage, o: Vec2, d: Vec2): Drawn {
  const walls = zigzag.map((from, i) => ({ from, to: zigzag[(i + 1) % zigzag.length]! }));
  // Half-open walls: a ray through a corner crosses one of the two that meet there, or both, or none, and is in or out as it should be.
  const crossings = walls
    .flatMap(({ from, to }) => {
      const a = cross(d, sub(from, o)),
        b = cross(d, sub(to, o));
      return a > 0 === b > 0 ? [] : [dot(d, add(from, sub(to, from), a / (a - b))) - dot(d, o)];
    })
    .filter((t) => t > 0)
    .sort((a, b) => a - b);
  const inside = crossings.length % 2 === 1;
  return {
    elements: [
      stage.path("profile thin", [[...zigzag, zigzag[0]!]]),
      ...crossings.map((t, i) => stage.label("middle", add(o, d, t - 0.13), String(i + 1), -14)),
      ...crossings.map((t) => stage.circle("hit", add(o, d, t), 8)),
    ],
    words: `${many(crossings.length, "crossing", "crossings")}: ${
      inside ? say("an odd number, the start lies inside.") : say("an even number, the start lies outside.")
    }`,
    numbers: { roots: crossings.join(" "), inside: String(inside) },
  };
}

const kinds: Record<string, (stage: Stage, o: Vec2, d: Vec2) => Drawn> = {
  box: drawBox,
  sphere: drawSphere,
  implicit: drawImplicit,
  plane: drawPlane,
  parity: drawParity,
};
const articles: Record<string, string> = {
  box: say("a box"),
  sphere: say("a sphere"),
  plane: say("a plane"),
  implicit: say("a surface given by a function"),
  parity: say("a body that is not convex"),
};
/** Rays that a test must bear, by the figure: start and aim. */
const cases: Record<string, [string, Vec2, Vec2][]> = {
  box: [
    [say("starts inside"), [0.2, 0.1], [2, 0.6]],
    [say("points away"), [1.6, 0.3], [2.6, 0.6]],
    [say("runs in a face"), [-2, 0.6], [2, 0.6]],
    [say("is parallel, outside"), [-2, 1], [2, 1]],
  ],
  plane: [
    [say("points away"), [-1, 0.9], [-2, 1.2]],
    [say("is parallel"), [-2, 0.25], [-1.2, 0.85]],
  ],
  parity: [
    [say("starts inside"), [-1.3, 0.4], [2.4, 0.5]],
    [say("starts in a notch"), [0.6, 0.3], [2.4, 0.5]],
    [say("passes a corner"), [-2.4, 0.9], [2.4, 0.9]],
  ],
};
const hints: Record<string, string> = {
  plane: say("Drag either end of the ray. Dotted: the way straight to the plane; violet: the plane's normal."),
  parity: say("Drag either end of the ray. Each crossing leads in or out."),
  box: say("Drag either end of the ray. Dotted: the planes of the two slabs."),
  sphere: say("Drag either end of the ray. Open circle: the point of the ray nearest to the centre."),
  implicit: say(
    "Drag either end of the ray. The surface is (x² + y²)² − 2(x² − y²) = a⁴ − 1 with a = 0.985, of which only the function and its derivative are computed, on intervals.",
  ),
};

function rayFigure(kind: string, id: string): HTMLElement {
  let o: Vec2 = [0, 0],
    aim: Vec2 = [0, 0];
  const stage = new Stage(
    window,
    say`A ray and ${articles[kind]!}`,
    (at, handle) => {
      sliders.set(`${handle}x`, at[0]);
      sliders.set(`${handle}y`, at[1]);
    },
    () => ({ a: aim, o }),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const slider = (name: string, k: 0 | 1, value: number) => ({
    name,
    from: window[2 * k]!,
    to: window[2 * k + 1]!,
    step: 0.005,
    value,
    text: (v: number) => number(v, 3),
    drags: true,
  });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      ox: slider(say("Start, left and right"), 0, -2.6),
      oy: slider(say("Start, up and down"), 1, 0.9),
      ax: slider(say("Aim, left and right"), 0, 1.6),
      ay: slider(say("Aim, up and down"), 1, kind === "implicit" ? -0.35 : -0.5),
    },
    () => show(),
  );
  const show = () => {
    [o, aim] = [
      [sliders.value("ox"), sliders.value("oy")],
      [sliders.value("ax"), sliders.value("ay")],
    ];
    const d = unit(Math.hypot(...sub(aim, o)) > 0 ? sub(aim, o) : [1, 0]),
      { elements, words, numbers } = kinds[kind]!(stage, o, d);
    stage.put(stage.path("ray thin", [[o, add(o, d, 9)]]), ...elements, stage.circle("point", o, 11), stage.circle("moved", aim, 9));
    Object.assign(said.dataset, { ox: String(o[0]), oy: String(o[1]), ax: String(aim[0]), ay: String(aim[1]), ...numbers });
    said.textContent = words;
  };
  show();
  const presets = (cases[kind] ?? []).map(([name, from, to]) => {
    const button = html("button", { type: "button" }, name);
    button.addEventListener("click", () => {
      for (const [key, value] of [
        ["ox", from[0]],
        ["oy", from[1]],
        ["ax", to[0]],
        ["ay", to[1]],
      ] as const)
        sliders.set(key, value);
    });
    return button;
  });
  if (presets.length > 0) sliders.bar.prepend(html("div", { class: "steps" }, say("A ray that"), ...presets));
  return frame(id, stage, sliders.bar, said, hints[kind]!);
}

export const intersectionFigure = ({ settings }: FigureJson, id: string): HTMLElement =>
  settings.show === "edge"
    ? edgeFigure(id, window)
    : settings.kind === "triangle"
      ? triangleFigure(id, settings.show === "both", window)
      : rayFigure(settings.kind!, id);
