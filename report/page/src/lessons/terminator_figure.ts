// The shadow terminator: a ball of flat faces whose shading takes the ball's smooth normals. A face that is turned away is dark
// as a whole, though the smooth normal on part of it still faces the light.
import { html, number } from "../svg";
import {
  add,
  dot,
  occluded,
  piecesOf,
  polygon,
  sub,
  unit,
  type Circle,
  type Outcome,
  type Place,
  type Segment,
  type Vec2,
} from "./flatland";
import { angleOf, degrees, frame, rays, runs, sun, sunAt, world2, type FlatlandJson } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

const pieces = 60; // of each face

/** Degrees on one side between the first dark face and where the smooth normal turns away: at most 180 over the number of faces. `from`: the
    direction to the light, degrees; `way`: 1 or -1, round the ball. */
function lostAngle(sides: number, from: number, way: 1 | -1): number {
  const step = 360 / sides,
    lost = [];
  for (let i = 0; i < sides; ++i) {
    const middle = (((way * ((i + 0.5) * step - from)) % 360) + 360) % 360; // of the face, from the light
    if (middle >= 90 && middle < 180) lost.push(Math.max(0, 90 - (middle - step / 2)));
  }
  return Math.max(...lost, 0);
}

export function terminatorFigure(json: FlatlandJson, id: string): HTMLElement {
  const {
      circles: [ball],
      segments,
    } = world2(json) as { circles: [Circle]; segments: Segment[] },
    { window } = json;
  const stage = new Stage(window, say("A ball of flat faces under a sun: faces turned away, and smooth normals"), (at) =>
    sliders.set("angle", Math.atan2(at[0] - ball.center[0], at[1] - ball.center[1]) * degrees),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const start = json.light.position ? angleOf(unit(sub(ball.center, json.light.position))) : 35;
  const sliders: Sliders<"angle" | "sides"> = new Sliders(
    {
      angle: {
        name: say("Sun, degrees from the zenith"),
        from: -180,
        to: 180,
        step: 0.5,
        value: Math.round(2 * start) / 2,
        text: (v) => `${number(v, 4)}°`,
        drags: true,
      },
      sides: { name: say("Faces round the ball"), from: 5, to: 60, step: 1, value: 14, text: String },
    },
    () => show(),
  );
  const show = () => {
    const sides = sliders.value("sides"),
      light = sunAt(sliders.value("angle")),
      toLight: Vec2 = [-light[0], -light[1]],
      faces = polygon(ball, sides);
    const world = { segments: [...segments, ...faces], circles: [] },
      lost = { 1: 0, [-1]: 0 } as Record<number, number>,
      made: (Place & { outcome: Outcome })[] = [];
    for (const face of faces)
      for (const place of piecesOf(face, pieces)) {
        const normal = unit(sub(place.at, ball.center)),
          smooth = dot(normal, toLight) > 0; // along the smooth normal interpolated over a face of equal corners
        const turned = dot(face.normal, toLight) <= 0,
          outcome: Outcome = smooth && turned ? "false" : smooth && !occluded(world, place, toLight) ? "lit" : "dark";
        if (outcome === "false") lost[normal[0] * toLight[1] - normal[1] * toLight[0] > 0 ? 1 : -1]! += 360 / sides / pieces;
        made.push({ ...place, outcome });
      }
    const floor = segments.flatMap((s) =>
      [...piecesOf(s, 700)].map((place) => ({
        ...place,
        outcome: (dot(s.normal, toLight) <= 0 ? "away" : occluded(world, place, toLight) ? "dark" : "lit") as Outcome,
      })),
    );
    const half = ({ surface }: Place): Vec2 => {
      const { from, to } = surface as Segment,
        along = sub(to, from),
        count = faces.includes(surface as Segment) ? pieces : 700;
      return [along[0] / count / 2, along[1] / count / 2];
    };
    const r = ball.radius,
      arc = Array.from({ length: 181 }, (_, i): Vec2 => add(ball.center, [Math.cos((i * Math.PI) / 90), Math.sin((i * Math.PI) / 90)], r));
    const normals = faces.flatMap(
      (f) =>
        [
          [f.from, add(f.from, f.smooth![0], 0.22 * r)],
          [add(f.from, sub(f.to, f.from), 0.5), add(add(f.from, sub(f.to, f.from), 0.5), f.normal, 0.14 * r)],
        ] as Vec2[][],
    );
    const edge: Vec2 = [-light[1], light[0]];
    stage.put(
      rays(stage, window, light),
      stage.path("ghost", [arc]),
      stage.path("normals", normals),
      stage.path("ghost", [[add(ball.center, edge, -1.3 * r), add(ball.center, edge, 1.3 * r)]]),
      ...runs(stage, [...floor, ...made], half),
      ...sun(stage, window, light, ball.center),
    );
    const from = Math.atan2(toLight[1], toLight[0]) * degrees,
      formula = { left: lostAngle(sides, from, -1), right: lostAngle(sides, from, 1) };
    Object.assign(said.dataset, {
      sides: String(sides),
      angle: String(sliders.value("angle")),
      lostRight: String(lost[-1]),
      lostLeft: String(lost[1]),
      formulaRight: String(formula.right),
      formulaLeft: String(formula.left),
    });
    said.textContent =
      say`Orange: the smooth normal faces the sun, the face does not, and stands in its own shadow: ${number(lost[-1]!, 2)}° on one side and ${number(lost[1]!, 2)}° on the other; by the angles of the faces ${number(
        formula.right,
        2,
      )}° and ${number(formula.left, 2)}°. ` + say`It is never more than half a face, 180°/${sides} = ${number(180 / sides, 3)}°.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say(
      "Drag the sun round the ball, or give the ball more faces. Ticks at the corners: the ball's own normals; in the middle of faces: the faces' normals. The thin line parts what the smooth ball has in light from what it has in shadow.",
    ),
  );
}
