// The pictures, in the report's viewer: two with a divider, side by side or in turn. A drag turns the camera or the light, or,
// while pictures are looked at, moves what is enlarged.
import type { ViewState } from "../state";
import { html } from "../svg";
import { markup } from "../template";
import { Viewer } from "../viewer";
import { viewerBlock } from "../viewer_block";
import { tidy } from "./controls";
import type { CameraPose, Drawn, Engine, LabFacts } from "./engine";

/** What a drag on the pictures does. */
type Tool = "camera" | "light" | "pictures";

const tools: readonly [tool: Tool, words: string, key: string][] = [
  ["camera", "Turn camera", "c"],
  ["light", "Turn light", "l"],
  ["pictures", "Move pictures", "p"],
];
const degreesPerPixel = 0.4,
  degreesPerKey = 5,
  zoomPerNotch = 1.15;
const highest = 89; // degrees, of the camera's elevation

export interface StageEvents {
  turnCamera: (pose: CameraPose) => void;
  turnLight: (azimuth: number, elevation: number) => void;
  pin: (x: number, y: number) => void;
  unpin: () => void;
}

const clamp = (value: number, limit: number): number => Math.min(Math.max(value, -limit), limit);
const wrapped = (degrees: number): number => ((((degrees + 180) % 360) + 360) % 360) - 180;

export class Stage {
  private readonly viewer: Viewer;
  private readonly state: ViewState = {
    left: "",
    right: "",
    mode: "swipe",
    split: 0.5,
    zoom: 1,
    x: 0,
    y: 0,
    front: 0,
    exposure: 0,
    pixel: null,
    label: null,
  };
  private readonly size = { width: 960, height: 540 };
  private readonly pictures = new Map<string, { version: string; canvas: HTMLCanvasElement }>();
  private readonly loading = new Map<string, string>();
  private readonly stage: HTMLElement;
  private tool: Tool = "camera";
  private drawn: Drawn | null = null;
  private held: { x: number; y: number; moved: boolean } | null = null;
  private readonly fingers = new Map<number, { x: number; y: number }>();

  constructor(
    root: HTMLElement,
    private readonly engine: Engine,
    facts: LabFacts,
    private readonly events: StageEvents,
  ) {
    const options = markup`${facts.pictures.map(({ name, title }) => markup`<option value="${name}">${title}</option>`)}`;
    root.innerHTML = viewerBlock(
      options,
      "lab",
      markup`Drag to turn the camera (C), the light (L), or to move enlarged pictures (P); a click explains a pixel. F flips, + and − enlarge,
Ctrl and the wheel come nearer.`,
      false,
    ).text;
    this.stage = root.querySelector(".stage")!;
    root.querySelector(".probe")!.remove();
    this.state.left = facts.pictures[0]!.title;
    this.state.right = facts.pictures.find(({ name }) => name === "labels")!.title;
    this.viewer = new Viewer(root.querySelector(".viewer")!, this.state, this.size, {
      hover: () => undefined,
      unpin: () => {
        this.state.pixel = null;
        this.viewer.show();
        events.unpin();
      },
      pin: (x, y) => this.pin(x, y),
      changed: () => undefined,
      source: (name) => {
        this.fetch(name);
        return this.pictures.get(name)?.canvas ?? null;
      },
    });
    root.querySelector(".viewer-bar")!.prepend(this.toolButtons());
    this.listen();
    this.choose("camera");
  }

  private toolButtons(): HTMLElement {
    const bar = html("span", { class: "modes", role: "group", "aria-label": "What a drag does" });
    for (const [tool, words] of tools) {
      const button = html("button", { type: "button", "data-tool": tool }, words);
      button.addEventListener("click", () => this.choose(tool));
      bar.append(button);
    }
    return bar;
  }

  private choose(tool: Tool): void {
    this.tool = tool;
    this.stage.dataset.tool = tool;
    for (const button of this.stage.parentElement!.querySelectorAll<HTMLElement>("button[data-tool]"))
      button.setAttribute("aria-pressed", String(button.dataset.tool === tool));
  }

  private pin(x: number, y: number): void {
    this.state.pixel = [x, y];
    this.viewer.show();
    this.events.pin(x, y);
  }

  pinned(): readonly [number, number] | null {
    return this.state.pixel;
  }

  // Of the rasterizer's picture there is another for each revision, of all others for each comparison.
  private versionOf(name: string): string {
    if (!this.drawn) return "";
    return name === "raster" || this.drawn.compared === 0
      ? `${this.drawn.drawn}`
      : `${this.drawn.compared}${this.drawn.preview ? "p" : ""}`;
  }

  private fetch(name: string): void {
    const version = this.versionOf(name);
    if (version === "" || version === "0" || this.pictures.get(name)?.version === version || this.loading.get(name) === version) return;
    this.loading.set(name, version);
    void this.engine
      .picture(name)
      .then(
        (canvas) => {
          this.pictures.set(name, { version, canvas });
          this.viewer.show();
        },
        () => undefined,
      )
      .finally(() => {
        if (this.loading.get(name) === version) this.loading.delete(name);
      });
  }

