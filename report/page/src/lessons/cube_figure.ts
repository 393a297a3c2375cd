// A lamp's cube map in section: four of its six faces, each with a view of 90 degrees, and the texel that a point of the floor looks up.
import { html, number } from "../svg";
import { add, dot, firstDepth, length, occluded, sub, unit, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { frame, world2, type FlatlandJson } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

interface Face {
  name: string;
  axis: Vec2;
  across: Vec2;
}
const faces: Face[] = [
  { name: "+x", axis: [1, 0], across: [0, 1] },
  { name: "+y", axis: [0, 1], across: [-1, 0] },
  { name: "−x", axis: [-1, 0], across: [0, -1] },
  { name: "−y", axis: [0, -1], across: [1, 0] },
];

/** The face with the largest component, and the place on it in (0, 1). */
export function lookUp(d: Vec2): { face: Face; z: number; u: number } {
  const face = faces.reduce((a, b) => (dot(b.axis, d) > dot(a.axis, d) ? b : a)),
    z = dot(face.axis, d);
  return { face, z, u: 0.5 + (0.5 * dot(face.across, d)) / z };
}

export function cubeFigure({ data }: FigureJson, id: string): HTMLElement {
  const json = data as FlatlandJson,
    world = world2(json),
    { window } = json,
    [left, right, , top] = window,
    floor = world.segments[0]!;
  let lamp: Vec2 = [0, 0],
    target: Vec2 = [0, 0];
  const stage = new Stage(
    window,
    say("A lamp over a ball on a floor: the faces of its cube map, and the texel that a point looks up"),
    (at, handle) => {
      if (handle === "target") return sliders.set("x", at[0]);
      sliders.set("lampX", at[0]);
      sliders.set("lampY", at[1]);
    },
    () => ({ target, lamp }),
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const slider = (name: string, from: number, to: number, value: number) => ({
    name,
    from,
    to,
    step: 0.005,
    value,
    text: (v: number) => number(v, 3),
    drags: true,
  });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      x: slider(say("Point of the floor"), left, right, 1.6),
      texels: { name: say("Texels along a face"), from: 2, to: 32, step: 1, value: 8, text: String },
      lampX: slider(say("Lamp, left and right"), left, right, -0.9),
      lampY: slider(say("Lamp, up and down"), 0.2, top, 1.7),
    },
    () => show(),
  );
  const show = () => {
    lamp = [sliders.value("lampX"), sliders.value("lampY")];
    target = [sliders.value("x"), 0];
    const n = sliders.value("texels"),
      d = sub(target, lamp),
      { face, z, u } = lookUp(d),
      size = 2 * (right - left);
    const texel = Math.min(Math.floor(u * n), n - 1),
      through = (f: Face, place: number): Vec2 => unit(add(f.axis, f.across, 2 * place - 1));
    const edges = faces.flatMap((f): Vec2[][] => [[lamp, add(lamp, through(f, 0), size)]]);
    const steps: Vec2[][] = [],
      own: Vec2[][] = [];
    let stored = Infinity;
    for (const f of faces)
      for (let k = 0; k < n; ++k) {
        const way = through(f, (k + 0.5) / n),
          depth = firstDepth(world, lamp, way) * dot(way, f.axis); // along the face's axis
        if (depth < 0 || !isFinite(depth)) continue;
        const at = (place: number): Vec2 => add(add(lamp, f.axis, depth), f.across, depth * (2 * place - 1)),
          step = [at(k / n), at((k + 1) / n)];
        (f === face && k === texel ? own : steps).push(step);
        if (f === face && k === texel) stored = depth;
      }
    const wedge = [lamp, add(lamp, through(face, texel / n), size), add(lamp, through(face, (texel + 1) / n), size), lamp];
    const square = faces.map((f): Vec2[] => {
      const s = 0.16;
      return [add(add(lamp, f.axis, s), f.across, -s), add(add(lamp, f.axis, s), f.across, s)];
    });
    const lit = !occluded(world, { surface: floor, at: target, normal: [0, 1] }, unit(sub(lamp, target)), length(d)),
      drawn = !(z > stored + 1e-9);
    const outline = world.circles.map(({ center, radius }) =>
      Array.from({ length: 121 }, (_, i): Vec2 => add(center, [Math.cos((i * Math.PI) / 60), Math.sin((i * Math.PI) / 60)], radius)),
    );
    stage.put(
      stage.path("wedge", [wedge]),
      stage.path("sun-ray", edges),
      stage.path("profile", [...world.segments.map((s) => [s.from, s.to]), ...outline]),
      stage.path("stored", steps),
      stage.path("stored own", own),
      stage.path("ray", [[lamp, target]]),
      stage.path("normals", square),
      ...faces.map((f) => stage.label("middle", add(lamp, f.axis, 0.34), f.name, 6)),
      stage.circle("sun", lamp, 10),
      stage.circle("point", target, 10),
    );
    const wide = (2 * z) / n;
    Object.assign(said.dataset, {
      z: String(z),
      u: String(u),
      wide: String(wide),
      texel: String(texel),
      face: face.name,
      stored: String(stored),
    });
    said.textContent =
      say`From the lamp to the point d = (${number(d[0], 3)}, ${number(d[1], 3)}): its largest part is along ${face.name}, z = ${number(z, 3)}, so u = ½ + ½·(${number(
        dot(face.across, d),
        3,
      )})/z = ${number(u, 3)}, texel ${texel} of ${n}. ` +
      say`A texel is 2z/N = ${number(wide, 3)} wide there. It stores ${number(stored, 3)}: without a bias the point is drawn ${
        drawn ? say("lit") : say("in shadow")
      }; in truth it is ${lit ? say("lit") : say("in shadow")}.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say`Drag the lamp, or the point on the floor. The section of the scene ${json.scene} has four of the six faces; +z and −z look out of the page and into it. Thick steps: the depths stored in each face's texels; the widest is the one that is looked up.`,
  );
}
