// What the reader looks at, kept in the URL's hash so that a view can be linked to: "#light-0?pixel=12,40&bias=0.05",
// "#sweep?cell=12&rows=map_size". A hash without "?" is an ordinary link to a section.

/** What the viewer shows. */
export interface ViewState {
  left: string; // pictures, by their names in the viewer
  right: string;
  mode: string;
  split: number; // share of the width
  zoom: number;
  x: number;
  y: number;
  front: number; // which picture flipping shows
  exposure: number; // in stops
  pixel: readonly [number, number] | null; // pinned
  label: string | null; // shown alone
}

/** What is looked at of one light of a comparison. */
export interface LightState extends ViewState {
  bias: number | null; // constant, world units; null: as rendered
  cut: string; // the cross-section's way across the map: auto, row, column
  texels: number; // half the width of the cross-section
}

const initialView: ViewState = {
  left: "rasterized",
  right: "ray traced",
  mode: "swipe",
  split: 0.5,
  zoom: 1,
  x: 0,
  y: 0,
  front: 0,
  exposure: 0,
  pixel: null,
  label: null,
};
export const initialLight: LightState = { ...initialView, bias: null, cut: "auto", texels: 16 };

/** What is looked at of a sweep. */
export interface SweepState extends ViewState {
  cell: number | null;
  held: number | null; // a cell kept for comparison
  rows: string; // axes; empty: none
  columns: string;
  slice: string; // values of the other axes, with "|" between
  sort: string; // a column of the table, with "-" before it when descending
}
export const initialSweep: SweepState = {
  ...initialView,
  left: "ray traced",
  right: "difference",
  cell: null,
  held: null,
  rows: "",
  columns: "",
  slice: "",
  sort: "",
};

export const inRange = (text: string, low: number, high: number): number | undefined => {
  const value = Number(text);
  return text !== "" && isFinite(value) ? Math.min(Math.max(value, low), high) : undefined;
};

type Readers<State> = { [K in keyof State]: (text: string) => State[K] | undefined };
const word = (text: string): string => text;
const index = (text: string): number | undefined => (/^\d+$/.test(text) ? Number(text) : undefined);

const viewReaders: Readers<ViewState> = {
  left: word,
  right: word,
  label: word,
  mode: (t) => (["swipe", "side", "flip"].includes(t) ? t : undefined),
  split: (t) => inRange(t, 0, 1),
  zoom: (t) => inRange(t, 1, 64),
  x: (t) => inRange(t, -63, 0),
  y: (t) => inRange(t, -63, 0),
  front: (t) => (t === "1" ? 1 : 0),
  exposure: (t) => inRange(t, -6, 6),
  pixel: (t) => {
    const match = /^(\d+),(\d+)$/.exec(t);
    return match ? [Number(match[1]), Number(match[2])] : undefined;
  },
};
const lightReaders: Readers<LightState> = {
  ...viewReaders,
  cut: (t) => (["auto", "row", "column"].includes(t) ? t : undefined),
  texels: (t) => (index(t) === undefined ? undefined : inRange(t, 4, 1e6)),
  bias: (t) => inRange(t, -1e30, 1e30),
};
const sweepReaders: Readers<SweepState> = { ...viewReaders, cell: index, held: index, rows: word, columns: word, slice: word, sort: word };

function hashOf<State extends object>(place: string, state: State, initial: State): string {
  const parts = new URLSearchParams();
  for (const [key, value] of Object.entries(state))
    if (String(value) !== String(initial[key as keyof State])) parts.set(key, String(value));
  return `#${place}?${parts.toString().replaceAll("%2C", ",").replaceAll("+", "%20")}`;
}

// What cannot be read keeps its default.
function parse<State extends object>(text: string, initial: State, readers: Readers<State>): State {
  const state: State = { ...initial };
  for (const [key, value] of new URLSearchParams(text))
    if (Object.hasOwn(readers, key)) state[key as keyof State] = readers[key as keyof State](value) ?? initial[key as keyof State];
  return state;
}

/** The light and its state, or nothing when the hash is not one of ours. */
export function readLight(hash: string): { light: number; state: LightState } | null {
  const match = /^#light-(\d+)\?(.*)$/.exec(hash);
  return match && { light: Number(match[1]), state: parse(match[2]!, initialLight, lightReaders) };
}

export function readSweep(hash: string): SweepState | null {
  const match = /^#sweep\?(.*)$/.exec(hash);
  return match && parse(match[1]!, initialSweep, sweepReaders);
}

let pending = 0;
function saveSoon(hash: () => string): void {
  window.clearTimeout(pending);
  pending = window.setTimeout(() => history.replaceState(null, "", hash()), 150);
}
/** Writes the hash soon; many changes in a row become one. */
export const saveLight = (light: number, state: LightState): void => saveSoon(() => hashOf(`light-${light}`, state, initialLight));
export const saveSweep = (state: SweepState): void => saveSoon(() => hashOf("sweep", state, initialSweep));
