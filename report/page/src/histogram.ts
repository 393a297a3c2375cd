// How the gaps are spread: of the truly lit pixels upwards, of the truly shadowed ones downwards. A bias is right for
// the lit pixels on its left and for the shadowed ones on its right; where the two overlap no bias can be right.
import type { Light } from "./data";
import { counted, grouped } from "./number_text";
import { html, niceTicks, number, svg } from "./svg";

const width = 760,
  height = 260,
  left = 58,
  right = 14,
  top = 26,
  bottom = 40,
  bins = 120;

interface Bins {
  lit: number[];
  dark: number[];
  beyond: number; // gaps above the last bin
  before: number; // below the first, those of -infinity (nothing stored) among them
}

function sorted(light: Light, limit: number): Bins {
  const out: Bins = { lit: new Array<number>(bins).fill(0), dark: new Array<number>(bins).fill(0), beyond: 0, before: 0 };
  light.gap.forEach((gap, i) => {
    if (light.label[i]! < 0 || light.halfLit(i)) return;
    const bin = Math.floor(((gap + limit) / (2 * limit)) * bins);
    if (bin >= bins) ++out.beyond;
    else if (!(bin >= 0)) ++out.before;
    else ++(light.lit(i) ? out.lit : out.dark)[bin]!;
  });
  return out;
}

export class GapHistogram {
  readonly figure: HTMLElement;
  private readonly line = svg("line", { class: "chosen", y1: top, y2: height - bottom });

  constructor(
    light: Light,
    private readonly limit: number,
    name: string,
  ) {
    const counts = sorted(light, limit),
      most = Math.max(1, ...counts.lit, ...counts.dark);
    const middle = (top + height - bottom) / 2,
      half = (height - top - bottom) / 2;
    // Logarithmic, so that the few pixels that decide can be seen beside the many.
    const size = (count: number) => (count === 0 ? 0 : (half * Math.log1p(count)) / Math.log1p(most));
    const drawing = svg("svg", {
      class: "chart histogram",
      viewBox: `0 0 ${width} ${height}`,
      role: "img",
      "aria-label": `Histogram of the gaps of ${name}: lit pixels above, shadowed pixels below the line`,
    });
    const w = (width - left - right) / bins;
    for (let i = 0; i < bins; ++i) {
      const up = size(counts.lit[i]!),
        down = size(counts.dark[i]!),
        x = left + i * w;
      if (up > 0) drawing.append(svg("rect", { class: "gap-lit", x, y: middle - up, width: w, height: up }));
      if (down > 0) drawing.append(svg("rect", { class: "gap-dark", x, y: middle, width: w, height: down }));
    }
    drawing.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: middle, y2: middle }));
    for (const gap of niceTicks(-limit, limit, 8))
      drawing.append(svg("text", { class: "middle", x: this.x(gap), y: height - bottom + 18 }, number(gap)));
    drawing.append(
      svg("text", { class: "middle", x: (left + width - right) / 2, y: height - 4 }, "gap, world units"),
      svg("text", { class: "end", x: left - 8, y: middle - half / 2 }, "lit"),
      svg("text", { class: "end", x: left - 8, y: middle + half / 2 }, "shadow"),
      this.line,
    );
    this.figure = html(
      "figure",
      {},
      html(
        "div",
        { class: "scroll", role: "region", tabindex: "0", "aria-label": `Histogram of the gaps, ${light.json.name}` },
        drawing as unknown as Node,
      ),
      html(
        "figcaption",
        {},
        `Gaps of the truly lit pixels above, of the truly shadowed ones below, on a logarithmic scale up to ${counted(most, "pixel")}. ` +
          `The line is the bias: lit pixels to its right are drawn dark, shadowed ones to its left are drawn lit. ` +
          `Not shown: ${counted(counts.beyond, "pixel")} farther right, ${grouped(counts.before)} farther left or with nothing stored.`,
      ),
    );
  }

  private x(gap: number): number {
    return left + ((gap + this.limit) / (2 * this.limit)) * (width - left - right);
  }

  show(bias: number): void {
    const x = this.x(Math.min(Math.max(bias, -this.limit), this.limit));
    this.line.setAttribute("x1", String(x));
    this.line.setAttribute("x2", String(x));
  }
}
