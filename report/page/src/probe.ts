// The probe: one pixel's ladder with its numbers, the light-space drawing and the cross-section.
import { page, wordsOf, geometry, type Geometry, type Light, type Pixel } from "./data";
import { html, number } from "./svg";
import { sectionAxis, sectionDrawing } from "./section_drawing";
import type { LightState } from "./state";
import { texelDrawing } from "./texel_drawing";
import { decidingStep, ofRays, otherParts, remarks, story } from "./words";

function ladder(pixel: Pixel): HTMLElement {
  const deciding = decidingStep(pixel),
    body = html("tbody");
  page.rungs.forEach((rung, k) => {
    const step = k === 0 ? 0 : pixel.rungs[k]! - pixel.rungs[k - 1]!;
    const row = html(
      "tr",
      { class: k > 0 && k === deciding ? "deciding" : "" },
      html("th", { scope: "row" }, html("i", {}, "V"), html("sub", {}, String(k)), ` ${rung.name}`),
      html("td", { class: "n" }, number(pixel.rungs[k]!)),
      html("td", { class: "n" }, k === 0 ? "" : step === 0 ? "0" : (step > 0 ? "+" : "") + number(step)),
      html("td", {}, k === 0 ? "" : (rung.step ?? "") + (k === deciding ? " ← here" : "")),
    );
    body.append(row);
  });
  return html(
    "table",
    { class: "pixel-ladder" },
    html("caption", {}, "Its ladder: 1 is lit, 0 in shadow"),
    html(
      "thead",
      {},
      html(
        "tr",
        {},
        ...["visibility", "value", "step", "charged to"].map((name, i) =>
          html("th", { scope: "col", class: i === 1 || i === 2 ? "n" : "" }, name),
        ),
      ),
    ),
    body,
  );
}

function facts(light: Light, pixel: Pixel): HTMLElement {
  const parts = otherParts(light.json.bias),
    beyond = parts === "" ? "" : ` beyond ${parts}`;
  const perTexel = light.json.bias.scales ? ` for a texel of ${number(light.json.texel_world, 3)}` : ""; // as the bias is
  const rows: [string, string, string][] = [
    ["gap", number(pixel.gap, 6), isFinite(pixel.gap) ? `world units${perTexel}${beyond}, to ${number(light.json.depth_step, 1)}` : ""],
    [
      "texel",
      `${number(pixel.at.u, 6)}, ${number(pixel.at.v, 6)}`,
      light.json.view.faces.length === 1
        ? "u, v"
        : light.json.view.perspective
          ? `u, v on face ${["+x", "−x", "+y", "−y", "+z", "−z"][pixel.face]}`
          : `u, v in cascade ${pixel.face + 1}`,
    ],
    ["distance", number(pixel.distance, 6), light.json.view.perspective ? "from the light" : "along the light, from the map's origin"],
    ["primitive", String(pixel.primitive), ""],
  ];
  const list = html("dl", { class: "pixel-facts" });
  for (const [name, value, unit] of rows)
    list.append(
      html("div", {}, html("dt", {}, name), html("dd", { "data-fact": name }, value, ...(unit ? [" ", html("span", {}, unit)] : []))),
    );
  return list;
}

// A row of buttons of which one is pressed.
function choice(name: string, key: string, entries: [string, string][], chosen: (value: string) => void): HTMLElement {
  const group = html("div", { class: "modes", role: "group", "aria-label": name });
  for (const [value, text] of entries) {
    const button = html("button", { type: "button", [`data-${key}`]: value }, text);
    button.addEventListener("click", () => chosen(value));
    group.append(button);
  }
  return group;
}

function press(group: HTMLElement, key: string, value: string): void {
  for (const button of group.querySelectorAll("button")) button.setAttribute("aria-pressed", String(button.dataset[key] === value));
}

export class Probe {
  readonly words = html("div", { class: "probe-words" });
  readonly drawing = html("div", { class: "probe-drawing" });
  readonly bar: HTMLElement; // of the cross-section
  readonly below = html("div", { class: "probe-section" });
  private readonly widths: HTMLElement;
  private readonly ways: HTMLElement;
  private scene: Geometry | null = null;
  private missing = ""; // why the scene cannot be cut
  private resting = 0;
  private shown: { pixel: Pixel; bias: number } | null = null;

  constructor(
    private readonly light: Light,
    private readonly index: number,
    host: Element,
    private readonly state: LightState,
    changed: () => void,
  ) {
    const size = light.json.view.size;
    const widths = [8, 16, 64, 256, size].filter((t, i, all) => t <= size && all.indexOf(t) === i);
    this.widths = choice(
      "Width of the cross-section",
      "texels",
      widths.map((t) => [String(t), t === size ? "all" : `± ${t}`]),
      (value) => {
        state.texels = Number(value);
        changed();
      },
    );
    this.ways = choice(
      "Way across the map",
      "cut",
      [
        ["row", "row"],
        ["column", "column"],
      ],
      (value) => {
        state.cut = value;
        changed();
      },
    );
    this.bar = html("div", { class: "section-bar" }, html("h3", {}, "The cross-section"), this.ways, this.widths);
    const known = light.json.map_known;
    this.bar.hidden = !known || ofRays();
    host.append(
      html("h3", {}, known && !ofRays() ? "One pixel, in light space" : "One pixel"),
      html("div", { class: "probe-body" }, this.words, this.drawing),
      this.bar,
      this.below,
    );
    void geometry()
      .then(
        (scene) => {
          this.scene = scene;
        },
        (error: Error) => {
          this.missing = `The cross-section is missing: ${error.message}.`;
        },
      )
      .then(() => this.redraw());
  }

  /** The cross-section of a pixel only passed over waits until the pointer rests. */
  show(pixel: Pixel, bias: number, passing = false): void {
    this.shown = { pixel, bias };
    this.redraw(passing);
  }

  private redraw(passing = false): void {
    if (!this.shown) return;
    const { pixel, bias } = this.shown,
      words = wordsOf(pixel.label),
      id = `probe-${this.index}`;
    const known = this.light.json.map_known,
      drawable = known && !ofRays() && pixel.seen && isFinite(pixel.at.depth);
    const axis = drawable ? sectionAxis(this.light, pixel, this.state.cut) : 0;
    press(this.widths, "texels", String(this.state.texels));
    press(this.ways, "cut", axis === 0 ? "row" : "column");
    const swatch = html("span", { class: "dot-swatch" });
    swatch.style.background = words.colour;
    this.words.replaceChildren(
      html("p", { class: "pixel-title" }, swatch, ` Pixel ${pixel.x}, ${pixel.y}: ${words.name}`),
      html("p", { class: "story" }, story(this.light, pixel, bias)),
      ...remarks(pixel).map((text) => html("p", { class: "remark" }, text)),
      ...(pixel.seen && known ? [ladder(pixel), ofRays() ? "" : facts(this.light, pixel)] : []),
    );
    this.drawing.replaceChildren(...(drawable ? [texelDrawing(this.light, pixel, bias, `${id}-texel`)] : []));
    window.clearTimeout(this.resting);
    const section = () =>
      this.below.replaceChildren(
        drawable
          ? this.scene
            ? sectionDrawing(this.light, pixel, this.scene, axis, this.state.texels, bias, `${id}-cut`)
            : html("p", {}, this.missing)
          : known && !ofRays()
            ? html("p", {}, "No surface here to cut through.")
            : "",
      );
    if (passing) this.resting = window.setTimeout(section, 120);
    else section();
  }
}
