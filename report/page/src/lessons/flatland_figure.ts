// Light dragged over a section of one of the program's scenes: the sun's map, what its test draws wrong, and the closed form
// where there is one; the shadow of a lamp with a size; a ball of flat faces with smooth normals.
import { percent, texelsText } from "../number_text";
import { html, number } from "../svg";
import type { FigureJson } from "./figures";
import {
  add,
  dot,
  length,
  lengthOf,
  outcomeAt,
  piecesOf,
  sub,
  SunMap,
  type Circle,
  type Outcome,
  type Place,
  type Segment,
  type Vec2,
  type World2,
} from "./flatland";
import { penumbraFigure } from "./penumbra_figure";
import { Sliders, Stage, type Slider } from "./stage";
import { terminatorFigure } from "./terminator_figure";
import { say } from "./say";

export interface FlatlandJson {
  segments: [number, number, number, number, number, number][];
  circles: [number, number, number][];
  scene: string;
  window: [number, number, number, number];
  light: { direction?: [number, number]; position?: [number, number]; radius: number };
}

export function world2({ segments, circles }: FlatlandJson): World2 {
  return {
    segments: segments.map(([ax, ay, bx, by, nx, ny]): Segment => ({ from: [ax, ay], to: [bx, by], normal: [nx, ny] })),
    circles: circles.map(([x, y, radius]): Circle => ({ center: [x, y], radius })),
  };
}

export const degrees = 180 / Math.PI;
/** The way in which light travels whose sun stands so many degrees to the right of the zenith. */
export const sunAt = (angle: number): Vec2 => [-Math.sin(angle / degrees), -Math.cos(angle / degrees)];
export const angleOf = ([x, y]: Vec2): number => Math.atan2(-x, -y) * degrees;

/** Pieces with what came out, drawn as runs of equal ones. */
export function runs(stage: Stage, pieces: Iterable<Place & { outcome: Outcome }>, half: (place: Place) => Vec2): SVGElement[] {
  const lines: Record<Outcome, Vec2[][]> = { lit: [], dark: [], away: [], missed: [], false: [] };
  let before: Place["surface"] | undefined, beforeOutcome: Outcome | undefined;
  for (const { surface, at, normal, outcome } of pieces) {
    const h = half({ surface, at, normal }),
      start = sub(at, h),
      end = add(at, h);
    if (before === surface && beforeOutcome === outcome) lines[outcome].at(-1)!.push(end);
    else lines[outcome].push([start, end]);
    [before, beforeOutcome] = [surface, outcome];
  }
  return (Object.keys(lines) as Outcome[]).map((outcome) => stage.path(`surface ${outcome}`, lines[outcome]));
}

/** The figure's frame: stage, sliders, what is measured, and a hint. */
export function frame(id: string, stage: Stage, bar: HTMLElement, said: HTMLElement, hint: string): HTMLElement {
  return html("div", { id }, stage.drawing as unknown as HTMLElement, bar, said, html("p", { class: "hint" }, hint));
}

export const rays = (stage: Stage, window: FlatlandJson["window"], light: Vec2): SVGElement => {
  const [left, right, bottom, top] = window,
    middle: Vec2 = [(left + right) / 2, (bottom + top) / 2],
    side: Vec2 = [-light[1], light[0]];
  const size = Math.hypot(right - left, top - bottom);
  return stage.path(
    "sun-ray",
    Array.from({ length: 15 }, (_, i) => {
      const through = add(middle, side, ((i - 7) / 14) * size);
      return [add(through, light, -size), add(through, light, size)];
    }),
  );
};

/** `middle`: round which it is dragged. */
export const sun = (
  stage: Stage,
  [left, right, bottom, top]: FlatlandJson["window"],
  light: Vec2,
  middle: Vec2 = [(left + right) / 2, Math.max(0, bottom)],
): SVGElement[] => {
  // On the way out of the window, just inside.
  const reach = Math.min(
    ...[
      [light[0], light[0] > 0 ? left : right, middle[0]],
      [light[1], light[1] > 0 ? bottom : top, middle[1]],
    ].map(([l, edge, from]) => (l === 0 ? Infinity : (edge! - from!) / -l!)),
  );
  return [stage.circle("sun", add(middle, light, -0.93 * reach), 16)];
};

