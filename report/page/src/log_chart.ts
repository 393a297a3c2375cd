// Charts of errors on two logarithmic scales, which the sweep's and the tuner's pages share. An error of none stands on
// the lowest line, named "none".
import { general, plainNumber } from "./number_text";
import { markup, type Markup } from "./template";

export const fixed = (value: number): string => value.toFixed(1);

/** Where values stand, in the drawing's units. */
export class LogPlot {
  static readonly width = 760;
  static readonly height = 380;
  static readonly left = 84;
  static readonly right = 24;
  static readonly top = 24;
  static readonly bottom = 52;

  /** `shares`: values along y are shares, written in per cent; else plain numbers. */
  constructor(
    readonly minX: number,
    readonly maxX: number,
    readonly minY: number,
    readonly maxY: number,
    readonly shares: boolean,
  ) {}

  x(v: number): number {
    return LogPlot.left + (Math.log(v / this.minX) / Math.log(this.maxX / this.minX)) * (LogPlot.width - LogPlot.left - LogPlot.right);
  }
  /** Values below minY stand on it. */
  y(v: number): number {
    const share = Math.log(Math.max(v, this.minY) / this.minY) / Math.log(this.maxY / this.minY);
    return LogPlot.height - LogPlot.bottom - share * (LogPlot.height - LogPlot.top - LogPlot.bottom);
  }
}

export const chartText = (x: number, y: number, kind: string, content: string): Markup =>
  markup`<text class="${kind}" x="${fixed(x)}" y="${fixed(y)}">${content}</text>`;

type Box = readonly [x0: number, y0: number, x1: number, y1: number];
const glyph = 7.2,
  ascent = 11,
  descent = 4,
  gap = 13; // of text of 13 pixels, and from it to the point
// Where a name may stand beside its point; the last number: where the text begins, in its lengths left of its anchor.
const places = [
  ["middle", 0, -gap, 0.5],
  ["middle", 0, 1.8 * gap, 0.5],
  ["start", gap, 4, 0],
  ["end", -gap, 4, 1],
  ["start", gap, -gap, 0],
  ["end", -gap, -gap, 1],
  ["start", gap, 2 * gap, 0],
  ["end", -gap, 2 * gap, 1],
] as const;

/** Names beside points: each takes the first place around its point where it covers no other. */
export class ChartLabels {
  private readonly taken: Box[] = [];
  private readonly names: string[] = [];

  /** Room that names keep off: of `reach` around a point. */
  keepFree(x: number, y: number, reach: number): void {
    this.taken.push([x - reach, y - reach, x + reach, y + reach]);
  }

  /** A straight line that names keep off. */
  keepLineFree(x0: number, y0: number, x1: number, y1: number): void {
    const steps = Math.floor(Math.hypot(x1 - x0, y1 - y0) / 6) + 1;
    for (let i = 0; i <= steps; ++i) this.keepFree(x0 + ((x1 - x0) * i) / steps, y0 + ((y1 - y0) * i) / steps, 2);
  }

  /** Nothing where there is no room, or where the same name stands already. */
  place(x: number, y: number, name: string): Markup | null {
    if (this.names.includes(name)) return null;
    const length = glyph * name.length;
    for (const [anchor, dx, dy, from] of places) {
      const start = x + dx - from * length,
        base = y + dy,
        box: Box = [start, base - ascent, start + length, base + descent];
      const inside = box[0] >= LogPlot.left && box[2] <= LogPlot.width && box[1] >= 0 && box[3] <= LogPlot.height - LogPlot.bottom + 10;
      if (!inside || this.taken.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3])) continue;
      this.taken.push(box);
      this.names.push(name);
      return chartText(x + dx, base, `note ${anchor}`, name);
    }
    return null;
  }
}

/** 1, 2 and 5 times the powers of ten inside; powers alone when the range is long, more when it is short. */
export function logTicks(min: number, max: number): number[] {
  const at = (digits: number[]): number[] => {
    const ticks = [];
    for (let exponent = Math.floor(Math.log10(min)); 10 ** exponent <= max; ++exponent)
      ticks.push(...digits.map((digit) => digit * 10 ** exponent).filter((v) => v >= min && v <= max));
    return ticks;
  };
  if (max / min > 300) return at([1]);
  const few = [
    [1, 2, 5],
    [1, 1.5, 2, 3, 4, 5, 6, 8],
  ]
    .map(at)
    .find((ticks) => ticks.length >= 3);
  return few ?? at([1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7, 7.5, 8, 8.5, 9, 9.5]);
}

/** What the scale takes for none: well below the least error that there is. */
export function leastError(shares: number[]): number {
  const least = Math.min(1, ...shares.filter((share) => share > 0).map((share) => share / 4));
  return least < 1 ? least : 0.001;
}

/** Lines and ticks; `unitX` names the horizontal axis. */
export function chartFrame(plot: LogPlot, ticksX: number[], unitX: string): Markup {
  const { left, height } = LogPlot,
    right = LogPlot.width - LogPlot.right,
    floor = height - LogPlot.bottom;
  const across = logTicks(plot.minY * 1.6, plot.maxY); // above the word at the bottom
  return markup`${across.map(
    (v) =>
      markup`<line class="grid" x1="${left}" x2="${right}" y1="${fixed(plot.y(v))}" y2="${fixed(plot.y(v))}"/>${chartText(
        left - 8,
        plot.y(v) + 4,
        "tick end",
        plot.shares ? `${general(100 * v, 3)} %` : plainNumber(v),
      )}`,
  )}${chartText(left - 8, plot.y(plot.minY) + 4, "tick end", "none")}${ticksX.map(
    (v) =>
      markup`<line class="mark" x1="${fixed(plot.x(v))}" x2="${fixed(plot.x(v))}" y1="${floor + 4}" y2="${floor + 9}"/>${chartText(
        plot.x(v),
        floor + 24,
        "tick middle",
        plainNumber(v),
      )}`,
  )}${chartText(right, height - 8, "tick end", unitX)}`;
}

export const chartSvg = (title: string, content: Markup): Markup =>
  markup`<svg class="chart" viewBox="0 0 ${LogPlot.width} ${LogPlot.height}" role="group" aria-label="${title}">${content}</svg>\n`;
