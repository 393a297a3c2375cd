// One way of light from a lamp to an eye, by mirror and glass, and the same way followed backwards: the same points, the same share.
import { percent } from "../number_text";
import { html, number } from "../svg";
import { add, dot, length, sub, unit, type Vec2 } from "./flatland";
import { frame, world2 } from "./flatland_figure";
import type { FigureJson } from "./figures";
import { lineInside } from "./small_tree";
import { Sliders, Stage } from "./stage";
import { outlineOf } from "./structure_walk";
import { fresnel, Tracer2, type WhittedJson } from "./whitted_figure";
import { many, say } from "./say";

interface Way {
  points: Vec2[]; // the begin, each surface, the end
  share: number; // of the light that arrives
}
const mostSurfaces = 12;

/** Through glass, off a mirror, until the floor, so many surfaces, or the end of the outline that it is in. */
function follow(tracer: Tracer2, from: Vec2, direction: Vec2, inside: Vec2[]): Way {
  const points = [from];
  let [way, share] = [direction, 1];
  for (let i = 0; i < mostSurfaces; ++i) {
    const begin = points.at(-1)!,
      hit = tracer.meet(begin, way, true);
    points.push(hit?.at ?? add(begin, way, Math.max(lineInside(begin, way, inside)[1], 0.2)));
    if (!hit?.material) break;
    const { mirror, transmission, ior } = hit.material,
      within = dot(way, hit.normal) > 0,
      n: Vec2 = within ? [-hit.normal[0], -hit.normal[1]] : hit.normal;
    const c = -dot(way, n),
      ratio = within ? ior : 1 / ior,
      k = 1 - ratio * ratio * (1 - c * c);
    if (transmission > 0 && k >= 0) {
      share *= transmission * (1 - fresnel(c, ratio));
      way = unit(add([ratio * way[0], ratio * way[1]], n, ratio * c - Math.sqrt(k)));
    } else {
      share *= transmission > 0 ? 1 : mirror;
      way = add(way, n, 2 * c);
    }
  }
  return { points, share };
}

export function twoWaysFigure({ data }: FigureJson, id: string): HTMLElement {
  const json = data as WhittedJson,
    world = world2(json),
    { window } = json,
    [left, right, bottom, top] = window,
    edge = 0.2,
    inside = outlineOf([left + edge, right - edge, bottom + edge, top - edge]);
  let lamp: Vec2 = [left, 0],
    aim: Vec2 = [0, 0];
  const share = (at: number, low: number, high: number) => (at - low) / (high - low),
    end = (name: string, value: number) => ({ name, from: 0, to: 1, step: 0.001, value, text: (v: number) => number(v, 3), drags: true });
  const stage = new Stage(
    window,
    say("A way of light from a lamp by a glass and a mirror ball, followed from the lamp and from the eye"),
    (at, handle) => {
      sliders.set(`${handle}X`, share(at[0], left, right));
      sliders.set(`${handle}Y`, share(at[1], bottom, top));
    },
    () => ({ aim, lamp }),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      back: { name: say("Followed from"), from: 0, to: 1, step: 1, value: 0, text: (v) => (v === 0 ? say("the lamp") : say("the eye")) },
      lampX: end(say("Lamp, left and right"), 0.08),
      lampY: end(say("Lamp, up and down"), 0.75),
      aimX: end(say("Aim, left and right"), 0.36),
      aimY: end(say("Aim, up and down"), 0.3),
    },
    () => show(),
  );
  const show = () => {
    const point = (key: string): Vec2 => [
      left + sliders.value(`${key}X`) * (right - left),
      bottom + sliders.value(`${key}Y`) * (top - bottom),
    ];
    [lamp, aim] = [point("lamp"), point("aim")];
    const tracer = new Tracer2(json, world.segments, world.circles, lamp, 0),
      there = follow(tracer, lamp, unit(sub(aim, lamp)), inside),
      count = there.points.length;
    const eye = there.points.at(-1)!,
      back = follow(tracer, eye, unit(sub(there.points.at(-2)!, eye)), inside),
      reversed = back.points.slice(0, count - 1).reverse();
    // The way back runs on past the lamp: how far it passes from it, and how far its other points are off.
    const last = back.points[count - 2]!,
      before = unit(sub(back.points[count - 1]!, last)),
      toLamp = sub(lamp, last),
      passes = length(sub(toLamp, [before[0] * dot(toLamp, before), before[1] * dot(toLamp, before)]));
    const apart = Math.max(passes, ...reversed.map((p, i) => length(sub(p, there.points[i + 1]!)))),
      shown = sliders.value("back") === 0 ? there : back;
    stage.put(
      ...world.circles.map((ball) => stage.circle("disc", ball.center, stage.units(ball.radius))),
      stage.path(
        "profile thin",
        world.segments.map((s) => [s.from, s.to]),
      ),
      stage.path("ray", [shown.points.slice(0, count)]),
      ...there.points.slice(1, -1).map((p) => stage.circle("hit", p, 6)),
      stage.circle("point", lamp, 11),
      stage.label("middle", lamp, say("lamp"), -20),
      stage.circle("moved", aim, 9),
      stage.circle("moved", eye, 9),
      stage.label("middle", eye, say("eye"), -20),
    );
    Object.assign(said.dataset, {
      there: String(there.share),
      back: String(back.share),
      apart: String(apart),
      surfaces: String(count - 2),
    });
    said.textContent = say`From the lamp ${percent(there.share)} of the light comes by ${many(
      count - 2,
      "surface",
      "surfaces",
    )} to the eye. Followed backwards from the eye it is ${percent(back.share)}, by the same places: they are at most ${number(apart, 1)} apart.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say("Drag the lamp, or where its ray is aimed at. One ball is glass, the other a mirror; what glass reflects is left out."),
  );
}
