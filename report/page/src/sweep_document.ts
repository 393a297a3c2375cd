// The document of a sweep's page (studies/sweep/page_document.cpp): its cells, each over all lights together.
import type { ShadowSituation } from "./report_document";

export interface SweepCell {
  cell: number;
  values: string[]; // by axis
  shown: string[]; // the same as people read them
  no_effect: string[]; // axes that the technique does not read
  front: boolean; // worth having
  command: string;
  technique: string;
  compared: number;
  error: number; // in the sweep's measure
  error_words: string; // "1.2 %"
  wrong_fraction: number;
  false_shadow: number;
  missed_shadow: number;
  mean_absolute: number;
  flips_per_receiver_second: number | null; // null: no film was made
  mostly: string; // the label of most wrong pixels
  map_size: number;
  map_texels: number;
  map_bytes: number;
  raster_ms: number | null; // null: not timed
  rays_ms: number | null;
  exact_shadow_ms: number | null;
  derived: boolean; // made from the gaps of another cell's drawing
  pictures: boolean;
  drawn: boolean; // has a drawing of its own
}

/** Milliseconds; empty: not timed. */
export type TimeRange = [low: number, median: number, high: number] | [];

/** What one side's shadows of a cell take in a situation. */
export const shadowRange = (cell: SweepCell, situation: string, side: "map" | "rays"): TimeRange =>
  (cell as unknown as Record<string, TimeRange>)[`${situation}_${side}_ms`]!;

export interface RayPoint {
  name: string;
  compared: number;
  wrong: number;
  uncertain: number;
  mean_absolute: number;
  times_ms: { median: number };
  shadow_times_ms: { median: number; runs: number[] };
  rays: number;
  boxes_per_ray: number;
  primitives_per_ray: number;
  bytes: number;
}

/** What the sweep was asked to do, as it stands in the head of sweep.jsonl. */
export interface Configuration {
  scene: Record<string, string>;
  measure?: string;
  options: Record<string, unknown>;
  film?: Record<string, string>;
  axes?: { name: string; values: string[] }[];
  runs?: number | null;
  seed?: number | null;
  exposure?: number | null;
}

/** A figure that the table of cells has a column of (compare/result/figures.cpp). */
export interface FigureColumn {
  key: string; // of each cell
  head: string;
  form: "count" | "percent" | "number";
}

export interface SweepResult {
  version: string;
  configuration: Configuration;
  measure: { name: string; words: string; shares: boolean };
  axes: string[];
  columns: FigureColumn[];
  headline: { title: string; cell: number | null; setting: string; figures: string }[];
  front: number[]; // cells worth having, cheapest first
  situations: ShadowSituation[];
  load: [least: number, most: number] | null; // of the machine
  cells: SweepCell[];
  rays: RayPoint[];
  reference_samples: number;
}

/** "map_size": a key of the result; in words: "map size". */
export const inWords = (axis: string): string => axis.replaceAll("_", " ");

export const isFilmed = (cell: SweepCell): boolean => cell.flips_per_receiver_second !== null;

/** "map size 64, bias 0.05" */
export const settingWords = (axes: string[], cell: SweepCell): string =>
  axes.map((axis, k) => `${inWords(axis)} ${cell.shown[k]}`).join(", ") || "the only cell";
