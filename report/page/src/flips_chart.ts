// Flips from frame to frame as a line, a dot for each step.
import { grouped, plainNumber } from "./number_text";
import { niceTicks } from "./svg";
import { markup, type Markup } from "./template";

const left = 70,
  right = 980,
  top = 16,
  bottom = 220; // of the plot, in the drawing's units

function ticks(most: number, steps: number, x: (step: number) => number, y: (value: number) => number): Markup {
  const frames = niceTicks(2, steps + 1, 8).filter(Number.isInteger); // counted from one
  return markup`${niceTicks(0, most, 4).map(
    (tick) => markup`<line class="grid" x1="${left}" x2="${right}" y1="${y(tick).toFixed(1)}" y2="${y(tick).toFixed(1)}"/><text
class="end" x="${left - 8}" y="${(y(tick) + 4).toFixed(1)}">${plainNumber(tick)}</text>`,
  )}${frames.map(
    (frame) => markup`<text
class="middle" x="${x(frame - 2).toFixed(1)}" y="${bottom + 18}">${frame}</text>`,
  )}<text class="middle" x="${(left + right) / 2}" y="${bottom + 36}">to frame</text>`;
}

/** `flips`: by step, the first of which leads to frame 2. */
export function flipsChart(flips: number[], name: string): Markup {
  const most = Math.max(1, ...flips);
  const x = (step: number) => left + (right - left) * (flips.length > 1 ? step / (flips.length - 1) : 0.5);
  const y = (value: number) => bottom - ((bottom - top) * value) / most;
  return markup`<svg class="chart flips-chart" viewBox="0 0 1000 264" role="img" aria-label="Flips from frame to frame of ${name}">${ticks(
    most,
    flips.length,
    x,
    y,
  )}<polyline
class="flips-line" points="${flips.map((count, i) => `${x(i).toFixed(1)},${y(count).toFixed(1)}`).join(" ")}"/>${flips.map(
    (count, i) => markup`<circle
class="dot" cx="${x(i).toFixed(1)}" cy="${y(count).toFixed(1)}" r="3"><title>to frame ${i + 2}: ${grouped(count)} flips</title></circle>`,
  )}<line
class="now" x1="${left}" x2="${left}" y1="${top}" y2="${bottom}"/></svg>`;
}
