// What a page gains when scripts may run. Of a comparison: the viewer that swipes, flips and enlarges, the probe that
// reads a pixel and draws it in light space. Also a bias to drag, labels to show alone, views to link to. Of a sweep: a grid
// by any two parameters, cells that open in the viewer, a table to sort. Of shadows in time: the film and its probe. Without it everything is still on the page.
import "./report.css";
import { startComparison } from "./compare_page";
import { startJudged } from "./judged_page";
import { pageKind } from "./parts";
import { startSheet } from "./sheet_page";
import { startShimmer } from "./shimmer_page";
import { startSweep } from "./sweep_page";

async function start(): Promise<void> {
  await { compare: startComparison, judged: startJudged, sheet: startSheet, shimmer: startShimmer, sweep: startSweep }[pageKind]();
  document.documentElement.dataset.ready = "true";
}
void start();
