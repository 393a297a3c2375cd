// Every constant bias from one render. A hard test shadows a pixel exactly when its gap exceeds the bias. So moving the
// slider (or the line in the chart) recolours the picture and counts again without rendering.
import { page, type Light } from "./data";
import { backdropOf, recolour } from "./pictures";
import { GapHistogram } from "./histogram";
import { counted, grouped, percent, texelsText } from "./number_text";
import { html, number, svg } from "./svg";
import { otherParts } from "./words";

interface Chart {
  drawing: SVGSVGElement;
  left: number;
  right: number;
  from: number;
  to: number;
  line: SVGElement;
}

export class BiasPanel {
  private readonly range = html("input", { type: "range", min: "0", max: "1000", step: "1" });
  private readonly exact = html("input", { type: "number", step: "any", inputmode: "decimal" });
  readonly said = html("p", { class: "bias-counts", role: "status" });
  private readonly canvas = html("canvas", { role: "img", tabindex: "-1" });
  private readonly marker = html("div", { class: "marker" });
  readonly picture = html("div", { class: "bias-picture" }, this.canvas, this.marker);
  readonly bar: HTMLElement;
  private readonly chart: Chart;
  private readonly image: ImageData;
  private readonly backdrop: Uint32Array;
  private readonly compared: number;
  private readonly histogram: GapHistogram;
  private readonly kind: string; // what is dragged

  private constructor(
    private readonly light: Light,
    chart: SVGSVGElement,
    host: Element,
    best: number,
    private readonly chosen: (bias: number) => void,
    pin: (x: number, y: number) => void,
  ) {
    this.kind = otherParts(light.json.bias) === "" ? "bias" : "constant bias";
    const number_ = (key: string) => Number(chart.dataset[key]);
    const line = svg("line", { class: "chosen", y1: number_("top"), y2: number_("bottom") });
    chart.append(line);
    this.chart = { drawing: chart, left: number_("left"), right: number_("right"), from: number_("from"), to: number_("to"), line };
    this.canvas.width = page.width;
    this.canvas.height = page.height;
    this.image = new ImageData(page.width, page.height);
    this.backdrop = backdropOf(light.pixels);
    this.compared = light.label.reduce((sum, label) => sum + (label >= 0 ? 1 : 0), 0);
    this.histogram = new GapHistogram(light, Number(chart.dataset.to), light.json.name);
    const button = (name: string, bias: number) => {
      const b = html("button", { type: "button" }, name);
      b.addEventListener("click", () => chosen(bias));
      return b;
    };
    this.bar = html(
      "div",
      { class: "bias-bar" },
      html("label", {}, `${this.kind[0]!.toUpperCase()}${this.kind.slice(1)} `, this.range),
      html("label", {}, "world units ", this.exact),
      button("as rendered", light.json.bias.constant),
      button("best", best),
    );
    host.append(
      html(
        "div",
        { class: "bias-live" },
        this.bar,
        this.said,
        html(
          "figure",
          {},
          this.picture,
          html(
            "figcaption",
            {},
            "What this bias would draw wrong, counted and coloured from the gaps, without rendering: orange false shadow, light blue missed shadow.",
          ),
        ),
      ),
      this.histogram.figure,
    );
    this.listen(pin);
  }

  static make(
    light: Light,
    index: number,
    best: number,
    chosen: (bias: number) => void,
    pin: (x: number, y: number) => void,
  ): BiasPanel | null {
    const chart = document.getElementById(`bias-${index}-title`)?.closest("svg");
    return chart ? BiasPanel.of(light, chart, best, chosen, pin) : null;
  }

  /** With the chart that the writer drew. */
  static of(
    light: Light,
    chart: SVGSVGElement,
    best: number,
    chosen: (bias: number) => void,
    pin: (x: number, y: number) => void,
  ): BiasPanel | null {
    if (!light.json.gaps_decide) {
      if (light.json.compares_depths)
        hostAfter(chart).append(
          html(
            "p",
            { class: "hint" },
            `This curve is of hard tests. What ${light.json.technique} draws does not follow from one gap, so that its bias cannot be dragged here: ` +
              "gnomon sweep SCENE --bias 0:0.1:16 draws each bias by itself.",
          ),
        );
      return null;
    }
    return new BiasPanel(light, chart, hostAfter(chart), best, chosen, pin);
  }

