// Bars in table cells, stretched to the cell's width.
import { fixed } from "./log_chart";
import { markup, type Markup } from "./template";

/** What a step took away (to the left of zero) and what it added (to the right). */
export interface TwoSides {
  darker: number;
  lighter: number;
}

const pale = 0.35;

/** Pale what the step did, in full colour what is left of it in wrong pixels. `scale`: what reaches the cell's end. */
export function twoSidedBar(done: TwoSides, left: TwoSides, scale: number): Markup {
  const bar = (v: number, kind: "minus" | "plus", opacity: number): Markup => {
    const width = v > 0 ? Math.max((490 * v) / scale, 1.5) : 0;
    return markup`<rect class="${kind}" x="${fixed(
      kind === "minus" ? 500 - width : 500,
    )}" y="5" width="${fixed(width)}" height="14" opacity="${opacity}"/>`;
  };
  return markup`<svg class="bar" viewBox="0 0 1000 24" preserveAspectRatio="none" aria-hidden="true" focusable="false">${bar(done.darker, "minus", pale)}${bar(
    done.lighter,
    "plus",
    pale,
  )}${bar(left.darker, "minus", 1)}${bar(left.lighter, "plus", 1)}<line class="zero" x1="500" x2="500" y1="0" y2="24"/></svg>`;
}

export const shareBar = (share: number, kind: string): Markup =>
  markup`<svg class="bar" viewBox="0 0 1000 24" preserveAspectRatio="none" aria-hidden="true" focusable="false"><rect class="${kind}" x="0" y="7" width="${fixed(
    share > 0 ? Math.max(1000 * Math.min(share, 1), 1.5) : 0,
  )}" height="10"/></svg>`;
