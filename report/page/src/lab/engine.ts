// The engine behind the lab's page: what it is asked, and what it answers (docs/lab.md, "The page and its engine"). This one
// is the program that serves the page.
import type { BiasPoint, LabelFacts, LightResult } from "../report_document";

export interface SettingFacts {
  name: string;
  group: string;
  title: string;
  what: string;
  acne: string;
  peter_panning: string;
  allowed: string;
  readers: { techniques: string[]; kernels: string[] };
  control: "number" | "integer" | "switch" | "choice" | "text" | "bias";
  unit?: string;
  from?: number;  // of the slider
  to?: number;
  logarithmic?: boolean;
  powers_of_two?: boolean;
  flag?: boolean;  // of a switch: on by its name alone
  choices?: string[];
  automatic?: boolean;
}

export interface Named {
  name: string;
  what: string;
}

/** What the page knows beforehand. */
export interface LabFacts {
  scene: string;
  settings: SettingFacts[];
  techniques: { name: string; for_suns: boolean }[];
  labels: LabelFacts[];
  rungs: { symbol: string; name: string; what: string; step?: string }[];
  pictures: { name: string; title: string; legend: string }[];
  presets: { title: string; what: string }[];
  scenes: Named[];
  lessons: Named[];
}

export interface LightPose {
  name: string;
  sun: boolean;
  azimuth: number;  // degrees
  elevation: number;
  distance: number | null;  // world units, of a lamp
  own_distance: number;
  size: number;
}

export interface CameraPose {
  azimuth: number;  // degrees
  elevation: number;
  distance: number;  // world units
}

/** What there is of a state. */
export interface Drawn {
  scene: { name: string; lights: string[] };
  words: string[];  // of a command line, by which the state comes back
  command: string;
  size: { width: number; height: number };
  camera: CameraPose;
  light: LightPose;
  values: Record<string, string>;  // of the settings that the technique reads
  precision: string;
  renderer: string;
  bias_world: number;
  texel_world: number;
  drawn: number;  // the revision whose picture there is
  raster_ms: number;
  compared: number;  // the revision whose comparison there is; 0: none
  preview: boolean;  // at a quarter of the size
  verdict?: { headline: string; detail: string };
  result?: { lights: (LightResult & { bias_curve: BiasPoint[] })[] };
}

/** What has happened. */
export interface Reading extends Partial<Drawn> {
  number: number;
  client: string;
  revision: number;
  opening: boolean;
  error: string;
  note: string;
}

export const isDrawn = (reading: Reading): reading is Reading & Drawn => reading.scene !== undefined;

export interface Cut {
  along: "u" | "v";
  first: number;
  stored: (number | null)[];
  receiver: [number, number][];
  at: number;
  distance: number;
  bias: number;
}

/** One pixel explained. */
export interface PixelStory {
  pixel: [number, number];
  label: number;
  rungs: number[];
  deciding: number;
  seen: boolean;
  words: string;
  remarks: string[];
  cure: string;
  cut?: Cut;
}

export interface Wish {
  scene: string;
  words: string[];
  preset?: number;
}

export interface Engine {
  /** Asks for a state; its number is of the moment from which readings are of it. Rejects with the words that say why not. */
  ask(wish: Wish): Promise<number>;
  /** The next thing that happens after that moment, or after a while the same again. */
  news(after: number): Promise<Reading>;
  picture(name: string): Promise<HTMLCanvasElement>;
  pixel(x: number, y: number): Promise<PixelStory | null>;
  /** Takes a file, and says by which name it may be opened. */
  take(file: File): Promise<string>;
  /** Where the report of what is drawn is. */
  reportAddress(revision: number): string;
}

async function answered(response: Response): Promise<Response> {
  if (response.ok) return response;
  const text = await response.text();
  let said = text.trim();
  try {
    said = (JSON.parse(text) as { error: string }).error;
  } catch { /* words, then */ }
  throw new Error(said || `the engine answers with ${response.status}`);
}

/** The program that the page came from. */
export class ServedEngine implements Engine {
  /** This page's name for itself among all that look at the same lab. */
  readonly client = crypto.randomUUID();

  async ask(wish: Wish): Promise<number> {
    const response = await answered(await fetch("wish", { method: "POST", body: JSON.stringify({ client: this.client, ...wish }) }));
    return ((await response.json()) as { number: number }).number;
  }
  async news(after: number): Promise<Reading> {
    return (await (await answered(await fetch(`news?after=${after}`))).json()) as Reading;
  }
  async picture(name: string): Promise<HTMLCanvasElement> {
    const bitmap = await createImageBitmap(await (await answered(await fetch(`picture?name=${name}`))).blob());
    const canvas = document.createElement("canvas");
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
    canvas.getContext("2d")!.drawImage(bitmap, 0, 0);
    return canvas;
  }
  async pixel(x: number, y: number): Promise<PixelStory | null> {
    return (await (await answered(await fetch(`pixel?x=${x}&y=${y}`))).json()) as PixelStory | null;
  }
  async take(file: File): Promise<string> {
    const response = await answered(await fetch(`file?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file }));
    return ((await response.json()) as { scene: string }).scene;
  }
  reportAddress(revision: number): string { return `report?revision=${revision}`; }
}
