// The page of a sweep: a grid by any two parameters, charts and a table whose every cell opens in the viewer, with a
// second cell to hold beside it. The URL keeps all of it.
import { Cell } from "./cell";
import { wordsOf } from "./data";
import { resultDocument } from "./document";
import { pictureNamed, showSections } from "./frame";
import { pageData } from "./parts";
import { initialSweep, readSweep, saveSweep, type SweepState } from "./state";
import { grouped } from "./number_text";
import { html } from "./svg";
import { settingWords, type SweepResult } from "./sweep_document";
import { SweepGrid } from "./sweep_grid";
import { cellLine, sweepSections } from "./sweep_sections";
import { SweepTable } from "./sweep_table";
import { Viewer, type Source } from "./viewer";

class SweepPage {
  private readonly json = resultDocument<SweepResult>();
  private readonly state: SweepState = { ...initialSweep };
  private readonly section = document.getElementById("cell")!;
  private readonly size = { width: 16, height: 9 }; // of the cell shown; set when there is one
  private readonly loaded = new Map<number, Promise<Cell>>();
  private readonly holder = html("button", { type: "button" }, "Keep for comparison");
  private readonly steps: HTMLButtonElement[];
  private shown: Cell | null = null;
  private held: Cell | null = null;
  private readonly grid: SweepGrid | null;
  private readonly table: SweepTable;
  private viewer: Viewer | null = null;

  constructor() {
    const saved = () => saveSweep(this.state),
      host = document.getElementById("grids");
    this.grid = host && this.json.axes.length > 0 ? new SweepGrid(host, this.json.axes, this.json.cells, this.state, saved) : null;
    for (const link of document.querySelectorAll<HTMLAnchorElement>(".headline a")) {
      const thumbnail = pictureNamed(`thumbnail-${link.getAttribute("href")!.slice(6)}`);
      if (thumbnail) link.prepend(thumbnail.cloneNode());
    }
    this.table = new SweepTable(document.querySelector("table.cells")!, this.state, saved);
    this.steps = (
      [
        ["Previous cell", -1],
        ["Next cell", 1],
      ] as const
    ).map(([name, step]) => {
      const button = html("button", { type: "button" }, name);
      button.addEventListener("click", () => void this.open(this.neighbour(step)));
      return button;
    });
    this.holder.addEventListener("click", () => this.keep());
    this.section.querySelector(".viewer-bar")!.append(html("span", { class: "cell-steps" }, ...this.steps, this.holder));
    // Every cell on the page opens by its link: in the grid, the charts and the table.
    document.addEventListener("click", (event) => {
      const link = (event.target as Element).closest("a[href^='#cell-']");
      if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
      const cell = this.json.cells.find((c) => c.cell === Number(link.getAttribute("href")!.slice(6)));
      if (!cell?.pictures) return; // the link leads to its row
      event.preventDefault();
      void this.open(cell.cell, true);
    });
    window.addEventListener("hashchange", () => void this.restore());
  }

  async restore(): Promise<void> {
    const wanted = readSweep(location.hash);
    if (wanted) Object.assign(this.state, wanted);
    this.grid?.show();
    if (wanted) this.table.show();
    const { held } = this.state,
      cell = held === null ? null : ((await this.load(held)?.catch(() => null)) ?? null);
    if (this.state.held === held) this.hold(cell); // else another one was chosen meanwhile
    if (wanted && this.state.cell !== null) await this.open(this.state.cell, true);
    else if (wanted) {
      this.section.hidden = true;
      this.table.mark();
    }
  }

  private neighbour(step: number): number {
    const cells = this.json.cells.filter((cell) => cell.pictures),
      at = cells.findIndex((cell) => cell.cell === this.state.cell);
    return cells[(at + step + cells.length) % cells.length]!.cell;
  }

  private load(number: number): Promise<Cell> | null {
    const json = this.json.cells.find((cell) => cell.cell === number);
    if (!json?.pictures) return null;
    if (!this.loaded.has(number)) this.loaded.set(number, Cell.load(json));
    return this.loaded.get(number)!;
  }

  private async open(number: number, scroll = false): Promise<void> {
    const loading = this.load(number);
    if (!loading) return;
    this.state.cell = number;
    let cell: Cell;
    try {
      cell = await loading;
    } catch (error) {
      if (this.state.cell !== number) return;
      this.section.hidden = false;
      this.section.querySelector("h2")!.textContent = `Cell ${number}`;
      this.section.querySelector(".cell-line")!.textContent = (error as Error).message;
      return;
    }
    if (this.state.cell !== number) return; // another one was asked for meanwhile
    this.shown = cell;
    Object.assign(this.size, { width: this.shown.width, height: this.shown.height });
    this.section.hidden = false;
    this.describe(this.shown);
    this.fillPicks();
    this.viewer ??= new Viewer(this.section.querySelector(".viewer")!, this.state, this.size, {
      hover: (x, y) => this.read(x, y),
      pin: (x, y) => {
        this.state.pixel = [x, y];
        this.read(x, y);
        this.viewer!.show();
        this.save();
      },
      unpin: () => {
        this.state.pixel = null;
        this.viewer!.show();
        this.save();
      },
      changed: () => this.save(),
      source: (name) => this.source(name),
    });
    this.viewer.show();
    if (this.state.pixel) this.read(...this.state.pixel);
    this.grid?.mark();
    this.table.mark();
    this.save();
    if (scroll) this.section.scrollIntoView({ block: "start" });
  }

