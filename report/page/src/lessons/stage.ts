// The drawing of a flatland: world units to those of an SVG, strokes, and a handle that can be dragged. Whoever has no pointer has the
// sliders below, one for each thing that is dragged.
import { html, svg } from "../svg";
import { length, sub, type Vec2 } from "./flatland";

const width = 960; // of the drawing, in its own units

const clamp = (v: number, low: number, high: number): number => Math.min(Math.max(v, low), high);

const nearest = (handles: Record<string, Vec2>, at: Vec2): string => {
  const away = (key: string) => length(sub(handles[key]!, at));
  return Object.keys(handles).reduce((a, b) => (away(b) < away(a) ? b : a));
};

export class Stage {
  readonly drawing: SVGSVGElement;
  private scale = 1;

  /** `window`: left, right, bottom, top. Where there are several handles, a drag holds the one nearest to its beginning, and says which. */
  constructor(
    private window: readonly [number, number, number, number],
    name: string,
    dragged: (at: Vec2, handle: string) => void,
    handles: () => Record<string, Vec2> = () => ({ "": [0, 0] }),
  ) {
    this.drawing = svg("svg", { class: "flatland", role: "img", "aria-label": name }) as SVGSVGElement;
    this.look(window);
    this.listen(dragged, handles);
    // A narrow window has larger letters, and what is not shown yet has no letters to measure.
    new ResizeObserver(() => this.arrangeLabels()).observe(this.drawing);
  }

  /** At another part of the plane from now on. */
  look(window: readonly [number, number, number, number]): void {
    const [left, right, bottom, top] = (this.window = window);
    this.scale = width / (right - left);
    this.drawing.setAttribute("viewBox", `0 0 ${width} ${Math.round((top - bottom) * this.scale)}`);
  }

  private listen(dragged: (at: Vec2, handle: string) => void, handles: () => Record<string, Vec2>): void {
    const held = new Map<number, string>(); // by pointers
    const drag = (event: PointerEvent) => {
      const handle = held.get(event.pointerId);
      if (handle !== undefined) dragged(this.place(event), handle);
    };
    this.drawing.classList.add("dragged");
    this.drawing.addEventListener("pointerdown", (event) => {
      this.drawing.setPointerCapture(event.pointerId);
      held.set(event.pointerId, nearest(handles(), this.place(event)));
      drag(event);
    });
    this.drawing.addEventListener("pointermove", drag);
    this.drawing.addEventListener("lostpointercapture", (event) => held.delete(event.pointerId));
  }

  /** Under a pointer. The drawing may be narrower than its element: on a slide it stands in the middle. */
  private place(event: PointerEvent): Vec2 {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.drawing.getScreenCTM()!.inverse());
    return [this.window[0] + x / this.scale, this.window[3] - y / this.scale];
  }

  x(at: Vec2): number {
    return (at[0] - this.window[0]) * this.scale;
  }
  y(at: Vec2): number {
    return (this.window[3] - at[1]) * this.scale;
  }
  units(world: number): number {
    return world * this.scale;
  }
  private text(at: Vec2): string {
    return `${this.x(at).toFixed(1)},${this.y(at).toFixed(1)}`;
  }

  path(kind: string, lines: Iterable<readonly Vec2[]>): SVGElement {
    let d = "";
    for (const points of lines) d += points.map((p, i) => `${i === 0 ? "M" : "L"}${this.text(p)}`).join("");
    return svg("path", { class: kind, d });
  }
  circle(kind: string, at: Vec2, radius: number): SVGElement {
    return svg("circle", { class: kind, cx: this.x(at), cy: this.y(at), r: radius });
  }
  label(kind: string, at: Vec2, words: string, dy = 0): SVGElement {
    return svg("text", { class: kind, x: this.x(at), y: this.y(at) + dy }, words);
  }
  put(...elements: SVGElement[]): void {
    this.drawing.replaceChildren(...elements);
    this.arrangeLabels();
  }

  /** Moves labels into the drawing, and up or down off those before them, by as little as it takes. */
  private arrangeLabels(): void {
    const placed: DOMRect[] = [],
      height = Math.round((this.window[3] - this.window[2]) * this.scale);
    for (const label of this.drawing.querySelectorAll("text")) {
      const box = label.getBBox(),
        x = clamp(box.x, 0, width - box.width);
      const fits = (y: number) => placed.every((p) => x + box.width <= p.x || p.right <= x || y + box.height <= p.y || p.bottom <= y);
      const inside = (y: number) => clamp(y, 0, height - box.height),
        home = inside(box.y);
      const places = [home, ...placed.flatMap((p) => [inside(p.y - box.height), inside(p.bottom)])].filter(fits);
      const y = places.sort((a, b) => Math.abs(a - home) - Math.abs(b - home))[0] ?? home;
      label.setAttribute("transform", `translate(${x - box.x} ${y - box.y})`);
      placed.push(new DOMRect(x, y, box.width, box.height));
    }
  }
}

export interface Slider {
  name: string;
  from: number;
  to: number;
  step: number;
  value: number;
  text: (value: number) => string; // beside it, and to be heard
  drags?: boolean; // the drawing is dragged for it as well: a lecture's slide leaves the slider out
}

/** Sliders by their keys, which show their values; `changed` is told once a frame. */
export class Sliders<Key extends string> {
  readonly bar = html("div", { class: "slider-bar" });
  private readonly ranges = {} as Record<Key, HTMLInputElement>;
  private readonly texts: (() => void)[] = [];
  private frame = 0;

  constructor(
    sliders: Record<Key, Slider>,
    private readonly changed: () => void,
  ) {
    for (const [key, { name, from, to, step, value, text, drags }] of Object.entries<Slider>(sliders)) {
      const range = html("input", {
        type: "range",
        min: String(from),
        max: String(to),
        step: String(step),
        value: String(value),
        "data-slider": key,
      });
      const shown = html("output", {});
      this.ranges[key as Key] = range;
      this.texts.push(() => {
        shown.textContent = text(Number(range.value));
        range.setAttribute("aria-valuetext", shown.textContent);
      });
      range.addEventListener("input", () => this.later());
      this.bar.append(html("label", drags ? { class: "drags" } : {}, html("span", {}, name), range, shown));
    }
    this.write();
  }
  value(key: Key): number {
    return Number(this.ranges[key].value);
  }
  set(key: Key, value: number): void {
    this.ranges[key].value = String(value);
    this.later();
  }
  private write(): void {
    for (const text of this.texts) text();
  }
  private later(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.write();
      this.changed();
    });
  }
}
