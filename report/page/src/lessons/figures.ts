// The live figures of a lesson, each in the place of its picture; the picture stays where its figure cannot be made. What the
// program says of them (app/lessons/figures.h) is in the page's data.
import { page } from "../data";
import { addressOf } from "../lab/lab_state";
import { pageData } from "../parts";
import { html } from "../svg";
import { biasFigure } from "./bias_figure";
import { boxFitFigure } from "./box_fit_figure";
import { buildFigure } from "./build_figure";
import { cubeFigure } from "./cube_figure";
import { eyeRayFigure } from "./eye_ray_figure";
import { flatlandFigure } from "./flatland_figure";
import { gridCurveFigure } from "./grid_curve_figure";
import { intersectionFigure } from "./intersection_figure";
import { mapSizeFigure } from "./map_size_figure";
import { say } from "./say";
import { structureFigure } from "./structure_figure";
import { twoPassesFigure } from "./two_passes_figure";
import { twoWaysFigure } from "./two_ways_figure";
import { whittedFigure } from "./whitted_figure";

export interface FigureJson<Data = never> {
  name: string;
  settings: Record<string, string>;  // of the mark in the lesson's text
  data: Data;
}

type Maker = (figure: FigureJson, id: string) => HTMLElement | Promise<HTMLElement>;
const makers: Record<string, Maker> = { bias: biasFigure, "box-fit": boxFitFigure, build: buildFigure, "cube-faces": cubeFigure, "eye-ray": eyeRayFigure, flatland: flatlandFigure, "grid-curve": gridCurveFigure, intersection: intersectionFigure, "map-size": mapSizeFigure, structure: structureFigure, "two-passes": twoPassesFigure, "two-ways": twoWaysFigure, whitted: whittedFigure };

/** Null where that fails: the other figures and the slides do not wait for it. */
async function makeFigure(figure: FigureJson, id: string): Promise<HTMLElement | null> {
  try {
    return await makers[figure.name]!(figure, id);
  } catch (error) {
    console.error(`${id}, ${figure.name}:`, error);
    return null;
  }
}

/** Of a figure that the program drew: where the browser draws the same picture anew, with any setting. */
function labLink(lab: string, { scene, ...options }: Record<string, string>): HTMLElement {
  const address = addressOf({ scene: scene!, options: new Map(Object.entries(options).filter(([name]) => name !== "sizes")).set("size", `${page.width}x${page.height}`) });
  return html("p", { class: "hint" }, html("a", { class: "to-lab", href: lab + address }, say("Change every setting in the lab")), ". ", say("The program itself computes it there, in your browser."));
}

export async function startFigures(): Promise<void> {
  const { figures, lab } = pageData<{ figures: (FigureJson<{ comparison?: string }> | null)[]; lab?: string }>();
  for (const host of document.querySelectorAll<HTMLElement>(".live")) {
    const at = Number(host.dataset.figure), figure = figures[at];
    if (!figure) continue;
    const made = await makeFigure(figure as FigureJson, `figure-${at}`);
    if (!made) continue;
    if (lab && figure.data.comparison) made.append(labLink(lab, figure.settings));
    made.classList.add("live-figure");
    made.dataset.name = figure.name;
    host.prepend(made);
    host.classList.add("is-live");
  }
}
