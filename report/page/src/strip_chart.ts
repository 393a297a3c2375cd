// V0 … V6 of one receiver over the frames, a row for each; a flip is marked on the row of the rung that made it.
import type { Moment } from "./film_frames";
import { svg } from "./svg";

export interface LabelJson {
  name: string;
  colour: string;
}

const names = ["V0 truth", "V1 point", "V2 texel", "V3 flat", "V4 stored", "V5 biased", "V6 drawn"];
const left = 92,
  right = 988,
  rowHeight = 34,
  top = 8,
  swing = 22;
const height = top + names.length * rowHeight + 28;

export const stripX = (frame: number, frames: number): number => left + ((right - left) * (frame + 0.5)) / frames;

/** A step line between shadow (low) and light (high), with gaps where the receiver is not compared. */
function line(moments: Moment[], row: number): string {
  const y = (v: number): number => top + row * rowHeight + swing + 4 - swing * v,
    width = (right - left) / moments.length;
  let path = "",
    pen = false;
  moments.forEach((moment, i) => {
    if (!moment.counted) {
      pen = false;
      return;
    }
    const at = y(moment.rungs[row]!).toFixed(1),
      x = left + i * width;
    path += `${pen ? `V${at}` : `M${x.toFixed(1)},${at}`}H${(x + width).toFixed(1)}`;
    pen = true;
  });
  return path;
}

export function stripChart(moments: Moment[], labels: LabelJson[], title: string): SVGElement {
  const chart = svg("svg", { class: "chart strip", viewBox: `0 0 1000 ${height}`, role: "img", "aria-label": title });
  names.forEach((name, row) => {
    const base = top + row * rowHeight + swing + 4;
    chart.append(
      svg("line", { class: "grid", x1: left, x2: right, y1: base, y2: base }),
      svg("text", { x: 4, y: base - 5 }, name),
      svg("path", { class: row === 0 ? "strip-line truth" : "strip-line", d: line(moments, row) }),
    );
  });
  moments.forEach((moment, i) => {
    if (moment.flip < 0) return;
    const row = Math.min(moment.flip + 1, names.length - 1),
      x = left + ((right - left) * i) / moments.length,
      label = labels[moment.flip]!;
    const mark = svg("circle", { cx: x, cy: top + row * rowHeight + 4 + swing / 2, r: 6, fill: label.colour, class: "strip-flip" });
    mark.append(svg("title", {}, `to frame ${i + 1}: flip by ${label.name}`));
    chart.append(mark);
  });
  for (let frame = 0; frame < moments.length; frame += Math.max(1, Math.round(moments.length / 12)))
    chart.append(svg("text", { class: "middle", x: stripX(frame, moments.length), y: height - 8 }, String(frame + 1)));
  chart.append(svg("line", { class: "now", x1: left, x2: left, y1: top, y2: height - 24 }));
  return chart;
}
