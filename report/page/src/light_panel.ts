// One light's section brought to life: viewer, probe, label table and bias act on one state, which the URL keeps.
import { BiasPanel } from "./bias";
import { page, wordsOf, type Light, type PictureName, type Pixel } from "./data";
import { enlargeLabels } from "./enlarged_labels";
import { examplePixel } from "./example_pixel";
import { LabelTable } from "./labels";
import { MapMarker } from "./map_marker";
import { colourAt, exposed, linearAt } from "./linear";
import { byId, hex, isolatedLabel, lightPicture, lightPictureNames } from "./pictures";
import { Probe } from "./probe";
import { Presenter, type Overlays } from "./presenter";
import { initialLight, saveLight, type LightState } from "./state";
import { html, number } from "./svg";
import { Viewer, type Source } from "./viewer";

/** What a lecture shows in place of the live picture; `live`: its name. */
function overlaysOf(index: number, live: string): Overlays {
  const named = [
    ["rasterized", "picture-raster"],
    ["ray traced", "picture-raytraced"],
    ["labels", `picture-labels-${index}`],
  ] as const;
  return [
    [live, null],
    ...named.flatMap(([name, id]): Overlays => {
      const picture = byId(id);
      return picture ? [[name, picture]] : [];
    }),
  ];
}

export class LightPanel {
  private readonly state: LightState = { ...initialLight };
  private readonly made = new Map<string, ImageData | null>();
  private readonly viewer: Viewer;
  private readonly probe: Probe;
  private readonly labels: LabelTable;
  private readonly bias: BiasPanel | null;
  private readonly map: MapMarker | null;
  private readonly line: HTMLElement;
  private frame = 0;
  private passing = false; // the pointer is on its way, nothing is chosen
  private shown: Pixel;
  private coloured: number; // the bias that the picture shows

  constructor(
    private readonly light: Light,
    private readonly index: number,
    section: HTMLElement,
    best: number,
  ) {
    const root = section.querySelector<HTMLElement>(".viewer")!;
    this.line = root.querySelector(".probe")!;
    for (const pick of root.querySelectorAll("select"))
      for (const name of lightPictureNames(light)) pick.append(html("option", { value: name }, name));
    const host = html("div", { class: "pixel-probe" });
    root.after(host);
    this.probe = new Probe(light, index, host, this.state, () => this.redraw());
    this.labels = new LabelTable(section, index, light.label, (label) => this.choose(label));
    this.bias = BiasPanel.make(
      light,
      index,
      best,
      (bias) => {
        this.state.bias = bias;
        this.redraw();
      },
      (x, y) => this.pin(x, y),
    );
    const depths = section.querySelector<HTMLImageElement>(".depth img");
    this.map = depths && new MapMarker(light, depths);
    this.shown = examplePixel(light);
    this.viewer = new Viewer(root, this.state, page, {
      hover: (x, y) => this.hover(x, y),
      pin: (x, y) => this.pin(x, y),
      source: (name) => this.source(name),
      unpin: () => {
        this.state.pixel = null;
        this.redraw();
      },
      changed: () => saveLight(this.index, this.state),
    });
    const labelled = byId(`picture-labels-${index}`);
    if (labelled?.closest("#overview")) enlargeLabels(light, labelled);
    this.probe.show(this.shown, light.json.bias.constant);
    this.map?.show(this.shown);
    this.coloured = light.json.bias.constant;
    this.bias?.show(this.coloured);
    this.bias?.mark(this.shown.x, this.shown.y);
    const { words, drawing, bar, below } = this.probe;
    new Presenter(
      root.querySelector(".viewer-bar")!,
      `light ${light.json.name}`,
      {
        controls: this.bias ? [this.bias.bar, this.bias.said] : [],
        picture: this.bias?.picture ?? root.querySelector<HTMLElement>(".stage")!,
        drawing,
        words,
        section: [bar, below],
      },
      overlaysOf(index, this.bias ? "difference" : "as chosen"),
      (x, y) => this.step(x, y),
    );
  }

