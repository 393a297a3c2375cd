// A figure of the lesson with other settings, computed by the program itself in a worker of the page. That is where a site is read
// over HTTP and has the program for the web beside it. From the disk, and without it, the lesson's own figure stands.
import { putComparison, type ComparisonJson } from "../data";
import { SettingsPanel } from "../lab/settings_panel";
import { pageData } from "../parts";
import { answered, ProgramWorker } from "../program_worker";
import { html, number } from "../svg";
import type { FigureJson } from "./figures";
import { say } from "./say";

/** A page's data with one figure, as the program answers (lab/lessons/figures.h). */
interface ComputedJson {
  figures: [FigureJson<{ comparison?: string }>];
  comparisons: Record<string, ComparisonJson>;
  parts: Record<string, unknown>;
}

let program: ProgramWorker | undefined; // one for the page, from the first change on

async function computed(mark: string, id: string): Promise<FigureJson> {
  program ??= new ProgramWorker(
    new Worker(new URL("gnomon_worker.mjs", new URL(pageData<{ lab: string }>().lab, location.href)), { type: "module" }),
  );
  const {
    figures: [figure],
    comparisons,
    parts,
  } = (await (await answered(await program.ask("figure", { mark }))).json()) as ComputedJson;
  const key = Object.keys(comparisons)[0],
    own = `${id}: `;
  if (key !== undefined) {
    putComparison(
      own,
      comparisons[key]!,
      Object.fromEntries(Object.entries(parts).map(([name, part]) => [own + name.slice(key.length), part])),
    );
    figure.data.comparison = own;
  }
  return figure as FigureJson;
}

/** Whether the page can have its figures computed. */
export const canCompute = (): boolean => location.protocol !== "file:" && pageData<{ lab?: string }>().lab !== undefined;

export class ComputePanel {
  readonly element: HTMLElement;
  private readonly said = html("p", { class: "compute-said", role: "status" });
  private readonly panel: SettingsPanel;
  private asked = 0; // the number of the last wish
  private wish: Record<string, string> | null = null;
  private isBusy = false;

  /** `show` takes a figure's data and shows it in place of what was there. */
  constructor(
    private readonly lesson: FigureJson,
    private readonly id: string,
    private readonly show: (figure: FigureJson) => Promise<void>,
  ) {
    const rows = html("div", { class: "rows" }),
      back = html("button", { type: "button" }, say("As in the lesson"));
    this.panel = new SettingsPanel(rows, lesson.controls!, (options) => this.ask({ ...lesson.settings, ...Object.fromEntries(options) }));
    this.showSettings(lesson);
    back.addEventListener("click", () => void this.restore());
    this.element = html(
      "details",
      { class: "compute" },
      html("summary", {}, say("Compute with other settings")),
      html(
        "p",
        { class: "hint" },
        say("The program itself computes the figure anew here, in your browser. It is loaded with the first change."),
      ),
      rows,
      html("div", { class: "compute-end" }, back, this.said),
    );
  }

  private showSettings({ drawn }: FigureJson): void {
    this.panel.show(structuredClone(drawn!));
  }

  private say(words: string, isWrong = false): void {
    this.said.textContent = words;
    this.said.classList.toggle("wrong", isWrong);
  }

  private async restore(): Promise<void> {
    ++this.asked;
    this.wish = null;
    await this.show(this.lesson);
    this.showSettings(this.lesson);
    this.say(say("As in the lesson."));
  }

  private ask(settings: Record<string, string>): void {
    ++this.asked;
    this.wish = settings;
    if (!this.isBusy) void this.work();
  }

  /** Until nothing is wished for: of what was asked for in the meantime the last. */
  private async work(): Promise<void> {
    this.isBusy = true;
    for (let settings = this.wish; settings; settings = this.wish) {
      const number = this.asked;
      this.wish = null;
      await this.compute(settings, () => number === this.asked);
    }
    this.isBusy = false;
  }

  /** `isWanted`: nothing else has been asked for since. */
  private async compute(settings: Record<string, string>, isWanted: () => boolean): Promise<void> {
    const begin = performance.now();
    this.say(program ? say("The program computes…") : say("The program is loaded, and computes…"));
    try {
      const figure = await computed(
        [this.lesson.name, ...Object.entries(settings).map(([name, value]) => `${name}=${value}`)].join(" "),
        this.id,
      );
      if (!isWanted()) return;
      await this.show(figure);
      this.showSettings(figure);
      this.say(say`Computed by the program in this page in ${number((performance.now() - begin) / 1000, 2)} s.`);
    } catch (error) {
      if (isWanted()) this.say(say`${(error as Error).message.replace(/\.?$/, ".")} The figure is as it was before.`, true);
    }
  }
}
