// The live figures of a lesson, each in the place of its picture; the picture stays where its figure cannot be made. What the
// program says of them (lab/lessons/figures.h) is in the page's data.
import { page } from "../data";
import type { SettingFacts } from "../lab/engine";
import { addressOf } from "../lab/lab_state";
import type { Panelled } from "../lab/settings_panel";
import { pageData } from "../parts";
import { html } from "../svg";
import { biasFigure } from "./bias_figure";
import { boxFitFigure } from "./box_fit_figure";
import { buildFigure } from "./build_figure";
import { canCompute, ComputePanel } from "./compute_panel";
import { cubeFigure } from "./cube_figure";
import { eyeRayFigure } from "./eye_ray_figure";
import { flatlandFigure } from "./flatland_figure";
import { gridCurveFigure } from "./grid_curve_figure";
import { intersectionFigure } from "./intersection_figure";
import { mapSizeFigure } from "./map_size_figure";
import { pause } from "./pause";
import { say } from "./say";
import { structureFigure } from "./structure_figure";
import { twoPassesFigure } from "./two_passes_figure";
import { twoWaysFigure } from "./two_ways_figure";
import { whittedFigure } from "./whitted_figure";

export interface FigureJson<Data = never> {
  name: string;
  settings: Record<string, string>; // of the mark in the lesson's text
  data: Data;
  controls?: SettingFacts[]; // what it can be computed with anew, by the program for the web
  drawn?: Panelled; // and with what it was
}

type Maker = (figure: FigureJson, id: string) => HTMLElement | Promise<HTMLElement>;
const makers: Record<string, Maker> = {
  bias: biasFigure,
  "box-fit": boxFitFigure,
  build: buildFigure,
  "cube-faces": cubeFigure,
  "eye-ray": eyeRayFigure,
  flatland: flatlandFigure,
  "grid-curve": gridCurveFigure,
  intersection: intersectionFigure,
  "map-size": mapSizeFigure,
  structure: structureFigure,
  "two-passes": twoPassesFigure,
  "two-ways": twoWaysFigure,
  whitted: whittedFigure,
};

/** Null where that fails: the other figures and the slides do not wait for it. */
async function makeFigure(figure: FigureJson, id: string): Promise<HTMLElement | null> {
  try {
    return await makers[figure.name]!(figure, id);
  } catch (error) {
    console.error(`${id}, ${figure.name}:`, error);
    return null;
  }
}

/** Where the browser draws the same picture anew, with any setting. */
function labAddress(lab: string, { scene, ...options }: Record<string, string>): string {
  // What is the figure's own, and a window that is another scene's, is nothing to the lab.
  const own = (name: string) =>
    ["sizes", "passes", "window-of"].includes(name) || (name.startsWith("window-") && options["window-of"] !== scene);
  return (
    lab +
    addressOf({
      scene: scene!,
      options: new Map(Object.entries(options).filter(([name]) => !own(name))).set("size", `${page.width}x${page.height}`),
    })
  );
}

type PlacedJson = FigureJson<{ comparison?: string }>;
const pageFigures = pageData<{ figures: (PlacedJson | null)[]; lab?: string }>();

/** A figure with what the program can do about it: a panel of settings, and the way to the lab. */
class PlacedFigure {
  private own: Element[];
  private readonly panel: HTMLElement | null = null;
  private readonly link = html("a", { class: "to-lab" }, say("Change every setting in the lab"));

  constructor(
    readonly element: HTMLElement,
    figure: PlacedJson,
    private readonly at: number,
    private readonly id: string,
  ) {
    this.own = [...element.children];
    element.classList.add("live-figure");
    element.dataset.name = figure.name;
    if (figure.controls && canCompute()) {
      this.panel = new ComputePanel(figure as FigureJson, id, (shown) => this.show(shown)).element;
      element.append(this.panel);
      this.arrange(this.own);
    }
    if (!pageFigures.lab || !figure.data.comparison) return;
    this.setLink(figure);
    element.append(html("p", { class: "hint" }, this.link, ". ", say("The program itself computes it there, in your browser.")));
  }

  private setLink({ settings }: PlacedJson): void {
    if (pageFigures.lab) this.link.href = labAddress(pageFigures.lab, settings);
  }

  /** The panel stands below the picture, before charts and hints, and stays where it is: it may have the focus. */
  private arrange(elements: Element[]): void {
    const more = elements.findIndex((element) => element.matches(".scroll, .hint")),
      split = more < 0 ? elements.length : more;
    this.element.prepend(...elements.slice(0, split));
    this.panel!.after(...elements.slice(split));
    this.own = elements;
  }

  private async show(shown: FigureJson): Promise<void> {
    const fresh = [...(await makers[shown.name]!(shown, this.id)).children];
    for (const element of this.own) element.remove();
    this.arrange(fresh);
    pageFigures.figures[this.at] = shown;
    this.setLink(shown);
  }
}

/** That of the slide in view, then those behind it, then the rest. */
function nextOf(hosts: HTMLElement[]): HTMLElement {
  const inView = document.querySelector(".on-slide"),
    isBehind = (host: HTMLElement) => inView !== null && (inView.compareDocumentPosition(host) & Node.DOCUMENT_POSITION_FOLLOWING) !== 0;
  return hosts.find((host) => inView?.contains(host)) ?? hosts.find(isBehind) ?? hosts[0]!;
}

/** One after the other; `placed` is told of each place where one has come. */
export async function startFigures(placed: (host: HTMLElement) => void): Promise<void> {
  const left = [...document.querySelectorAll<HTMLElement>(".live")].filter((host) => pageFigures.figures[Number(host.dataset.figure)]);
  while (left.length > 0) {
    await pause();
    const host = nextOf(left),
      at = Number(host.dataset.figure),
      figure = pageFigures.figures[at]!,
      id = `figure-${at}`;
    left.splice(left.indexOf(host), 1);
    const made = await makeFigure(figure as FigureJson, id);
    if (!made) continue;
    host.prepend(new PlacedFigure(made, figure, at, id).element);
    host.classList.add("is-live");
    placed(host);
  }
}