  show(drawn: Drawn): void {
    this.drawn = drawn;
    this.size.width = drawn.size.width;
    this.size.height = drawn.size.height;
    this.viewer.show();
  }

  private turn(right: number, up: number): void {
    if (!this.drawn) return;
    const { camera, light } = this.drawn;
    if (this.tool === "light") {
      light.azimuth = wrapped(light.azimuth + right);
      light.elevation = clamp(light.elevation + up, 90);
      this.events.turnLight(tidy(light.azimuth), tidy(light.elevation));
    } else {
      camera.azimuth = wrapped(camera.azimuth - right);
      camera.elevation = clamp(camera.elevation - up, highest);
      this.events.turnCamera(camera);
    }
  }

  private comeNearer(factor: number): void {
    if (!this.drawn) return;
    this.drawn.camera.distance = tidy(this.drawn.camera.distance / factor);
    this.events.turnCamera(this.drawn.camera);
  }

  private isNearDivider(event: PointerEvent): boolean {
    const box = this.stage.getBoundingClientRect();
    return this.state.mode === "swipe" && Math.abs((event.clientX - box.left) / box.width - this.state.split) * box.width < 16;
  }

  private spread(): number {
    const [a, b] = [...this.fingers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  // Before the viewer sees what is done to the stage: it has what is not taken here.
  private listen(): void {
    const before = { capture: true },
      outer = this.stage.parentElement!;
    const onStage = (event: Event): boolean => this.stage.contains(event.target as Node);
    outer.addEventListener(
      "pointerdown",
      (event) => {
        if (!onStage(event) || event.button !== 0 || this.tool === "pictures" || this.isNearDivider(event)) return;
        event.stopPropagation();
        this.stage.focus({ preventScroll: true });
        this.stage.setPointerCapture(event.pointerId);
        this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        this.held = { x: event.clientX, y: event.clientY, moved: this.fingers.size > 1 };
      },
      before,
    );
    outer.addEventListener(
      "pointermove",
      (event) => {
        if (!this.held || !this.fingers.has(event.pointerId)) return;
        event.stopPropagation();
        const wide = this.spread();
        this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        if (this.fingers.size > 1) return wide > 0 ? this.comeNearer(this.spread() / wide) : undefined;
        const right = event.clientX - this.held.x,
          up = this.held.y - event.clientY;
        if (!this.held.moved && Math.hypot(right, up) < 4) return;
        this.held = { x: event.clientX, y: event.clientY, moved: true };
        this.turn(degreesPerPixel * right, degreesPerPixel * up);
      },
      before,
    );
    const end = (event: PointerEvent): void => {
      if (!this.fingers.delete(event.pointerId)) return;
      event.stopPropagation();
      const box = this.stage.getBoundingClientRect(),
        wasClick = this.held && !this.held.moved && event.type === "pointerup";
      if (this.fingers.size === 0) this.held = null;
      if (!wasClick) return;
      const share = this.shareAt(event, box);
      if (share) this.pin(Math.floor(share.x * this.size.width), Math.floor(share.y * this.size.height));
    };
    outer.addEventListener("pointerup", end, before);
    outer.addEventListener("pointercancel", end, before);
    outer.addEventListener(
      "wheel",
      (event) => {
        if (!onStage(event) || this.tool === "pictures" || !(event.ctrlKey || event.metaKey)) return;
        event.preventDefault();
        event.stopPropagation();
        this.comeNearer(event.deltaY < 0 ? zoomPerNotch : 1 / zoomPerNotch);
      },
      { capture: true, passive: false },
    );
    outer.addEventListener("keydown", (event) => this.key(event), before);
  }

  /** Where in the picture a pointer is, shares of its sides; null beside it. */
  private shareAt(event: PointerEvent, box: DOMRect): { x: number; y: number } | null {
    const { zoom, x, y, mode } = this.state,
      panes = [...this.stage.querySelectorAll(".pane")].map((pane) => pane.getBoundingClientRect());
    const pane = mode === "side" ? (panes.find(({ left, right }) => event.clientX >= left && event.clientX < right) ?? box) : box;
    const at = { x: ((event.clientX - pane.left) / pane.width - x) / zoom, y: ((event.clientY - pane.top) / pane.height - y) / zoom };
    return at.x >= 0 && at.y >= 0 && at.x < 1 && at.y < 1 ? at : null;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target !== this.stage) return;
    const tool = tools.find(([, , key]) => key === event.key.toLowerCase());
    const step = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] } as Record<string, [number, number]>)[
      event.key
    ];
    if (tool) this.choose(tool[0]);
    else if (step && !event.shiftKey && this.tool !== "pictures") this.turn(degreesPerKey * step[0], degreesPerKey * step[1]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