  private step(x: number, y: number): void {
    const within = (at: number, size: number) => Math.min(Math.max(at, 0), size - 1);
    this.pin(within(this.shown.x + x, page.width), within(this.shown.y + y, page.height));
  }

  restore(state: LightState): void {
    Object.assign(this.state, state);
    this.passing = false;
    if (state.pixel) this.state.pixel = [Math.min(state.pixel[0], page.width - 1), Math.min(state.pixel[1], page.height - 1)];
    if (this.state.pixel) this.read(...this.state.pixel);
    this.labels.show(state.label);
    this.update();
  }

  /** Writes what is looked at into the URL. */
  save(): void {
    saveLight(this.index, this.state);
  }

  private choose(label: string | null): void {
    this.state.label = label;
    if (label !== null) this.state.right = "labels";
    this.labels.show(label);
    const value = page.labels.find((words) => words.name === label)?.value;
    if (value !== undefined) {
      const pixel = examplePixel(this.light, value);
      this.state.pixel = [pixel.x, pixel.y];
      this.read(pixel.x, pixel.y);
    }
    this.redraw();
  }

  // Pictures that were made are kept, of those with an exposure or a label the last one.
  private source(name: string): Source | null {
    const { exposure, label } = this.state,
      linear = /^picture-(raster|raytraced)$/.exec(name)?.[1] as PictureName | undefined;
    const alone = /^picture-labels/.test(name) && label !== null ? page.labels.find((words) => words.name === label)?.value : undefined;
    const key = linear ? `${name} ${exposure}` : alone !== undefined ? `labels ${alone}` : name;
    if (!this.made.has(key)) {
      for (const old of [...this.made.keys()]) if (linear ? old.startsWith(name) : old.startsWith("labels ")) this.made.delete(old);
      this.made.set(
        key,
        linear
          ? exposed(this.light.pixels, linear, exposure)
          : alone !== undefined
            ? isolatedLabel(this.light.label, alone)
            : lightPicture(this.light, name),
      );
    }
    const image = byId(name);
    return this.made.get(key) ?? (image && { url: image.getAttribute("src")! });
  }

  // "rasterized #8a8a8a, linear 0.254 0.254 0.254"
  private colour(name: PictureName, index: number): string {
    return `${hex(colourAt(this.light.pixels, name, index))}, linear ${linearAt(this.light.pixels, name, index)
      .map((v) => number(v, 3))
      .join(" ")}`;
  }

  private read(x: number, y: number): void {
    this.shown = this.light.pixel(x, y);
    const { index, label } = this.shown,
      { flip, ssim } = this.light;
    this.line.textContent =
      `Pixel ${x}, ${y}: ${wordsOf(label).name}; rasterized ${this.colour("raster", index)}; ray traced ${this.colour(
        "raytraced",
        index,
      )}` +
      (flip && label >= 0 ? `; FLIP ${number(flip[index]! / 100, 2)}` : "") +
      (ssim && label >= 0 && ssim[index] !== -128 ? `, SSIM ${number(ssim[index]! / 100, 2)}` : "");
  }

  private hover(x: number, y: number): void {
    const pinned = this.shown;
    this.read(x, y);
    if (this.state.pixel)
      this.shown = pinned; // the line follows the pointer, the drawings stay
    else this.later(true);
  }

  private pin(x: number, y: number): void {
    this.state.pixel = [x, y];
    this.read(x, y);
    this.redraw();
  }

  private redraw(): void {
    saveLight(this.index, this.state);
    this.later();
  }

  // Many events become one drawing.
  private later(passing = false): void {
    this.passing = passing;
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.update();
    });
  }

  private update(): void {
    // A bias that cannot be dragged here is not taken from a link either: what was drawn has its own.
    const bias = (this.bias && this.state.bias) ?? this.light.json.bias.constant;
    this.viewer.show();
    this.probe.show(this.shown, bias, this.passing);
    this.map?.show(this.shown);
    if (bias !== this.coloured) this.bias?.show(bias);
    this.bias?.mark(this.shown.x, this.shown.y);
    this.coloured = bias;
  }
}
