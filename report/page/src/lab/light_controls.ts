// Where the light comes from: a disc of the sky to drag in, sliders, and of a sun the date, the hour and the latitude.
import { html, svg } from "../svg";
import { choiceRow, linearScale, panel, sliderRow, tidy, type Row } from "./controls";
import type { Drawn, LightPose } from "./engine";
import { dayOfYear, sunAt } from "./sun_place";

/** Options of the pose: "light-azimuth", ...; of a change "" takes one away. */
export type PoseChange = Record<string, string>;

const radius = 64;

const skyNote = "The sky seen from above: the middle is straight up, the rim the horizon. --light-azimuth, --light-elevation";

export class LightControls {
  private readonly names: Row;
  private readonly rows: Record<"azimuth" | "elevation" | "distance" | "size", Row>;
  private readonly sky: SVGElement;
  private readonly dot = svg("circle", { r: 6, class: "sky-dot" });
  private readonly place: HTMLElement;
  private lights: string[] = [];
  private pose: LightPose | null = null;

  constructor(
    root: HTMLElement,
    private readonly changed: (pose: PoseChange) => void,
  ) {
    const group = panel("Light", "light");
    this.names = choiceRow("Which", "The light that is compared and turned. --light", [], (name) => changed({ light: name }));
    const number = (name: string, unit: string, note: string, option: string, from: number, to: number): Row =>
      sliderRow(name, unit, note, linearScale(from, to, 360), (text) => this.set({ [option]: text }));
    this.rows = {
      azimuth: number("Comes from", "degrees", "0 is +z, 90 is +x. --light-azimuth", "light-azimuth", -180, 180),
      elevation: number(
        "Height",
        "degrees",
        "Above the horizon. The more the light grazes a surface, the more bias it needs. --light-elevation",
        "light-elevation",
        -90,
        90,
      ),
      distance: number("Distance", "of its own", "Of a lamp from the scene's centre. --light-distance", "light-distance", 0.1, 5),
      size: number(
        "Size",
        "",
        "A light with a size casts soft shadows; at 0 they are sharp. A sun's is in degrees across. --light-size",
        "light-size",
        0,
        10,
      ),
    };
    this.sky = svg(
      "svg",
      {
        class: "sky",
        viewBox: `${-radius - 8} ${-radius - 8} ${2 * radius + 16} ${2 * radius + 16}`,
        tabindex: 0,
        role: "application",
        "aria-label": "Place of the light in the sky; arrow keys move it",
      },
      svg("circle", { r: radius, class: "sky-rim" }),
      svg("circle", { r: radius / 2, class: "sky-half" }),
      svg("path", { d: `M${-radius} 0H${radius}M0 ${-radius}V${radius}`, class: "sky-half" }),
      this.dot,
    );
    this.place = this.sunPlace();
    group.append(
      this.names.element,
      this.sky as unknown as HTMLElement,
      html("p", { class: "note shown" }, skyNote),
      this.rows.azimuth.element,
      this.rows.elevation.element,
      this.rows.distance.element,
      this.rows.size.element,
      this.place,
    );
    root.append(group);
    this.listen();
  }

  private set(change: PoseChange): void {
    if (change["light-distance"] && this.pose)
      change = { "light-distance": String(tidy(Number(change["light-distance"]) * this.pose.own_distance)) };
    this.changed(change);
  }

  /** A sun stands where it does at that hour of that day. */
  private sunPlace(): HTMLElement {
    const date = html("input", { type: "date", value: "2026-03-20" }),
      hours = html("input", { type: "range", min: "4", max: "20", step: "0.25", value: "10" }),
      latitude = html("input", { type: "number", min: "-90", max: "90", step: "1", value: "45" }),
      said = html("output", {});
    const apply = (): void => {
      const day = dayOfYear(date.value),
        at = sunAt(day, Number(hours.value), Number(latitude.value));
      if (Number.isNaN(at.elevation)) return;
      const minutes = Math.round(60 * Number(hours.value)),
        clock = `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}`;
      said.textContent = at.elevation > 0 ? clock : `${clock}: the sun is below the horizon`;
      if (at.elevation > 0) this.changed({ "light-azimuth": String(tidy(at.azimuth)), "light-elevation": String(tidy(at.elevation)) });
    };
    for (const input of [date, hours, latitude]) input.addEventListener("input", apply);
    return html(
      "details",
      { class: "sun" },
      html("summary", {}, "Sun of a date and place"),
      html("label", {}, "Date ", date),
      html("label", {}, "Latitude, degrees north ", latitude),
      html("label", {}, "Solar time ", hours),
      said,
      html("p", { class: "note shown" }, "+z is south, +x is east."),
    );
  }

  private listen(): void {
    const turnTo = (azimuth: number, elevation: number): void =>
      this.changed({ "light-azimuth": String(tidy(azimuth)), "light-elevation": String(tidy(Math.min(Math.max(elevation, -90), 90))) });
    const drag = (event: PointerEvent): void => {
      const box = this.sky.getBoundingClientRect(),
        scale = (2 * radius + 16) / box.width;
      const x = (event.clientX - box.left - box.width / 2) * scale,
        y = (event.clientY - box.top - box.height / 2) * scale;
      turnTo((Math.atan2(x, y) * 180) / Math.PI, 90 * (1 - Math.min(Math.hypot(x, y) / radius, 1)));
    };
    this.sky.addEventListener("pointerdown", (event) => {
      this.sky.setPointerCapture(event.pointerId);
      drag(event);
    });
    this.sky.addEventListener("pointermove", (event) => {
      if (this.sky.hasPointerCapture(event.pointerId)) drag(event);
    });
    this.sky.addEventListener("keydown", (event) => {
      const step = ({ ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] } as Record<string, [number, number]>)[
        event.key
      ];
      if (!step || !this.pose) return;
      event.preventDefault();
      event.stopPropagation();
      turnTo(this.pose.azimuth + step[0], this.pose.elevation + step[1]);
    });
  }

  show({ light, scene }: Drawn): void {
    this.pose = light;
    if (scene.lights.join("\n") !== this.lights.join("\n")) {
      this.lights = scene.lights;
      this.names.element.querySelector("select")!.replaceChildren(...scene.lights.map((name) => html("option", { value: name }, name)));
    }
    this.names.element.hidden = scene.lights.length < 2;
    this.names.show(light.name);
    const out = radius * Math.min(1, 1 - light.elevation / 90),
      angle = (light.azimuth * Math.PI) / 180;
    this.dot.setAttribute("cx", String(out * Math.sin(angle)));
    this.dot.setAttribute("cy", String(out * Math.cos(angle)));
    this.rows.azimuth.show(String(tidy(light.azimuth)));
    this.rows.elevation.show(String(tidy(light.elevation)));
    this.rows.distance.element.hidden = light.distance === null || light.own_distance === 0;
    if (light.distance !== null) this.rows.distance.show(String(tidy(light.distance / light.own_distance)));
    this.rows.size.show(String(tidy(light.size)));
    this.place.hidden = !light.sun;
  }
}
