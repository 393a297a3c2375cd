// HTML from templates: what is put into one is escaped unless it is markup itself.

/** HTML that may stand in a page as it is. */
export class Markup {
  constructor(readonly text: string) {}
}

type Content = Markup | string | number | null | undefined | false | readonly Content[];

const entities: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };

/** Text for elements and for attributes in quotes; control characters become spaces. */
const escaped = (text: string): string => text.replace(/[\u0000-\u001f\u007f]/g, " ").replace(/[&<>"']/g, (c) => entities[c]!);

function textOf(content: Content): string {
  if (content instanceof Markup) return content.text;
  if (Array.isArray(content)) return content.map(textOf).join("");
  return content === null || content === undefined || content === false ? "" : escaped(String(content));
}

/** markup`<p>${text}</p>`; null, undefined and false leave nothing, a list stands one by one. */
export const markup = (parts: TemplateStringsArray, ...contents: Content[]): Markup =>
  new Markup(parts.map((part, i) => part + (i < contents.length ? textOf(contents[i]) : "")).join(""));

/** Text whose numbers stay with the word behind them ("4.1 %" and "8 × 8" do not break), and whose options stay whole: a
    browser breaks lines at hyphens, also at those of "--adaptive-bias". */
export const flowing = (text: string): Markup =>
  new Markup(
    escaped(text.replace(/(?<=\d|×) /g, "\u00a0")).replace(/--[a-z][a-z0-9-]*/g, (option) => `<span class="option">${option}</span>`),
  );

/** A block that scrolls sideways where the page is narrow, by keyboard too; `label` must be unique on the page. */
export const scrollRegion = (label: string, content: Markup): Markup =>
  markup`<div class="scroll" role="region" tabindex="0" aria-label="${label}">${content}</div>\n`;

/** A small square of a colour with a letter on it, as legends show it; decoration, hidden from screen readers. */
export function swatch(colour: string, letter: string): Markup {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)) as [number, number, number];
  return markup`<svg class="swatch" viewBox="0 0 22 22" aria-hidden="true" focusable="false"><rect width="22" height="22" rx="3" fill="${colour}"/><text
x="11" y="16" fill="${2 * r + 5 * g + b > 8 * 110 ? "#000" : "#fff"}">${letter}</text></svg>`;
}
