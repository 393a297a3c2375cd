// The grid of thumbnails, by any two axes; the others stand still at values that the reader chooses.
import { pictureNamed } from "./frame";
import { percent } from "./number_text";
import { html } from "./svg";
import type { SweepState } from "./state";
import { inWords, type SweepCell } from "./sweep_document";

interface Axis {
  name: string;
  values: string[];
}

const distinct = (cells: SweepCell[], k: number): string[] => [...new Set(cells.map((cell) => cell.values[k]!))];

function pick(label: string, values: string[], chosen: string, change: (value: string) => void): HTMLLabelElement {
  const select = html(
    "select",
    { "aria-label": label },
    ...values.map((value) => html("option", { value }, value === "" ? "(none)" : inWords(value))),
  );
  select.value = chosen;
  select.addEventListener("change", () => change(select.value));
  return html("label", {}, `${label} `, select);
}

export class SweepGrid {
  private readonly axes: Axis[];
  private readonly links = new Map<number, HTMLAnchorElement>(); // with their thumbnails
  private readonly bar = html("div", { class: "viewer-bar grid-bar", role: "group", "aria-label": "Which parameters the grid shows" });
  private readonly table = html("div", { class: "scroll", role: "region", tabindex: "0", "aria-label": "Grid of cells" });

  constructor(
    host: HTMLElement,
    axes: string[],
    private readonly cells: SweepCell[],
    private readonly state: SweepState,
    private readonly changed: () => void,
  ) {
    this.axes = axes.map((name, k) => ({ name, values: distinct(cells, k) }));
    host.replaceChildren(this.bar, this.table);
  }

  /** The axes that have something to show, and where they stand. */
  private settle(): { rows: number; columns: number; rest: string[] } {
    const varying = this.axes
      .map((axis, k) => ({ axis, k }))
      .filter(({ axis }) => axis.values.length > 1)
      .map(({ k }) => k);
    const named = (name: string) => this.axes.findIndex((axis) => axis.name === name);
    let columns = named(this.state.columns),
      rows = named(this.state.rows);
    if (columns < 0) columns = varying.filter((k) => k !== rows).at(-1) ?? 0;
    if (rows < 0 || rows === columns) rows = varying.find((k) => k !== columns) ?? -1;
    const wanted = this.state.slice.split("|"),
      others = this.axes.map((_, k) => k).filter((k) => k !== rows && k !== columns);
    const rest = this.axes.map(() => "");
    others.forEach((k, i) => {
      rest[k] = this.axes[k]!.values.includes(wanted[i] ?? "") ? wanted[i]! : this.axes[k]!.values[0]!;
    });
    return { rows, columns, rest };
  }

  show(): void {
    const { rows, columns, rest } = this.settle(),
      names = this.axes.map((axis) => axis.name);
    const change = (update: () => void) => {
      update();
      this.show();
      this.changed();
    };
    const slice = () => rest.filter((_, k) => k !== rows && k !== columns).join("|");
    const used = this.bar.contains(document.activeElement) ? document.activeElement!.getAttribute("aria-label") : null;
    this.bar.replaceChildren(
      ...(rows >= 0
        ? [
            pick("Rows", names, names[rows]!, (name) =>
              change(() => {
                if (name === names[columns]) this.state.columns = names[rows]!;
                this.state.rows = name;
              }),
            ),
          ]
        : []),
      pick("Columns", names, names[columns]!, (name) =>
        change(() => {
          if (rows >= 0 && name === names[rows]) this.state.rows = names[columns]!;
          this.state.columns = name;
        }),
      ),
      ...this.axes.flatMap((axis, k) =>
        k === rows || k === columns || axis.values.length < 2
          ? []
          : [
              pick(inWords(axis.name), axis.values, rest[k]!, (value) =>
                change(() => {
                  rest[k] = value;
                  this.state.slice = slice();
                }),
              ),
            ],
      ),
    );
    const shown = this.cells.filter((cell) => cell.values.every((value, k) => k === rows || k === columns || value === rest[k]));
    this.table.replaceChildren(this.grid(shown, rows, columns));
    // The list that was used is made again: the keyboard stays on it.
    if (used !== null) [...this.bar.querySelectorAll("select")].find((select) => select.getAttribute("aria-label") === used)?.focus();
  }

  private grid(cells: SweepCell[], rows: number, columns: number): HTMLTableElement {
    const across = this.axes[columns]!,
      down = rows >= 0 ? this.axes[rows]! : { name: "", values: [""] };
    const used = (axis: Axis, k: number) => axis.values.filter((value) => k < 0 || cells.some((cell) => cell.values[k] === value));
    const at = new Map(cells.map((cell) => [`${rows >= 0 ? cell.values[rows] : ""}|${cell.values[columns]}`, cell]));
    const head = html(
      "tr",
      {},
      ...(rows >= 0 ? [html("td", {}, `${inWords(down.name)} ↓ ${inWords(across.name)} →`)] : []),
      ...used(across, columns).map((value) => html("th", { scope: "col", title: value }, this.shown(columns, value))),
    );
    const body = used(down, rows).map((row) =>
      html(
        "tr",
        {},
        ...(rows >= 0 ? [html("th", { scope: "row", title: row }, this.shown(rows, row))] : []),
        ...used(across, columns).map((value) => {
          const cell = at.get(`${row}|${value}`);
          return html("td", {}, ...(cell ? [this.link(cell)] : []));
        }),
      ),
    );
    return html(
      "table",
      { class: "grid" },
      html("caption", {}, rows >= 0 ? `${inWords(down.name)} by ${inWords(across.name)}` : inWords(across.name)),
      html("thead", {}, head),
      html("tbody", {}, ...body),
    );
  }

  private shown(axis: number, value: string): string {
    return this.cells.find((cell) => cell.values[axis] === value)!.shown[axis]!;
  }

  private link(cell: SweepCell): HTMLAnchorElement {
    let link = this.links.get(cell.cell);
    if (!link) {
      const thumbnail = pictureNamed(`thumbnail-${cell.cell}`);
      link = html(
        "a",
        { href: `#cell-${cell.cell}` },
        ...(thumbnail ? [thumbnail] : []),
        html("span", {}, `${percent(cell.wrong_fraction)}${cell.front ? " ★" : ""}`),
      );
      this.links.set(cell.cell, link);
    }
    if (cell.cell === this.state.cell) link.setAttribute("aria-current", "true");
    else link.removeAttribute("aria-current");
    return link;
  }

  /** After another cell was chosen. */
  mark(): void {
    for (const [cell, link] of this.links)
      if (cell === this.state.cell) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
  }
}