  show(bias: number): void {
    const { from, to, left, right, line } = this.chart;
    const share = Math.min(Math.max((bias - from) / (to - from), 0), 1),
      x = left + share * (right - left);
    line.setAttribute("x1", String(x));
    line.setAttribute("x2", String(x));
    this.histogram.show(bias);
    this.range.value = String(Math.round(1000 * share));
    this.range.setAttribute("aria-valuetext", `${number(bias)} world units`);
    if (Number(this.exact.value) !== bias || this.exact.value === "") this.exact.value = String(Number(bias.toPrecision(6)));
    const counts = recolour(this.light, bias, this.backdrop, new Uint32Array(this.image.data.buffer));
    this.canvas.getContext("2d", { willReadFrequently: true })!.putImageData(this.image, 0, 0);
    const wrong = counts.falseShadow + counts.missedShadow + counts.ties / 2,
      texels = bias / this.light.json.texel_world;
    this.said.dataset.bias = String(bias);
    this.said.dataset.falseShadow = String(counts.falseShadow);
    this.said.dataset.missedShadow = String(counts.missedShadow);
    this.said.textContent =
      `At a ${this.kind} of ${number(bias)} (${texelsText(texels)}) ${percent(wrong / Math.max(1, this.compared))} ` +
      `of the compared pixels are wrong: ${counted(
        counts.falseShadow,
        "pixel",
      )} in false shadow, ${grouped(counts.missedShadow)} in missed shadow` +
      `${counts.ties > 0 ? `, ${grouped(counts.ties)} off by exactly one half (two count as one wrong)` : ""}.`;
    this.canvas.setAttribute("aria-label", `The picture with what is wrong at this bias. ${this.said.textContent}`);
  }

  private biasAt(share: number): number {
    const { from, to } = this.chart;
    return from + Math.min(Math.max(share, 0), 1) * (to - from);
  }

  private listen(pin: (x: number, y: number) => void): void {
    this.range.addEventListener("input", () => this.chosen(this.biasAt(Number(this.range.value) / 1000)));
    this.exact.addEventListener("change", () => {
      const bias = Number(this.exact.value);
      if (this.exact.value !== "" && isFinite(bias)) this.chosen(bias);
    });
    const { drawing, left, right } = this.chart;
    const drag = (event: PointerEvent) => {
      const box = drawing.getBoundingClientRect(),
        x = ((event.clientX - box.left) / box.width) * drawing.viewBox.baseVal.width;
      this.chosen(this.biasAt((x - left) / (right - left)));
    };
    let dragging = false;
    drawing.classList.add("live");
    drawing.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      dragging = true;
      drawing.setPointerCapture(event.pointerId);
      drag(event);
    });
    drawing.addEventListener("pointermove", (event) => {
      if (dragging) drag(event);
    });
    for (const end of ["pointerup", "pointercancel"])
      drawing.addEventListener(end, () => {
        dragging = false;
      });
    const pick = (event: PointerEvent) => {
      const box = this.canvas.getBoundingClientRect(),
        at = (share: number, size: number) => Math.floor(Math.min(Math.max(share, 0), 1) * (size - 1e-6));
      pin(at((event.clientX - box.left) / box.width, page.width), at((event.clientY - box.top) / box.height, page.height));
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.canvas.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (this.canvas.hasPointerCapture(event.pointerId)) pick(event);
    });
  }

  /** Where the probed pixel is. */
  mark(x: number, y: number): void {
    Object.assign(this.marker.style, {
      left: `${(100 * x) / page.width}%`,
      top: `${(100 * y) / page.height}%`,
      width: `${100 / page.width}%`,
      height: `${100 / page.height}%`,
    });
  }
}

// A place right after the chart's scrolling block.
function hostAfter(chart: Element): Element {
  const host = html("div");
  chart.closest(".scroll")!.after(host);
  return host;
}