const pieceUnits = 1.5; // length of a piece on the drawing, about

export function flatlandFigure({ settings, data }: FigureJson, id: string): HTMLElement {
  const json = data as FlatlandJson;
  if (settings.show === "penumbra") return penumbraFigure(json, id);
  if (settings.show === "terminator") return terminatorFigure(json, id);
  return shadowFigure(json, settings, id);
}

/** `settings` may say with which texels, bias and offset to begin. */
function shadowFigure(json: FlatlandJson, settings: Record<string, string>, id: string): HTMLElement {
  const world = world2(json),
    { window } = json,
    width = window[1] - window[0],
    name = settings.scene,
    leaks = name === "leak",
    stripes = settings.show === "stripes",
    back = settings.show === "back-faces",
    acne = stripes || settings.show === "acne";
  const first = (key: string, otherwise: number) => Number(settings[key] ?? otherwise);
  const surfaces: (Segment | Circle)[] = [...world.segments, ...world.circles];
  const corners = surfaces.flatMap((s): Vec2[] =>
    "radius" in s
      ? [
          [1, 0],
          [-1, 0],
          [0, 1],
          [0, -1],
        ].map((d) => add(s.center, d as unknown as Vec2, s.radius))
      : [s.from, s.to],
  );
  const start = first("angle", json.light.direction ? angleOf(json.light.direction) : 35);
  const stage = new Stage(
    window,
    say`A section of the scene ${json.scene}: its surfaces, the sun's depth map, and where the map is wrong`,
    (at) => {
      const angle = Math.atan2(at[0] - (window[0] + window[1]) / 2, at[1] - Math.max(0, window[2])) * degrees;
      sliders.set("angle", Math.min(Math.max(angle, -80), 80));
    },
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const mapOf = () => {
    const light = sunAt(sliders.value("angle")),
      unseen = { segments: world.segments.filter(({ normal }) => dot(normal, light) > 0), circles: [] };
    return new SunMap(back ? unseen : world, light, sliders.value("texels"), corners);
  };
  const own: Record<"angle" | "texels" | "bias", Slider> = {
    angle: {
      name: say("Sun, degrees from the zenith"),
      from: -80,
      to: 80,
      step: 0.5,
      value: start,
      text: (v) => `${number(v, 3)}°`,
      drags: true,
    },
    texels: { name: say("Texels of the map"), from: 4, to: 128, step: 1, value: first("texels", acne ? 14 : 40), text: (v) => String(v) },
    bias: {
      name: say("Bias, world units"),
      from: 0,
      to: Number((0.1 * width).toPrecision(2)),
      step: width / 4000,
      value: first("bias", name === "wall" ? 0.2 : 0),
      text: (v) => number(v, 3),
    },
  };
  const offsets: Slider = { name: say("Normal offset, texels"), from: 0, to: 8, step: 0.25, value: first("offset", 4), text: String };
  const sliders: Sliders<string> = new Sliders<string>(
    leaks ? { ...own, offset: offsets } : stripes ? { angle: own.angle, texels: own.texels } : own,
    () => show(),
  );
  const show = () => {
    const map = mapOf(),
      bias = stripes ? 0 : sliders.value("bias"),
      offset = leaks ? sliders.value("offset") : 0;
    const pieces = surfaces.flatMap((surface) => {
      const count = Math.max(1, Math.round(stage.units(lengthOf(surface)) / pieceUnits));
      return [...piecesOf(surface, count)].map((place) => ({
        ...place,
        length: lengthOf(surface) / count,
        outcome: outcomeAt(world, place, map, bias, offset),
      }));
    });
    const half = ({ surface, normal }: Place): Vec2 => {
      const count = Math.max(1, Math.round(stage.units(lengthOf(surface)) / pieceUnits)),
        h = lengthOf(surface) / count / 2;
      if ("radius" in surface) return [-normal[1] * h, normal[0] * h];
      const along = sub(surface.to, surface.from);
      return [(along[0] / length(along)) * h, (along[1] / length(along)) * h];
    };
    const held = map.depths.map((depth, k) => ({ depth, k })).filter(({ depth }) => isFinite(depth));
    const steps = (more: number) => held.map(({ depth, k }) => [map.point(k, depth + more), map.point(k + 1, depth + more)]);
    stage.put(
      rays(stage, window, map.light),
      ...runs(stage, pieces, half),
      ...(bias > 0 ? [stage.path("tested", steps(bias))] : []),
      stage.path("stored", steps(0)),
      ...sun(stage, window, map.light),
    );
    const sum = (outcome: Outcome) => pieces.reduce((total, piece) => total + (piece.outcome === outcome ? piece.length : 0), 0);
    const whole = sum("lit") + sum("dark") + sum("false") + sum("missed"),
      shares = { false: sum("false") / whole, missed: sum("missed") / whole };
    Object.assign(said.dataset, {
      angle: String(sliders.value("angle")),
      bias: String(bias),
      texels: String(map.count),
      texel: String(map.texel),
      falseShare: String(shares.false),
      missedShare: String(shares.missed),
    });
    // The first figure of a course: no word in it that a later lesson explains.
    said.textContent = stripes
      ? say`Nothing stands before the floor, and ${percent(shares.false)} of it is drawn dark (orange). A texel is ${number(map.texel, 2)} wide: one depth for all of it.`
      : say`Of what faces the sun ${percent(shares.false)} is in false shadow (orange), ${percent(shares.missed)} in missed shadow (blue). A texel is ${number(map.texel, 2)} wide, the bias ${texelsText(
          bias / map.texel,
        )}. ` + (acne ? acneForm(map, bias, shares.false, said) : name === "wall" ? wallForm(world, map, pieces, bias, back, said) : "");
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    stripes
      ? say("Drag the sun. Thick steps: the depths that the map stores. Gold: drawn lit.")
      : say`Drag the sun. Thick steps: the depths that the map stores${
          back ? say(", of the faces that the sun does not see") : ""
        }; dashed: with the bias. Gold: lit, rightly; dark: in shadow, rightly; dotted: turned away from the sun.`,
  );
}

/** On a plane the share in acne is (1 - bias / a) / 2, where the plane falls by a over half a texel. */
function acneForm(map: SunMap, bias: number, measured: number, said: HTMLElement): string {
  const a = (0.5 * map.texel * Math.abs(map.light[0])) / Math.abs(map.light[1]),
    formula = a > bias ? 0.5 * (1 - bias / a) : 0;
  said.dataset.formula = String(formula);
  return say`The formula ½·(1 − δ/a), with a = ${number(a, 3)} that the floor falls over half a texel, says ${percent(formula)}; here it is ${percent(measured)}.`;
}

/** Behind a wall of thickness w the shadow starts max(0, bias · sin θ − w) away from it; with the map of its back faces w is 0. */
function wallForm(
  world: World2,
  map: SunMap,
  pieces: (Place & { outcome: Outcome })[],
  bias: number,
  back: boolean,
  said: HTMLElement,
): string {
  const xs = world.segments.filter((s) => Math.max(s.from[1], s.to[1]) > 1e-6).flatMap((s) => [s.from[0], s.to[0]]),
    near = Math.min(...xs),
    beyond = Math.max(...xs);
  const side = map.light[0] < 0 ? -1 : 1,
    face = side < 0 ? near : beyond,
    formula = Math.max(0, bias * Math.abs(map.light[0]) - (back ? 0 : beyond - near));
  const drawn = pieces
    .filter((p) => p.normal[1] > 0.5 && p.at[1] < 1e-6 && side * (p.at[0] - face) > 0 && p.outcome === "dark")
    .map((p) => side * (p.at[0] - face));
  const measured = drawn.length > 0 ? Math.min(...drawn) : NaN;
  Object.assign(said.dataset, { formula: String(formula), measured: String(measured) });
  if (drawn.length === 0) return say("Behind the wall no shadow is drawn.");
  return say`The shadow starts ${number(measured, 2)} behind the wall; the formula ${back ? say("δ·sin θ") : say("max(0, δ·sin θ − w)")} says ${number(formula, 2)}, give or take a texel on the floor, ${number(
    map.texel / Math.max(Math.abs(map.light[1]), 1e-9),
    2,
  )}.`;
}
