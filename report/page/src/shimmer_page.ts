// The page of a film of shadows: each light's film with play, scrub and step, and the probe's strip chart.
import { Decoder, FilmFrames, momentAt, type FilmJson, type Frame, type Moment } from "./film_frames";
import { pageData, part } from "./parts";
import { resultDocument } from "./document";
import { showSections } from "./frame";
import { shimmerSections, type ShimmerFacts, type ShimmerResult } from "./shimmer_sections";
import { stripChart, stripX } from "./strip_chart";
import { counted } from "./number_text";
import { html } from "./svg";

const result = resultDocument<ShimmerResult>(),
  facts = pageData<ShimmerFacts>();
const page = { ...result, ...result?.size, labels: facts.labels };
const views = ["drawn", "truth", "flips"] as const;
type View = (typeof views)[number];

const bytesOf = (colour: string): number[] => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
const flipColours = page.labels.map((label) => bytesOf(label.colour));
// As film_colour() in ../../../shimmer/film.cpp.
const shares = Float32Array.from({ length: 256 }, (_, v) => 0.25 + (0.75 * v) / 255);

class FilmPlayer {
  private frames!: FilmFrames;
  private base!: Uint8ClampedArray;
  private readonly canvas = html("canvas", { role: "img", tabindex: "0" });
  private readonly context: CanvasRenderingContext2D;
  private readonly image = new ImageData(page.width, page.height);
  private readonly play = html("button", { type: "button", class: "film-play" }, "Play");
  private readonly slider = html("input", { type: "range", min: "0", max: String(page.frames - 1), value: "0", "aria-label": "Frame" });
  private readonly reading = html("span", { class: "film-frame" });
  private readonly probe = html("div", { class: "film-probe" });
  private readonly buttons: HTMLButtonElement[];
  private view: View = "flips";
  private now = 0;
  private started: number | null = null; // the moment that frame 0 was due
  private pixel: number | null = null;
  private moments: Moment[] = [];

  constructor(private readonly section: HTMLElement) {
    document.documentElement.style.setProperty("--ratio", String(page.width / page.height));
    this.canvas.width = page.width;
    this.canvas.height = page.height;
    this.context = this.canvas.getContext("2d", { willReadFrequently: true })!; // whole pictures are put into it
    this.buttons = views.map((view) => {
      const button = html("button", { type: "button", "data-view": view }, view);
      button.addEventListener("click", () => {
        this.view = view;
        void this.show(this.now);
      });
      return button;
    });
  }

  async start(index: number): Promise<void> {
    const decoder = new Decoder(page.width, page.height);
    this.base = await decoder.pixels(await part<string>("base"));
    this.frames = new FilmFrames(await part<FilmJson>(`film-${index}`), decoder);
    this.build();
    await this.show(0);
  }

