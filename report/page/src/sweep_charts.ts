// A sweep's charts: error against time, and against the map's size. Each point leads to its cell.
import { chartFrame, ChartLabels, chartSvg, fixed, leastError, LogPlot, logTicks } from "./log_chart";
import { general, milliseconds, percent } from "./number_text";
import { settingWords, type RayPoint, type SweepCell, type SweepResult } from "./sweep_document";
import { markup, type Markup } from "./template";

const styles = 6; // line-0 ... in report.css

const cellPoint = (cell: SweepCell, kind: string, x: number, y: number, radius: number, title: string): Markup =>
  markup`<a href="#cell-${cell.cell}" aria-label="Cell ${cell.cell}, ${title}"><circle class="${kind}" cx="${fixed(x)}" cy="${fixed(y)}" r="${radius}"><title>${title}</title></circle></a>`;

/** The ray tracer as a point: its own ones, or one at the time that the cells' truth took. */
type Tracer = Pick<RayPoint, "name" | "compared" | "wrong" | "mean_absolute" | "times_ms">;
const tracersOf = ({ rays, cells: [first] }: SweepResult): Tracer[] =>
  rays.length > 0 || !(first!.rays_ms! > 0)
    ? rays
    : [{ name: "ray tracing", compared: 0, wrong: 0, mean_absolute: 0, times_ms: { median: first!.rays_ms! } }];
// In the sweep's measure. Exact shadows do not flip; what only pictures tell is 0 of the truth, and not known of other points.
function errorOf(tracer: Tracer, measure: string): number {
  const wrong = tracer.wrong / Math.max(tracer.compared, 1),
    mean = tracer.mean_absolute;
  return { wrong, mean, shimmer: 0, "wrong and mean": Math.max(wrong, mean) }[measure] ?? (Math.max(wrong, mean) === 0 ? 0 : NaN);
}

/** What tells a cell of the front from the others: its technique and map size, where the cells differ in them. */
function shortName(cell: SweepCell, cells: SweepCell[]): string {
  const differ = (key: "technique" | "map_size"): boolean => cells.some((other) => other[key] !== cells[0]![key]);
  return [differ("technique") && cell.technique, differ("map_size") && general(cell.map_size, 6)].filter(Boolean).join(" ");
}

/** Null where nothing is timed. */
export function paretoChart(result: SweepResult): Markup | null {
  const { cells, axes } = result,
    { name: measure, shares } = result.measure;
  const tracers = tracersOf(result).filter((tracer) => !Number.isNaN(errorOf(tracer, measure)));
  const front = result.front.map((number) => cells.find(({ cell }) => cell === number)!),
    timed = cells.filter(({ raster_ms }) => raster_ms !== null);
  if (front.length === 0) return null;
  const times = [...timed.map(({ raster_ms }) => raster_ms!), ...tracers.map(({ times_ms }) => times_ms.median)];
  const errors = [...cells.map(({ error }) => error), ...tracers.map((tracer) => errorOf(tracer, measure))],
    least = leastError(errors);
  const plot = new LogPlot(
    Math.min(...times) / 1.15,
    Math.max(...times) * 1.15,
    least,
    Math.max(4 * least, 1.3 * Math.max(...errors)),
    shares,
  );
  const at = (cell: SweepCell): [number, number] => [plot.x(cell.raster_ms!), plot.y(cell.error)];
  const labels = new ChartLabels();
  for (const tracer of tracers) labels.keepFree(plot.x(tracer.times_ms.median), plot.y(errorOf(tracer, measure)), 7);
  front.forEach((cell, k) => {
    labels.keepFree(...at(cell), 6);
    if (k > 0) labels.keepLineFree(...at(front[k - 1]!), ...at(cell));
  });
  const point = (cell: SweepCell): Markup =>
    cellPoint(
      cell,
      cell.front ? "dot best-dot" : "dot",
      ...at(cell),
      cell.front ? 5 : 3.5,
      `${settingWords(axes, cell)}: ${
        measure === "wrong and mean" ? "" : `${cell.error_words}, `
      }${percent(cell.wrong_fraction)} wrong, mean error ${percent(cell.mean_absolute)}, ${milliseconds(cell.raster_ms!)}`,
    );
  const diamond = (tracer: Tracer): Markup => {
    const error = errorOf(tracer, measure),
      x = plot.x(tracer.times_ms.median),
      y = plot.y(error);
    return markup`<path class="rays" d="M${fixed(x)},${fixed(y - 7)}l7,7l-7,7l-7,-7z"><title>${tracer.name}: ${error === 0 ? "none" : percent(error)} ${measure === "shimmer" ? "flip" : "wrong"}, ${milliseconds(
      tracer.times_ms.median,
    )}</title></path>${labels.place(x, y, tracer.name)}`;
  };
  return chartSvg(
    "Error against time, each cell a point, the best of them joined",
    markup`${chartFrame(
      plot,
      logTicks(plot.minX, plot.maxX),
      "milliseconds for map and shading",
    )}<polyline class="curve front" points="${front.map((cell) => at(cell).map(fixed).join(",")).join(" ")}"/>${timed.map(
      point,
    )}${tracers.map(diamond)}${front.map((cell) => shortName(cell, cells) && labels.place(...at(cell), shortName(cell, cells)))}`,
  );
}

