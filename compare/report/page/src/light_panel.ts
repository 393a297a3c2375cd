// One light's section brought to life: viewer, probe, label table and bias act on one state, which the URL keeps.
import { BiasPanel } from "./bias";
import { page, wordsOf, type Light, type Pixel } from "./data";
import { LabelTable } from "./labels";
import { MapMarker } from "./map_marker";
import { byId, colourAt, dataUrl, gapPicture, truthPicture } from "./pictures";
import { Probe } from "./probe";
import { initial, saveHash, type ViewState } from "./state";
import { html } from "./svg";
import { Viewer } from "./viewer";

export class LightPanel {
  private readonly state: ViewState = { ...initial };
  private readonly made = new Map<string, string>();
  private readonly viewer: Viewer;
  private readonly probe: Probe;
  private readonly labels: LabelTable;
  private readonly bias: BiasPanel | null;
  private readonly map: MapMarker;
  private readonly line: HTMLElement;
  private frame = 0;
  private passing = false;  // the pointer is on its way, nothing is chosen
  private shown: Pixel;
  private coloured: number;  // the bias that the picture shows

  constructor(private readonly light: Light, private readonly index: number, section: HTMLElement, best: number) {
    const root = section.querySelector<HTMLElement>(".viewer")!;
    this.line = root.querySelector(".probe")!;
    for (const pick of root.querySelectorAll("select"))
      for (const name of ["truth", "gap"]) pick.append(html("option", { value: name }, name));
    const host = html("div", { class: "pixel-probe" });
    root.after(host);
    this.probe = new Probe(light, index, host, this.state, () => this.redraw());
    this.labels = new LabelTable(section, (label) => this.choose(label));
    this.bias = BiasPanel.make(light, index, best, (bias) => { this.state.bias = bias; this.redraw(); }, (x, y) => this.pin(x, y));
    this.map = new MapMarker(light, section.querySelector<HTMLImageElement>(".depth img")!);
    this.shown = this.example();
    this.viewer = new Viewer(root, this.state, {
      hover: (x, y) => this.hover(x, y), pin: (x, y) => this.pin(x, y), source: (name) => this.source(name),
      unpin: () => { this.state.pixel = null; this.redraw(); }, changed: () => saveHash(this.index, this.state),
    });
    this.probe.show(this.shown, light.json.bias.constant);
    this.map.show(this.shown);
    this.coloured = light.json.bias.constant;
    this.bias?.show(this.coloured);
  }

  restore(state: ViewState): void {
    Object.assign(this.state, state);
    for (const slope of document.querySelectorAll("#exposure [slope]")) slope.setAttribute("slope", String(2 ** state.exposure));
    this.passing = false;
    if (state.pixel) this.read(Math.min(state.pixel[0], page.width - 1), Math.min(state.pixel[1], page.height - 1));
    this.labels.show(state.label);
    this.update();
  }

  // The commonest label's pixel nearest to the picture's middle, to begin with something to see.
  private example(label?: number): Pixel {
    const counts = new Map<number, number>();
    if (label === undefined) for (const l of this.light.label) counts.set(l, (counts.get(l) ?? 0) + 1);
    const rank = (l: number) => (l > 0 ? 2e9 : l === 0 ? 1e9 : 0) + counts.get(l)!;
    const wanted = label ?? [...counts.keys()].sort((a, b) => rank(b) - rank(a))[0]!;
    let best = 0, least = Infinity;
    this.light.label.forEach((l, i) => {
      const away = Math.hypot((i % page.width) - page.width / 2, Math.floor(i / page.width) - page.height / 2);
      if (l === wanted && away < least) [best, least] = [i, away];
    });
    return this.light.pixel(best % page.width, Math.floor(best / page.width));
  }

  private choose(label: string | null): void {
    this.state.label = label;
    this.labels.show(label);
    const value = page.labels.find((words) => words.name === label)?.value;
    if (value !== undefined) {
      const pixel = this.example(value);
      this.state.pixel = [pixel.x, pixel.y];
      this.read(pixel.x, pixel.y);
    }
    this.redraw();
  }

  private source(name: string): string | null {
    if (name !== "truth" && name !== "gap") return Viewer.onPage(name);
    if (!this.made.has(name)) this.made.set(name, dataUrl(name === "truth" ? truthPicture(this.light) : gapPicture(this.light)));
    return this.made.get(name)!;
  }

  private read(x: number, y: number): void {
    this.shown = this.light.pixel(x, y);
    this.line.textContent = `Pixel ${x}, ${y}: ${wordsOf(this.shown.label).name}; rasterized ${colourAt(byId("picture-raster"), x, y)}, ` +
      `ray traced ${colourAt(byId("picture-raytraced"), x, y)}`;
  }

  private hover(x: number, y: number): void {
    const pinned = this.shown;
    this.read(x, y);
    if (this.state.pixel) this.shown = pinned;  // the line follows the pointer, the drawings stay
    else this.later(true);
  }

  private pin(x: number, y: number): void {
    this.state.pixel = [x, y];
    this.read(x, y);
    this.redraw();
  }

  private redraw(): void {
    saveHash(this.index, this.state);
    this.later();
  }

  // Many events become one drawing.
  private later(passing = false): void {
    this.passing = passing;
    this.frame ||= requestAnimationFrame(() => { this.frame = 0; this.update(); });
  }

  private update(): void {
    const bias = this.state.bias ?? this.light.json.bias.constant;
    this.viewer.show();
    this.probe.show(this.shown, bias, this.passing);
    this.map.show(this.shown);
    if (bias !== this.coloured) this.bias?.show(bias);
    this.coloured = bias;
  }
}
