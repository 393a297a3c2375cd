// Drag the bias: the picture with what it draws wrong, counted from the gaps as on the report's page, and one pixel in light
// space.
import { BiasPanel } from "../bias";
import { biasChart, type BiasCurve } from "../bias_chart";
import { Light, type Pixel } from "../data";
import { examplePixel } from "../example_pixel";
import { html } from "../svg";
import { texelDrawing } from "../texel_drawing";
import { story } from "../words";
import type { FigureJson } from "./figures";
import { say } from "./say";

interface BiasJson {
  comparison: string;
  light: BiasCurve;
}

export async function biasFigure({ data }: FigureJson, id: string): Promise<HTMLElement> {
  const { comparison, light: result } = data as BiasJson,
    light = await Light.load(0, comparison);
  const curve = html("div", { class: "scroll", role: "region", tabindex: "0", "aria-label": say`Wrong pixels at every bias, ${id}` });
  curve.innerHTML = biasChart(result, `${id}-chart`)!.text;
  const drawing = html("div", { class: "live-drawing" }),
    words = html("p", { class: "story" }),
    figure = html("div", {}, curve);
  let bias = light.json.bias.constant,
    shown: Pixel = examplePixel(light),
    frame = 0;
  const update = () => {
    panel.show(bias);
    panel.mark(shown.x, shown.y);
    words.textContent = story(light, shown, bias);
    drawing.replaceChildren(...(shown.seen ? [texelDrawing(light, shown, bias, `${id}-texel`)] : []));
  };
  const later = () => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      update();
    });
  };
  const panel = BiasPanel.of(
    light,
    curve.querySelector("svg")!,
    result.best_bias.constant_world!,
    (b) => {
      bias = b;
      later();
    },
    (x, y) => {
      shown = light.pixel(x, y);
      later();
    },
  )!;
  figure.replaceChildren(
    panel.bar,
    panel.said,
    html("div", { class: "live-pair" }, panel.picture, drawing),
    words,
    curve,
    html(
      "p",
      { class: "hint" },
      say(
        "Drag the bias, or the line in the chart; click a pixel to see it in light space. Orange: false shadow. Light blue: missed shadow.",
      ),
    ),
  );
  update();
  return figure;
}