  private build(): void {
    const step = (by: number): HTMLButtonElement => {
      const button = html(
        "button",
        { type: "button", class: by < 0 ? "film-back" : "film-on", "aria-label": by < 0 ? "One frame back" : "One frame on" },
        by < 0 ? "◀" : "▶",
      );
      button.addEventListener("click", () => {
        this.pause();
        void this.show(this.now + by);
      });
      return button;
    };
    this.play.addEventListener("click", () => (this.started === null ? this.run() : this.pause()));
    this.slider.addEventListener("input", () => {
      this.pause();
      void this.show(Number(this.slider.value));
    });
    this.canvas.addEventListener("click", (event) => {
      const box = this.canvas.getBoundingClientRect(),
        step = page.anchors;
      // A click's place is whole, the picture's need not be: its first column may be met just before it begins.
      const snap = (share: number, size: number): number => Math.floor(Math.min(Math.max(share * size, 0), size - 1) / step) * step;
      void this.read(
        snap((event.clientY - box.top) / box.height, page.height) * page.width + snap((event.clientX - box.left) / box.width, page.width),
      );
    });
    this.canvas.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (by === undefined && event.key !== " ") return;
      event.preventDefault();
      if (by === undefined) {
        this.play.click();
        return;
      }
      this.pause();
      void this.show(this.now + by);
    });
    const legend = html(
      "p",
      { class: "film-legend" },
      ...page.labels.flatMap((label) => {
        const dot = html("span", { class: "dot-swatch" });
        dot.style.background = label.colour;
        return [dot, ` ${label.name}  `];
      }),
    );
    const film = this.section.querySelector<HTMLElement>(".film")!;
    film.append(
      html(
        "div",
        { class: "film-bar" },
        this.play,
        step(-1),
        step(1),
        this.slider,
        this.reading,
        html("span", { class: "modes", role: "group", "aria-label": "Film of" }, ...this.buttons),
      ),
      this.canvas,
      legend,
      html("p", { class: "hint" }, "Click a pixel to see its rungs over time. Keys on the picture: space plays, arrows step."),
      this.probe,
    );
    film.hidden = false;
    for (const place of this.section.querySelectorAll<HTMLElement>(".place")) {
      const button = html("button", { type: "button" }, place.textContent!);
      button.addEventListener("click", () => void this.read(Number(place.dataset.pixel)));
      place.replaceChildren(button);
    }
  }

  private run(): void {
    this.play.textContent = "Pause";
    this.started = performance.now() - (1000 * this.now) / page.fps;
    const tick = async (time: number): Promise<void> => {
      if (this.started === null) return;
      const due = Math.floor(((time - this.started) * page.fps) / 1000) % page.frames;
      if (due !== this.now && due >= 0) await this.show(due);
      requestAnimationFrame((next) => void tick(next));
    };
    requestAnimationFrame((time) => void tick(time));
  }

  private pause(): void {
    this.started = null;
    this.play.textContent = "Play";
  }

  private async show(frame: number): Promise<void> {
    this.now = (frame + page.frames) % page.frames;
    const asked = this.now,
      pictures = await this.frames.frame(asked);
    if (asked !== this.now) return; // another one was asked for meanwhile
    this.compose(pictures);
    this.context.putImageData(this.image, 0, 0);
    this.slider.value = String(asked);
    const said = `frame ${asked + 1} of ${page.frames}`; // for people, who count from one
    this.reading.textContent = said;
    this.slider.setAttribute("aria-valuetext", said);
    this.canvas.setAttribute("aria-label", `${this.view}, ${said}`);
    for (const button of this.buttons) button.setAttribute("aria-pressed", String(button.dataset.view === this.view));
    const shown = Number(this.section.dataset.shown ?? "0");
    this.section.dataset.shown = String(shown + 1);
    this.section.dataset.frame = String(asked);
    this.mark();
    void this.frames.frame((asked + 1) % page.frames); // is due next
  }

  private compose({ seen, flips }: Frame): void {
    const { data } = this.image,
      { base } = this,
      channel = this.view === "truth" ? 1 : 0,
      marks = this.view === "flips";
    for (let i = 0, o = 0; i < flips.length; ++i, o += 4) {
      const flip = marks ? flips[i]! : 0;
      if (flip > 0) {
        const colour = flipColours[flip - 1]!;
        data[o] = colour[0]!;
        data[o + 1] = colour[1]!;
        data[o + 2] = colour[2]!;
      } else {
        const share = (seen[o + 2]! & 32) !== 0 ? shares[seen[o + channel]!]! : 1;
        data[o] = (base[o]! * share) | 0;
        data[o + 1] = (base[o + 1]! * share) | 0;
        data[o + 2] = (base[o + 2]! * share) | 0;
      }
      data[o + 3] = 255;
    }
  }

  private async read(pixel: number): Promise<void> {
    this.pixel = pixel;
    const moments: Moment[] = [];
    for (let frame = 0; frame < page.frames; ++frame) moments.push(momentAt(await this.frames.frame(frame), pixel));
    if (this.pixel !== pixel) return;
    this.moments = moments;
    const x = pixel % page.width,
      y = Math.floor(pixel / page.width),
      flips = moments.filter((moment) => moment.flip >= 0);
    const where = moments.some((moment) => moment.counted) ? counted(flips.length, "flip") : "nothing is compared here";
    const by = [...new Set(flips.map((moment) => page.labels[moment.flip]!.name))].join(", ");
    const text = `Pixel ${x}, ${y}: ${where}${by ? `, by ${by}` : ""}.`;
    this.probe.replaceChildren(
      html("p", { class: "probe" }, text),
      html(
        "div",
        { class: "scroll", tabindex: "0", role: "region", "aria-label": `Rungs over time, light ${this.section.dataset.light}` },
        stripChart(moments, page.labels, text),
      ),
    );
    this.probe.dataset.pixel = String(pixel);
    this.mark();
  }

  /** The frame that is shown, in the charts. */
  private mark(): void {
    const place = (line: Element | null, x: number): void => {
      line?.setAttribute("x1", String(x));
      line?.setAttribute("x2", String(x));
    };
    if (this.moments.length > 0) place(this.probe.querySelector(".now"), stripX(this.now, page.frames));
    const chart = this.section.querySelector(".flips-chart"),
      dots = chart?.querySelectorAll("circle");
    const dot = dots?.[Math.max(this.now - 1, 0)];
    if (dot) place(chart!.querySelector(".now"), Number(dot.getAttribute("cx")));
  }
}

export async function startShimmer(): Promise<void> {
  showSections(shimmerSections(facts));
  const sections = [...document.querySelectorAll<HTMLElement>(".shimmer-light")];
  for (const [index, section] of sections.entries())
    try {
      await new FilmPlayer(section).start(index);
    } catch (error) {
      section
        .querySelector(".film")!
        .after(html("p", { class: "left-out" }, `The film and its probe are missing: ${(error as Error).message}.`));
    }
}
