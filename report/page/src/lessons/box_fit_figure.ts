// A rod in a box that is turned: how close the box fits, in lines that meet it in vain, and what its test costs.
import { percent } from "../number_text";
import { html, number } from "../svg";
import { add, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { degrees, frame } from "./flatland_figure";
import { meetingLines, perimeter } from "./small_tree";
import { Sliders, Stage } from "./stage";
import { say } from "./say";

const window: [number, number, number, number] = [-3, 3, -1.5, 1.5];
const long = 2.4;
/** Multiplications of a slab test in space: two dot products and a product for each of three slabs, or the products alone. */
const turnedCost = 24,
  axisCost = 6;

/** A rectangle about the origin, turned by an angle in degrees. */
function turned(width: number, height: number, angle: number): Vec2[] {
  const along: Vec2 = [Math.cos(angle / degrees), Math.sin(angle / degrees)],
    across: Vec2 = [-along[1], along[0]];
  return [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ].map(([x, y]) => add(add([0, 0], along, (x! * width) / 2), across, (y! * height) / 2));
}

export function boxFitFigure(_: FigureJson, id: string): HTMLElement {
  const stage = new Stage(window, say("A rod, and a box around it that stands along the axes or is turned"), (at) =>
    sliders.set("rod", Math.min(Math.max(Math.atan2(at[1], at[0]) * degrees, -90), 90)),
  );
  const said = html("p", { class: "bias-counts", role: "status" }),
    angle = (name: string, value: number, drags = false) => ({
      name,
      from: -90,
      to: 90,
      step: 1,
      value,
      text: (v: number) => `${number(v, 3)}°`,
      drags,
    });
  const sliders: Sliders<"rod" | "box" | "width"> = new Sliders(
    {
      rod: angle(say("Rod turned by"), 35, true),
      box: angle(say("Box turned by"), 0),
      width: { name: say("Width of the rod"), from: 0.02, to: 1.5, step: 0.02, value: 0.2, text: (v) => number(v, 3) },
    },
    () => show(),
  );
  const show = () => {
    const [rodAngle, boxAngle, width] = [sliders.value("rod"), sliders.value("box"), sliders.value("width")],
      between = (rodAngle - boxAngle) / degrees,
      [c, s] = [Math.abs(Math.cos(between)), Math.abs(Math.sin(between))];
    const rod = turned(long, width, rodAngle),
      box = turned(long * c + width * s, long * s + width * c, boxAngle),
      formula = perimeter(rod) / perimeter(box),
      met = meetingLines(box, [rod], 90),
      cost = boxAngle % 90 === 0 ? axisCost : turnedCost;
    const closed = (outline: Vec2[]): Vec2[] => [...outline, outline[0]!];
    stage.put(stage.path("visited tests", [closed(rod)]), stage.path("cells bold", [closed(box)]));
    Object.assign(said.dataset, { formula: String(formula), measured: String(met), cost: String(cost) });
    said.textContent = say`The box costs ${cost} multiplications a ray. Of the lines that meet it ${percent(met)} meet the rod; perimeter over perimeter says ${percent(formula)}. Asked in vain: ${percent(1 - met)}.`;
  };
  show();
  return frame(
    id,
    stage,
    sliders.bar,
    said,
    say(
      "Drag the rod round. A box along the axes fits it badly where it leans; a box that leans with it fits, and costs four times as much.",
    ),
  );
}
