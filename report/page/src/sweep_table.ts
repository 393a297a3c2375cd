// The table of cells: sorted by a click on a column's name, and a button that copies a cell's command.
import type { SweepState } from "./state";

type Key = number | string | null;

function keyOf(row: HTMLTableRowElement, column: number): Key {
  const cell = row.cells[column]!,
    text = cell.dataset.sort ?? cell.textContent!;
  const value = parseFloat(text);
  return text === "" ? null : Number.isNaN(value) ? text : value;
}

// What is missing comes last.
function compare(a: Key, b: Key): number {
  if (a === null || b === null) return Number(a === null) - Number(b === null);
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b));
}

export class SweepTable {
  private readonly headers: HTMLTableCellElement[];

  constructor(
    private readonly table: HTMLTableElement,
    private readonly state: SweepState,
    changed: () => void,
  ) {
    this.headers = [...table.tHead!.rows[0]!.cells];
    for (const header of this.headers) {
      const button = document.createElement("button"),
        name = header.textContent!;
      button.type = "button";
      button.textContent = name;
      header.replaceChildren(button);
      button.addEventListener("click", () => {
        state.sort = state.sort === name ? `-${name}` : name;
        this.show();
        changed();
      });
    }
  }

  show(): void {
    const down = this.state.sort.startsWith("-"),
      name = this.state.sort.replace(/^-/, "");
    const column = this.headers.findIndex((header) => header.textContent === name),
      body = this.table.tBodies[0]!;
    this.headers.forEach((header, k) => {
      if (k === column) header.setAttribute("aria-sort", down ? "descending" : "ascending");
      else header.removeAttribute("aria-sort");
    });
    const by = Math.max(column, 0),
      sign = down ? -1 : 1;
    const rows = [...body.rows].map((row) => ({ row, key: keyOf(row, by) }));
    rows.sort((a, b) => (a.key === null || b.key === null ? compare(a.key, b.key) : sign * compare(a.key, b.key)));
    body.append(...rows.map(({ row }) => row));
  }

  mark(): void {
    for (const row of this.table.tBodies[0]!.rows)
      if (row.id === `cell-${this.state.cell}`) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
  }
}
