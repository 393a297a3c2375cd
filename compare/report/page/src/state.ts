// What the reader looks at, kept in the URL's hash so that a view can be linked to: "#light-0?pixel=12,40&bias=0.05".
// A hash without "?" is an ordinary link to a section.

export interface ViewState {
  left: string;   // pictures, by their names in the viewer
  right: string;
  mode: string;
  split: number;  // share of the width
  zoom: number;
  x: number;
  y: number;
  front: number;  // which picture flipping shows
  exposure: number;  // in stops
  pixel: readonly [number, number] | null;  // pinned
  bias: number | null;  // constant, world units; null: as rendered
  label: string | null;  // shown alone
  cut: string;  // the cross-section's way across the map: auto, row, column
  texels: number;  // half the width of the cross-section
}

export const initial: ViewState = {
  left: "rasterized", right: "ray traced", mode: "swipe", split: 0.5, zoom: 1, x: 0, y: 0, front: 0, exposure: 0,
  pixel: null, bias: null, label: null, cut: "auto", texels: 16,
};

export function hashOf(light: number, state: ViewState): string {
  const parts = new URLSearchParams();
  for (const [key, value] of Object.entries(state))
    if (String(value) !== String(initial[key as keyof ViewState])) parts.set(key, String(value));
  return `#light-${light}?${parts.toString().replaceAll("%2C", ",").replaceAll("+", "%20")}`;
}

const inRange = (text: string, low: number, high: number): number | undefined => {
  const value = Number(text);
  return text !== "" && isFinite(value) ? Math.min(Math.max(value, low), high) : undefined;
};

const readers: { [K in keyof ViewState]: (text: string) => ViewState[K] | undefined } = {
  left: (t) => t, right: (t) => t, label: (t) => t,
  mode: (t) => (["swipe", "side", "flip"].includes(t) ? t : undefined),
  split: (t) => inRange(t, 0, 1), zoom: (t) => inRange(t, 1, 64), x: (t) => inRange(t, -63, 0), y: (t) => inRange(t, -63, 0),
  cut: (t) => (["auto", "row", "column"].includes(t) ? t : undefined),
  front: (t) => (t === "1" ? 1 : 0), exposure: (t) => inRange(t, -6, 6), texels: (t) => inRange(t, 4, 1e6),
  bias: (t) => inRange(t, -1e30, 1e30),
  pixel: (t) => {
    const match = /^(\d+),(\d+)$/.exec(t);
    return match ? [Number(match[1]), Number(match[2])] : undefined;
  },
};

/** The light and its state, or nothing when the hash is not one of ours; what cannot be read keeps its default. */
export function readHash(hash: string): { light: number; state: ViewState } | null {
  const match = /^#light-(\d+)\?(.*)$/.exec(hash);
  if (!match) return null;
  const state: Record<string, unknown> = { ...initial };
  for (const [key, text] of new URLSearchParams(match[2]))
    if (key in readers) state[key] = readers[key as keyof ViewState](text) ?? initial[key as keyof ViewState];
  return { light: Number(match[1]), state: state as unknown as ViewState };
}

let pending = 0;
/** Writes the hash soon; many changes in a row become one. */
export function saveHash(light: number, state: ViewState): void {
  window.clearTimeout(pending);
  pending = window.setTimeout(() => history.replaceState(null, "", hashOf(light, state)), 150);
}
