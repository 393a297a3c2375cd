// Wrong pixels against the constant bias, from one render.
import { fixed } from "./log_chart";
import { general, percent, plainNumber } from "./number_text";
import type { BestBias, BiasPoint, LightResult } from "./report_document";
import { niceTicks } from "./svg";
import { markup, type Markup } from "./template";

/** What the chart shows of a light of result.json. */
export type BiasCurve = Pick<LightResult, "bias_curve" | "best_bias"> & {
  pixels: { compared: number };
  error: { wrong_fraction: number };
  map: { bias: { constant_world: number | null; texel_world: number | null } };
};

const width = 760,
  height = 340,
  left = 58,
  right = 152,
  top = 40,
  bottom = 56; // names of curves on the right
const plotRight = width - right,
  plotBottom = height - bottom;
const nothingWrong = 0.01; // the vertical axis's end where no bias makes a pixel wrong

/** Maps the chart's data to the drawing's units. */
class Scale {
  constructor(
    readonly from: number,
    readonly to: number,
    readonly most: number,
  ) {}
  x(v: number): number {
    return left + ((v - this.from) / (this.to - this.from)) * (plotRight - left);
  }
  y(v: number): number {
    return plotBottom - (v / this.most) * (plotBottom - top);
  }
  within(v: number): number {
    return this.x(Math.min(Math.max(v, this.from), this.to));
  }
}

const vertical = (x: number, kind: string): Markup =>
  markup`<line class="${kind}" x1="${fixed(x)}" x2="${fixed(x)}" y1="${top}" y2="${plotBottom}"/>`;
const label = (x: number, y: number, kind: string, text: string): Markup =>
  markup`<text class="${kind}" x="${fixed(x)}" y="${fixed(y)}">${text}</text>`;

// One row of ticks below the plot, in multiples of `unit` world units, its name at the right end.
function biasTicks(scale: Scale, unit: number, below: number, name: string): Markup {
  const y = plotBottom + below;
  return markup`${niceTicks(scale.from / unit, scale.to / unit, 6).map(
    (v) =>
      markup`<line class="mark" x1="${fixed(scale.x(v * unit))}" x2="${fixed(scale.x(v * unit))}" y1="${fixed(y - 15)}" y2="${fixed(
        y - 11,
      )}"/>${label(scale.x(v * unit), y, "tick middle", general(v, 3))}`,
  )}${label(plotRight + 26, y, "tick axis", name)}`;
}

const axes = (scale: Scale, texel: number): Markup =>
  markup`${niceTicks(0, scale.most, 4).map(
    (v) =>
      markup`<line class="grid" x1="${left}" x2="${plotRight}" y1="${fixed(scale.y(v))}" y2="${fixed(
        scale.y(v),
      )}"/>${label(left - 8, scale.y(v) + 4, "tick end", `${general(100 * v, 3)} %`)}`,
  )}${biasTicks(scale, 1, 20, "bias, world units")}${texel > 0 && biasTicks(scale, texel, 46, "bias, texels")}`;

type Curve = readonly [kind: string, name: string, share: (p: BiasPoint, compared: number) => number];
const curves: readonly Curve[] = [
  ["total", "all wrong", (p) => p.wrong_fraction],
  ["false", "false shadow", (p, compared) => p.false_shadow / compared],
  ["missed", "missed shadow", (p, compared) => p.missed_shadow / compared],
];

// Names at the curves' right ends, moved apart so that they do not overlap.
function curveNames(last: BiasPoint, scale: Scale, compared: number): Markup {
  const names = [curves[0]!, curves[2]!, curves[1]!]
    .map(([kind, name, share]) => ({ kind, name, y: scale.y(share(last, compared)) }))
    .sort((a, b) => a.y - b.y);
  for (let i = 1; i < names.length; ++i) names[i]!.y = Math.max(names[i]!.y, names[i - 1]!.y + 16);
  const excess = Math.max(0, names.at(-1)!.y - plotBottom);
  return markup`${names.map(({ kind, name, y }) => label(plotRight + 8, y - excess + 4, `name ${kind}`, name))}`;
}

// The interval of biases that make every compared pixel right, where there is one.
function feasibleInterval(best: BestBias, scale: Scale): Markup | null {
  if (!best.feasible) return null;
  const from = scale.within(best.needs_more_than ?? -Infinity),
    to = scale.within(best.needs_less_than ?? Infinity);
  return markup`<rect class="feasible" x="${fixed(from)}" y="${top}" width="${fixed(Math.max(1, to - from))}" height="${plotBottom - top}"/>${label(
    Math.min(Math.max((from + to) / 2, left + 60), plotRight - 60),
    top - 24,
    "note middle",
    "right everywhere",
  )}`;
}

function description({ best_bias: best, error, map }: BiasCurve): string {
  const used = map.bias.constant_world,
    said = `Best: ${plainNumber(best.constant_world!)}, ${percent(best.wrong_fraction!)} wrong.`;
  return used === null
    ? said
    : `Used: a bias of ${plainNumber(used)}, ${percent(error.wrong_fraction)} of the compared pixels wrong. ${said}`;
}

// Used and best bias as marks with their names above the plot, the right one's name to the right of its line.
function marks(best: number, used: number, scale: Scale): Markup {
  const at = scale.within(best),
    drawn = scale.within(used),
    isRight = at >= drawn;
  const note = (x: number, isRight: boolean, name: string): Markup =>
    label(x + (isRight ? 5 : -5), top - 7, isRight ? "note" : "note end", name);
  return markup`${vertical(at, "best")}${note(at, isRight, "best")}${
    Math.abs(at - drawn) >= 1 && markup`${vertical(drawn, "used")}${note(drawn, !isRight, "used")}`
  }`;
}

/** Wrong pixels against the constant bias: false shadow, missed shadow, and both with half of the ties; null where there is no curve. */
export function biasChart(light: BiasCurve, id: string): Markup | null {
  const {
      bias_curve: curve,
      best_bias: best,
      pixels: { compared },
      map: { bias },
    } = light,
    first = curve[0],
    last = curve.at(-1);
  if (!first || !last || curve.length < 2 || compared === 0 || !(last.bias > first.bias)) return null;
  const highest = Math.max(...curve.map((p) => p.wrong_fraction)),
    scale = new Scale(first.bias, last.bias, highest > 0 ? 1.05 * highest : nothingWrong);
  return markup`<svg class="chart" viewBox="0 0 ${width} ${height}" role="img" aria-labelledby="${id}-title ${id}-desc" data-left="${left}" data-right="${plotRight}" data-top="${top}" data-bottom="${
    plotBottom
  }" data-from="${scale.from}" data-to="${scale.to}"><title id="${id}-title">Wrong pixels at every constant bias</title><desc id="${id}-desc">${description(light)}</desc>${feasibleInterval(
    best,
    scale,
  )}${axes(scale, bias.texel_world ?? 0)}${curves.map(
    ([kind, , share]) =>
      markup`<polyline class="curve ${kind}" points="${curve
        .map((p) => `${fixed(scale.x(p.bias))},${fixed(scale.y(share(p, compared)))}`)
        .join(" ")}"/>`,
  )}${marks(best.constant_world!, bias.constant_world ?? best.constant_world!, scale)}${curveNames(last, scale, compared)}</svg>`;
}
