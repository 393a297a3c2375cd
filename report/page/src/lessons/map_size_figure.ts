// Choose the map's size: the same scene drawn by the program with each of them.
import { Light, page } from "../data";
import { backdropOf, recolour } from "../pictures";
import { grouped, percent } from "../number_text";
import { html, niceTicks, number, svg } from "../svg";
import type { FigureJson } from "./figures";
import { many, say } from "./say";

interface SizeJson {
  size: number; // texels
  wrong_fraction: number;
  texel_world: number;
}
interface MapSizeJson {
  comparison: string;
  sizes: SizeJson[];
}

const width = 420,
  height = 260,
  left = 64,
  right = 22,
  top = 16,
  bottom = 48;

/** Wrong pixels against the map's size, both logarithmic, with the line that an error of sampling alone falls along. */
function chart(sizes: SizeJson[], shown: number): SVGElement {
  const shares = sizes.map((s) => Math.max(s.wrong_fraction, 1e-6)),
    first = sizes[0]!.size,
    last = sizes.at(-1)!.size;
  const high = Math.log10(Math.max(...shares)) + 0.1,
    low = Math.min(Math.log10(Math.min(...shares)), high - 1) - 0.1;
  const x = (size: number) => left + (Math.log2(size / first) / Math.max(1, Math.log2(last / first))) * (width - left - right);
  const y = (share: number) => top + ((high - Math.log10(share)) / (high - low)) * (height - top - bottom);
  const drawing = svg("svg", {
    class: "chart live-chart",
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": say("Wrong pixels against the map's size, both on logarithmic axes"),
  });
  for (const power of niceTicks(low, high, 4)) {
    if (!Number.isInteger(power)) continue;
    drawing.append(
      svg("line", { class: "grid", x1: left, x2: width - right, y1: y(10 ** power), y2: y(10 ** power) }),
      svg("text", { class: "end", x: left - 6, y: y(10 ** power) + 4 }, `${number(100 * 10 ** power)} %`),
    );
  }
  for (const s of sizes) drawing.append(svg("text", { class: "middle", x: x(s.size), y: height - bottom + 18 }, String(s.size)));
  const end = shares[0]! * (first / last);
  drawing.append(
    svg("line", { class: "used", x1: x(first), y1: y(shares[0]!), x2: x(last), y2: Math.min(y(end), height - bottom) }),
    svg("polyline", { class: "curve total", points: sizes.map((s, i) => `${x(s.size)},${y(shares[i]!)}`).join(" ") }),
    ...sizes.map((s, i) =>
      svg("circle", { class: i === shown ? "dot best-dot" : "dot", cx: x(s.size), cy: y(shares[i]!), r: i === shown ? 8 : 5 }),
    ),
    svg("text", { class: "middle", x: (left + width - right) / 2, y: height - 8 }, say("texels along one side of the map")),
  );
  return drawing;
}

export async function mapSizeFigure({ data }: FigureJson, id: string): Promise<HTMLElement> {
  const { comparison, sizes } = data as MapSizeJson,
    lights = await Promise.all(sizes.map((_, i) => Light.load(i, comparison)));
  const canvas = html("canvas", { role: "img", width: String(page.width), height: String(page.height) });
  const range = html("input", { type: "range", min: "0", max: String(sizes.length - 1), step: "1", value: "0" });
  const said = html("p", { class: "bias-counts", role: "status" }),
    charts = html("div", { class: "live-drawing" });
  const image = new ImageData(page.width, page.height),
    backdrop = backdropOf(lights[0]!.pixels);
  const show = () => {
    const i = Number(range.value),
      light = lights[i]!,
      { size, texel_world: texel } = sizes[i]!;
    const { falseShadow, missedShadow } = recolour(light, light.json.bias.constant, backdrop, new Uint32Array(image.data.buffer));
    const compared = light.label.reduce((sum, label) => sum + (label >= 0 ? 1 : 0), 0);
    canvas.getContext("2d")!.putImageData(image, 0, 0);
    range.setAttribute("aria-valuetext", say`${size} texels`);
    Object.assign(said.dataset, { falseShadow: String(falseShadow), missedShadow: String(missedShadow), size: String(size) });
    said.textContent =
      say`A map of ${size} × ${size} texels, each ${number(texel, 2)} wide: ${percent(
        (falseShadow + missedShadow) / Math.max(1, compared),
      )} of the compared pixels are wrong, ` +
      say`${many(falseShadow, "pixel", "pixels")} in false shadow, ${grouped(missedShadow)} in missed shadow.`;
    canvas.setAttribute("aria-label", say`The picture with what is wrong at this size. ${said.textContent}`);
    charts.replaceChildren(chart(sizes, i) as unknown as Node);
  };
  range.addEventListener("input", show);
  show();
  return html(
    "div",
    { id },
    html("div", { class: "bias-bar" }, html("label", {}, say("Map size "), range)),
    said,
    html("div", { class: "live-pair" }, html("div", { class: "live-picture" }, canvas), charts),
    html(
      "p",
      { class: "hint" },
      say(
        "Orange: false shadow. Light blue: missed shadow. Each size was drawn by the program. Dotted in the chart: half the error for half the texel.",
      ),
    ),
  );
}