  private save(): void {
    saveSweep(this.state);
  }

  private describe(cell: Cell): void {
    const text = (selector: string, content: string) => {
      this.section.querySelector(selector)!.textContent = content;
    };
    text("h2", `Cell ${cell.json.cell}: ${settingWords(this.json.axes, cell.json)}`);
    text(".cell-line", cellLine(cell.json));
    text(".cell-command", cell.json.command);
    const labels = this.section.querySelector(".cell-labels")!,
      counts = [...cell.counts()].filter(([label]) => label > 0).sort((a, b) => b[1] - a[1]);
    labels.replaceChildren(...counts.flatMap(([label, count]) => [this.labelButton(label, count), " "]));
  }

  private labelButton(label: number, count: number): HTMLButtonElement {
    const words = wordsOf(label),
      swatch = html("span", { class: "dot-swatch" });
    swatch.style.background = words.colour;
    const button = html(
      "button",
      { type: "button", "aria-pressed": String(this.state.label === words.name), title: words.what },
      swatch,
      ` ${words.name} ${grouped(count)}`,
    );
    button.addEventListener("click", () => {
      this.state.label = this.state.label === words.name ? null : words.name;
      if (this.state.label !== null && this.state.left !== "labels" && this.state.right !== "labels") this.state.right = "labels";
      for (const other of this.section.querySelectorAll(".cell-labels button"))
        // in place: the keyboard stays on its button
        other.setAttribute("aria-pressed", String(other === button && this.state.label !== null));
      this.viewer!.show();
      this.save();
    });
    return button;
  }

  // Pictures of the cell, and of the one held beside it.
  private fillPicks(): void {
    const names = (cell: Cell, prefix: string): [string, string][] => [
      [`${prefix}truth`, `${prefix}ray traced`],
      [`${prefix}difference`, `${prefix}difference`],
      [`${prefix}labels`, `${prefix}labels`],
      ...(cell.drawing
        ? [
            [
              `${prefix}drawing`,
              `${prefix}rasterized${cell.drawing.width < cell.width ? ` (reduced to ${cell.drawing.width} × ${cell.drawing.height})` : ""}`,
            ] as [string, string],
          ]
        : []),
    ];
    const entries = [...names(this.shown!, ""), ...(this.held ? names(this.held, `cell ${this.held.json.cell}: `) : [])];
    for (const select of this.section.querySelectorAll<HTMLSelectElement>(".pick"))
      select.replaceChildren(...entries.map(([value, name]) => html("option", { value }, name)));
    if (!entries.some(([, name]) => name === this.state.left)) this.state.left = entries[0]![1];
    if (!entries.some(([, name]) => name === this.state.right)) this.state.right = entries[1]![1];
  }

  private hold(cell: Cell | null): void {
    this.held = cell;
    this.state.held = cell?.json.cell ?? null;
    this.holder.textContent = cell ? `Kept: cell ${cell.json.cell}` : "Keep for comparison";
  }

  private keep(): void {
    this.hold(this.shown);
    this.fillPicks();
    this.viewer!.show();
    this.save();
  }

  private source(value: string): Source | null {
    const other = /^cell \d+: (.*)$/.exec(value),
      cell = other ? this.held : this.shown,
      name = other?.[1] ?? value;
    if (!cell) return null;
    if (name === "truth") return { url: cell.truth.src };
    if (name === "drawing") return cell.drawing && { url: cell.drawing.src };
    if (name === "difference") return cell.difference();
    const label =
      this.state.label === null
        ? null
        : (pageData<{ labels: { name: string; value: number }[] }>().labels.find((l) => l.name === this.state.label)?.value ?? null);
    return cell.labelPicture(label);
  }

  private read(x: number, y: number): void {
    const cell = this.shown!;
    if (x >= cell.width || y >= cell.height) return;
    this.section.querySelector(".probe")!.textContent =
      `Pixel ${x}, ${y}: ${cell.nameAt(y * cell.width + x)}` +
      (this.held && this.held.width === cell.width && this.held !== cell
        ? `; in cell ${this.held.json.cell}: ${this.held.nameAt(y * cell.width + x)}`
        : "");
  }
}

export async function startSweep(): Promise<void> {
  showSections(sweepSections());
  await new SweepPage().restore();
}
