// The engine behind the lab's page: what it is asked, and what it answers (docs/lab.md, "The page and its engine"). It is the
// program that serves the page, or the same in a worker of the page.
import { answered, ProgramWorker } from "../program_worker";
import { packed, startPacked } from "./one_file";
import type { BiasPoint, LabelFacts, LightResult } from "../report_document";

export interface SettingFacts {
  name: string;
  group: string;
  title: string;
  what: string;
  acne?: string; // this and the next three: of a setting of the map
  peter_panning?: string;
  allowed?: string;
  readers?: { techniques: string[]; kernels: string[] };
  control: "number" | "integer" | "switch" | "choice" | "text" | "bias";
  unit?: string;
  from?: number; // of the slider
  to?: number;
  logarithmic?: boolean;
  powers_of_two?: boolean;
  flag?: boolean; // of a switch: on by its name alone
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
  worker: boolean; // the page has its engine itself
  manual: string; // the address of the manual's page of options; "": there is none
  size: { width: number; height: number }; // of its first picture
  settings: SettingFacts[];
  techniques: { name: string; for_suns: boolean }[];
  labels: LabelFacts[];
  rungs: { symbol: string; name: string; what: string; step?: string }[];
  ray_rungs: LabFacts["rungs"]; // of few rays
  pictures: { name: string; title: string; legend: string }[];
  presets: { title: string; what: string }[];
  scenes: Named[];
  lessons: Named[];
  extensions: string[]; // of files that are scenes: ".glb"
}

export interface LightPose {
  name: string;
  sun: boolean;
  azimuth: number; // degrees
  elevation: number;
  distance: number | null; // world units, of a lamp
  own_distance: number;
  size: number;
}

export interface CameraPose {
  azimuth: number; // degrees
  elevation: number;
  distance: number; // world units
}

/** What the shadows took, in words. */
export interface TimeWords {
  clock: "gpu" | "processor"; // the GPU's own; or the program's, with the wait for the driver
  rows: [name: string, time: string][];
  by: string; // by which clock, how often, in which steps
}

/** What there is of a state. */
export interface Drawn {
  scene: { name: string; asked_as: string; lights: string[] }; // asked_as: what a wish for it says
  words: string[]; // of a command line, by which the state comes back
  command: string;
  size: { width: number; height: number };
  camera: CameraPose;
  light: LightPose;
  values: Record<string, string>; // of the settings that the technique reads
  precision: string;
  renderer: string;
  bias_world: number;
  texel_world: number;
  drawn: number; // the revision whose picture there is
  raster_ms: number;
  compared: number; // the revision whose comparison there is; 0: none
  preview: boolean; // at a quarter of the size
  times?: TimeWords; // once something is compared
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
  of_rays: boolean;
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

/** How an engine is asked: a request as docs/lab.md has it, and its answer, like one over HTTP. */
type Transport = (name: string, parameters: Record<string, string>, body?: Blob | string) => Promise<Response>;

export class Engine {
  /** This page's name for itself among all that look at the same lab. */
  readonly client = crypto.randomUUID();
  private readonly send: Transport;

  /** `lost`: what is said where it answers no more. `makesReports`: the report is a page of its own making, not an address. */
  constructor(
    transport: Transport,
    readonly lost: string,
    readonly makesReports: boolean,
  ) {
    this.send = async (...asked) => answered(await transport(...asked));
  }

  /** Asks for a state; its number is of the moment from which readings are of it. Rejects with the words that say why not. */
  async ask(wish: Wish): Promise<number> {
    return ((await (await this.send("wish", {}, JSON.stringify({ client: this.client, ...wish }))).json()) as { number: number }).number;
  }
  /** The next thing that happens after that moment, or after a while the same again. */
  async news(after: number): Promise<Reading> {
    return (await (await this.send("news", { after: String(after) })).json()) as Reading;
  }
  async picture(name: string): Promise<HTMLCanvasElement> {
    const bitmap = await createImageBitmap(await (await this.send("picture", { name })).blob());
    const canvas = document.createElement("canvas");
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
    canvas.getContext("2d")!.drawImage(bitmap, 0, 0);
    return canvas;
  }
  async pixel(x: number, y: number): Promise<PixelStory | null> {
    return (await (await this.send("pixel", { x: String(x), y: String(y) })).json()) as PixelStory | null;
  }
  /** Takes a file, and says by which name it may be opened. */
  async take(file: File): Promise<string> {
    return ((await (await this.send("file", { name: file.name }, file)).json()) as { scene: string }).scene;
  }
  /** The report of a state by its command's words. */
  async report(words: string[]): Promise<Blob> {
    return (await this.send("report", { words: words.join("\n") })).blob();
  }
}

/** The program that the page came from. */
export const servedEngine = (): Engine =>
  new Engine(
    (name, parameters, body) =>
      fetch(`${name}?${new URLSearchParams(parameters).toString()}`, {
        method: body === undefined ? "GET" : "POST",
        ...(body !== undefined && { body }),
      }),
    "The program behind this page does not answer. Start gnomon serve again, and open the address that it prints.",
    false,
  );

/** The program in a worker of this page, by the files beside it or within the page. It begins with a scene. */
export function workerEngine(scene: string, size: { width: number; height: number }): Engine {
  if (!packed && location.protocol === "file:")
    return new Engine(
      () =>
        Promise.resolve(
          new Response("The lab needs a host: browsers start no engine for a page that is opened as a file with others beside it.", {
            status: 500,
          }),
        ),
      "Put the folder on any host of plain files, or run python3 -m http.server in it and open http://localhost:8000/lab.html. What “Save the lab as one file” gives there opens from the disk, too.",
      true,
    );
  const started = packed && startPacked(packed),
    program = new ProgramWorker(started?.worker ?? new Worker("gnomon_worker.mjs", { type: "module" }));
  const begun = Promise.resolve(started?.program).then((bytes) => program.ask("begin", { scene, size, ...(bytes && { program: bytes }) }));
  return new Engine(
    async (...asked) => {
      const start = await begun;
      return start.ok ? program.ask(...asked) : start.clone();
    },
    "The program in this page has stopped: reload the page. Its address brings the state back.",
    true,
  );
}
