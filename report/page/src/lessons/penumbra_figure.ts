// A lamp with a size over a disc over a floor, in section: umbra and penumbra, measured by rays and from the closed form.
import { html, number } from "../svg";
import { add, occluded, type Outcome, type Place, type Segment, type Vec2 } from "./flatland";
import { frame, world2, type FlatlandJson } from "./flatland_figure";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

const lampSamples = 33;

export function penumbraFigure(json: FlatlandJson, id: string): HTMLElement {
  const world = world2(json),
    { window } = json,
    [x0, y0] = json.light.position!;
  const floor = world.segments.find((s) => s.from[1] === s.to[1] && Math.abs(s.from[1]) < 1e-9)!,
    blockers = world.segments.filter((s) => s !== floor);
  const h = blockers[0]!.from[1],
    ends = blockers.flatMap((s) => [s.from[0], s.to[0]]),
    a = (Math.max(...ends) - Math.min(...ends)) / 2;
  const scene = { segments: blockers, circles: [] };
  const stage = new Stage(window, say("A lamp with a size over a disc over a floor: umbra and penumbra"), (at) => {
    sliders.set("x", Math.min(Math.max(at[0], -1.5), 1.5));
    sliders.set("height", Math.min(Math.max(at[1], 2), 4.4));
  });
  const said = html("p", { class: "bias-counts", role: "status" });
  const sliders: Sliders<"radius" | "x" | "height"> = new Sliders(
    {
      radius: { name: say("Radius of the lamp"), from: 0, to: 1, step: 0.02, value: json.light.radius, text: (v) => number(v, 2) },
      x: { name: say("Lamp, left and right"), from: -1.5, to: 1.5, step: 0.01, value: x0, text: (v) => number(v, 2), drags: true },
      height: { name: say("Height of the lamp"), from: 2, to: 4.4, step: 0.01, value: y0, text: (v) => number(v, 3), drags: true },
    },
    () => show(),
  );
  const place = (x: number): Place => ({ surface: floor, at: [x, 0], normal: [0, 1] });
  const show = () => {
    const R = sliders.value("radius"),
      lamp: Vec2 = [sliders.value("x"), sliders.value("height")],
      H = lamp[1];
    const samples = Array.from({ length: lampSamples }, (_, i): Vec2 => add(lamp, [1, 0], R * ((2 * i) / (lampSamples - 1) - 1)));
    const hidden = (x: number, from: Vec2): boolean => {
      const way: Vec2 = [from[0] - x, from[1]],
        reach = Math.hypot(...way);
      return occluded(scene, place(x), [way[0] / reach, way[1] / reach], reach);
    };
    const share = (x: number) => samples.filter((s) => hidden(x, s)).length / lampSamples;
    const [left, right] = window,
      count = 960,
      step = (right - left) / count,
      lines: Record<string, Vec2[][]> = { lit: [], half: [], dark: [] };
    for (let i = 0; i < count; ++i) {
      const x = left + (i + 0.5) * step,
        s = share(x),
        kind: string = s === 0 ? "lit" : s === 1 ? "dark" : "half";
      lines[kind]!.push([
        [x - step / 2, 0],
        [x + step / 2, 0],
      ]);
    }
    // From the middle of the shadow outwards: where the last lamp ray is hidden, and the first.
    const middle = -lamp[0] * (h / (H - h)),
      edge = (is: (x: number) => boolean): number => {
        let [inside, outside] = [middle, middle + 8];
        for (let i = 0; i < 50; ++i) {
          const x = (inside + outside) / 2;
          if (is(x)) inside = x;
          else outside = x;
        }
        return inside - middle;
      };
    const umbra = share(middle) === 1 ? edge((x) => samples.every((s) => hidden(x, s))) : 0,
      penumbra = edge((x) => samples.some((s) => hidden(x, s)));
    const formula = { umbra: Math.max(0, (a * H - R * h) / (H - h)), penumbra: (a * H + R * h) / (H - h) };
    const lampEnds: Vec2[] = [add(lamp, [-R, 0]), add(lamp, [R, 0])];
    const cone = lampEnds.flatMap((from) => [-a, a].map((x): Vec2[] => [from, [x + ((x - from[0]) * h) / (H - h), 0]]));
    // Of what there is, where it is in the drawing.
    const named: [string, number, boolean][] = [
      [say("umbra"), middle, umbra > 0],
      [say("penumbra"), middle + (umbra + penumbra) / 2, penumbra > umbra],
    ];
    const labels = named.flatMap(([words, x, is]) => (is && x > left && x < right ? [stage.label("middle", [x, 0], words, 34)] : []));
    stage.put(
      stage.path("sun-ray", cone),
      stage.path(
        "profile",
        blockers.map((s: Segment) => [s.from, s.to]),
      ),
      ...Object.entries(lines).map(([kind, all]) => stage.path(`surface ${kind as Outcome}`, all)),
      stage.path("lamp", [lampEnds]),
      stage.circle("sun", lamp, 9),
      ...labels,
    );
    Object.assign(said.dataset, {
      radius: String(R),
      umbra: String(umbra),
      penumbra: String(penumbra),
      umbraFormula: String(formula.umbra),
      penumbraFormula: String(formula.penumbra),
    });
    said.textContent = say`From the middle of the shadow the umbra reaches ${number(umbra, 4)}, the penumbra ${number(penumbra, 4)}. (aH − Rh)/(H − h) says ${number(formula.umbra, 4)}, (aH + Rh)/(H − h) ${number(
      formula.penumbra,
      4,
    )}: ${
      a * H > R * h
        ? say`the penumbra is 2Rh/(H − h) = ${number((2 * R * h) / (H - h), 3)} wide`
        : say("the lamp is so wide that there is no umbra")
    }.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say("Drag the lamp, and make it larger: gold is lit, grey sees part of the lamp, dark sees none of it."),
  );
}