/** By technique the best cell of each size, smallest first. */
function linesOf(cells: SweepCell[]): [string, SweepCell[]][] {
  const lines = new Map<string, Map<number, SweepCell>>();
  for (const cell of cells) {
    if (!lines.has(cell.technique)) lines.set(cell.technique, new Map());
    const line = lines.get(cell.technique)!,
      best = line.get(cell.map_size);
    if (!best || cell.error < best.error) line.set(cell.map_size, cell);
  }
  return [...lines]
    .sort(([a], [b]) => (a < b ? -1 : 1))
    .map(([name, line]) => [name, [...line.values()].sort((a, b) => a.map_size - b.map_size)]);
}

/** From the worst of the smallest maps on; nothing where all is right. */
function samplingSlope(plot: LogPlot, lines: [string, SweepCell[]][], first: number, last: number, labels: ChartLabels): Markup | null {
  const start = Math.max(0, ...lines.flatMap(([, line]) => line.filter(({ map_size }) => map_size === first).map(({ error }) => error)));
  if (!(start > 0)) return null;
  const lowest = Math.max((start * first) / last, plot.minY),
    size = (start * first) / lowest;
  const [x0, y0, x1, y1] = [plot.x(first), plot.y(start), plot.x(size), plot.y(lowest)] as const;
  labels.keepLineFree(x0, y0, x1, y1);
  return markup`<line class="used" x1="${fixed(x0)}" y1="${fixed(y0)}" x2="${fixed(x1)}" y2="${fixed(y1)}"/>${labels.place(
    plot.x(Math.sqrt(first * size)),
    plot.y(Math.sqrt(start * lowest)),
    "half at twice the size",
  )}`;
}

/** Null with fewer than three sizes. */
export function sizeChart({ cells, measure }: SweepResult): Markup | null {
  const lines = linesOf(cells),
    shown = lines.flatMap(([, line]) => line);
  const sizes = [...new Set(shown.map(({ map_size }) => map_size))].sort((a, b) => a - b),
    [first, last] = [sizes[0]!, sizes.at(-1)!];
  if (sizes.length < 3) return null;
  const errors = shown.map(({ error }) => error),
    least = leastError(errors),
    several = lines.length > 1;
  const plot = new LogPlot(first / 1.1, last * 1.1, least, Math.max(4 * least, 1.5 * Math.max(...errors)), measure.shares);
  const at = (cell: SweepCell): [number, number] => [plot.x(cell.map_size), plot.y(cell.error)],
    labels = new ChartLabels();
  for (const [, line] of lines)
    line.forEach((cell, k) => {
      labels.keepFree(...at(cell), 5);
      if (k > 0) labels.keepLineFree(...at(line[k - 1]!), ...at(cell));
    });
  const names = several ? lines.map(([name, line]) => labels.place(...at(line.at(-1)!), name)) : null;
  const drawing = (line: SweepCell[], stroke: string, fill: string): Markup =>
    markup`<polyline class="curve ${stroke}" points="${line.map((cell) => at(cell).map(fixed).join(",")).join(" ")}"/>${line.map((cell) =>
      cellPoint(cell, fill, ...at(cell), 4, `${cell.technique}, ${general(cell.map_size, 6)} texels: error ${cell.error_words}`),
    )}`;
  return chartSvg(
    "Least error against map size, a line for each technique",
    markup`${chartFrame(plot, sizes, "texels on a side")}${plot.shares && samplingSlope(plot, lines, first, last, labels)}${lines.map(
      ([, line], i) => (several ? drawing(line, `line-${i % styles}`, `line-${i % styles}`) : drawing(line, "front", "dot best-dot")),
    )}${names}`,
  );
}
