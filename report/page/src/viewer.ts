// Two pictures over each other or side by side, with one zoom and one position: swipe, flip, enlarge, point at pixels.
import { legend } from "./colour_maps";
import type { ViewState } from "./state";
import { number } from "./svg";

const clamp = (v: number, low: number, high: number): number => Math.min(Math.max(v, low), high);

export interface ViewerEvents {
  hover: (x: number, y: number) => void;
  pin: (x: number, y: number) => void;
  unpin: () => void;
  changed: () => void; // anything of the state
  source: (name: string) => Source | null; // of a picture, by its value in the menus; null: not there yet
}

/** A key that nothing on the page has the focus for; letters mean nothing to a button that was clicked last. */
function isNobodys(event: KeyboardEvent): boolean {
  const target = event.target as Element;
  return (
    target === document.body ||
    target === document.documentElement ||
    (target instanceof HTMLButtonElement && !(event.key in steps) && event.key.length === 1 && event.key !== " ")
  );
}

/** A picture by its address, as pixels, or drawn already. */
export type Source = { url: string } | ImageData | HTMLCanvasElement;

const steps: Record<string, readonly [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Viewer {
  private readonly stage: HTMLElement;
  private readonly panes: HTMLElement[];
  private readonly picks: HTMLSelectElement[];
  private readonly slider: HTMLInputElement;
  private readonly exposure: HTMLInputElement;
  private readonly markers: HTMLElement[];
  private readonly canvases: HTMLCanvasElement[];
  private readonly painted: (Source | null)[] = [null, null];
  private readonly legends = document.createElement("div");
  private last: readonly [number, number] | null = null; // the pixel read last
  private pinned: readonly [number, number] | null = null; // as it was last shown
  private drag: { divider: boolean; moved: boolean; x: number; y: number } | null = null;

  constructor(
    private readonly root: HTMLElement,
    private readonly state: ViewState,
    private readonly size: { width: number; height: number },
    private readonly events: ViewerEvents,
  ) {
    this.stage = root.querySelector(".stage")!;
    this.panes = [...this.stage.querySelectorAll<HTMLElement>(".pane")];
    this.picks = [...root.querySelectorAll<HTMLSelectElement>(".pick")];
    this.slider = root.querySelector(".slider input")!;
    this.exposure = root.querySelector(".exposure input")!;
    this.markers = this.panes.map((pane) => {
      const marker = document.createElement("div");
      marker.className = "marker";
      pane.append(marker);
      return marker;
    });
    this.canvases = this.panes.map((pane) => {
      const canvas = document.createElement("canvas");
      canvas.hidden = true;
      pane.querySelector("img")!.after(canvas);
      return canvas;
    });
    this.legends.className = "legends";
    this.stage.after(this.legends);
    this.stage.style.aspectRatio = "";
    this.listen();
    this.show();
    root.hidden = false;
  }

  /** After the state or a picture has changed. */
  show(): void {
    document.documentElement.style.setProperty("--ratio", String(this.size.width / this.size.height));
    [this.state.left, this.state.right].forEach((name, i) => {
      const pick = this.picks[i]!,
        option = [...pick.options].find((o) => o.textContent === name) ?? pick.options[i]!;
      pick.value = option.value;
      this.put(i, this.events.source(option.value), option.textContent!);
      this.panes[i]!.querySelector(".tag")!.textContent = option.textContent;
    });
    const names = this.picks.map((pick) => pick.selectedOptions[0]!.textContent!);
    this.legends.replaceChildren(...[...new Set(names)].flatMap((name) => legend(name) ?? []));
    this.draw();
  }

  // Pixels go onto the canvas, anything else into the image; of the two one is seen.
  private put(pane: number, source: Source | null, name: string): void {
    const image = this.panes[pane]!.querySelector("img")!,
      canvas = this.canvases[pane]!;
    image.hidden = source === null || source instanceof ImageData || source instanceof HTMLCanvasElement;
    canvas.hidden = !image.hidden;
    if (source === null) {
      canvas.width = this.size.width;
      canvas.height = this.size.height;
      this.painted[pane] = null;
    } else if ("url" in source) {
      if (image.getAttribute("src") !== source.url) image.src = source.url;
    } else if (this.painted[pane] !== source) {
      canvas.width = source.width;
      canvas.height = source.height;
      const context = canvas.getContext("2d")!;
      if (source instanceof ImageData) context.putImageData(source, 0, 0);
      else context.drawImage(source, 0, 0);
      this.painted[pane] = source;
    }
    canvas.setAttribute("aria-label", name);
    canvas.setAttribute("role", "img");
  }

  private draw(): void {
    const s = this.state;
    s.x = clamp(s.x, 1 - s.zoom, 0);
    s.y = clamp(s.y, 1 - s.zoom, 0);
    this.stage.dataset.mode = s.mode;
    this.stage.classList.toggle("enlarged", s.zoom > 1);
    this.panes.forEach((pane, i) => {
      for (const picture of pane.querySelectorAll<HTMLElement>("img, canvas"))
        picture.style.transform = `translate(${100 * s.x}%, ${100 * s.y}%) scale(${s.zoom})`;
      pane.classList.toggle("away", i !== s.front);
    });
    this.panes[1]!.style.clipPath = s.mode === "swipe" ? `inset(0 0 0 ${100 * s.split}%)` : "";
    this.stage.querySelector<HTMLElement>(".divider")!.style.left = `${100 * s.split}%`;
    this.slider.value = String(100 * s.split);
    this.slider.parentElement!.hidden = s.mode !== "swipe";
    this.exposure.value = String(s.exposure);
    this.exposure.setAttribute("aria-valuetext", `${number(s.exposure)} stop${Math.abs(s.exposure) === 1 ? "" : "s"}`);
    this.root.querySelector(".zoom-value")!.textContent = `${s.zoom < 10 ? s.zoom.toFixed(1).replace(".0", "") : Math.round(s.zoom)}×`;
    for (const button of this.root.querySelectorAll<HTMLElement>("button[data-mode]"))
      button.setAttribute("aria-pressed", String(button.dataset.mode === s.mode));
    this.mark();
  }

  private mark(): void {
    const { pixel, zoom, x, y } = this.state,
      page = this.size;
    // Steps start from a pixel that was pinned elsewhere: by a label, in the bias's picture, by a link.
    if (pixel !== this.pinned) this.last = (this.pinned = pixel) ?? this.last;
    for (const marker of this.markers) {
      marker.hidden = pixel === null || pixel[0] >= page.width || pixel[1] >= page.height;
      if (!pixel || marker.hidden) continue;
      marker.style.left = `${100 * (x + (zoom * pixel[0]) / page.width)}%`;
      marker.style.top = `${100 * (y + (zoom * pixel[1]) / page.height)}%`;
      marker.style.width = `${(100 * zoom) / page.width}%`;
      marker.style.height = `${(100 * zoom) / page.height}%`;
    }
  }

  private changed(): void {
    this.draw();
    this.events.changed();
  }

  // Zooms about a point given in units of the pane.
  private zoomTo(zoom: number, at = { x: 0.5, y: 0.5 }): void {
    const s = this.state,
      next = clamp(zoom, 1, 64);
    s.x = at.x - (at.x - s.x) * (next / s.zoom);
    s.y = at.y - (at.y - s.y) * (next / s.zoom);
    s.zoom = next;
    this.changed();
  }

  private paneAt(event: MouseEvent) {
    const under =
      this.panes.find((p) => {
        const box = p.getBoundingClientRect();
        return event.clientX >= box.left && event.clientX < box.right;
      }) ?? this.panes[0]!;
    const box = under.getBoundingClientRect();
    return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height, box };
  }

  private pixelAt(event: MouseEvent): readonly [number, number] | null {
    const at = this.paneAt(event),
      s = this.state,
      page = this.size;
    const x = Math.floor(((at.x - s.x) / s.zoom) * page.width),
      y = Math.floor(((at.y - s.y) / s.zoom) * page.height);
    return x >= 0 && y >= 0 && x < page.width && y < page.height ? [x, y] : null;
  }

  private moveDrag(event: PointerEvent): void {
    const drag = this.drag!,
      at = this.paneAt(event),
      s = this.state;
    if (!drag.moved && Math.hypot(event.clientX - drag.x, event.clientY - drag.y) < 4) return;
    drag.moved = true;
    if (drag.divider) s.split = clamp(at.x, 0, 1);
    else {
      s.x += (event.clientX - drag.x) / at.box.width;
      s.y += (event.clientY - drag.y) / at.box.height;
      drag.x = event.clientX;
      drag.y = event.clientY;
    }
    this.changed();
  }

  private listen(): void {
    const { stage, state, events } = this;
    stage.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !event.isPrimary) return; // a menu swallows the end of a drag; a second finger would jump
      const at = this.paneAt(event),
        near = Math.abs(at.x - state.split) * at.box.width < 16;
      this.drag = { divider: state.mode === "swipe" && (state.zoom === 1 || near), moved: false, x: event.clientX, y: event.clientY };
      stage.setPointerCapture(event.pointerId);
    });
    stage.addEventListener("pointermove", (event) => {
      if (!event.isPrimary) return;
      if (this.drag) return this.moveDrag(event);
      const pixel = this.pixelAt(event);
      if (pixel) events.hover(...(this.last = pixel));
    });
    stage.addEventListener("pointerup", (event) => {
      if (!event.isPrimary) return;
      const pixel = this.pixelAt(event);
      if (this.drag && !this.drag.moved && pixel) events.pin(...(this.last = pixel));
      this.drag = null;
    });
    stage.addEventListener("pointercancel", () => {
      this.drag = null;
    });
    stage.addEventListener("dblclick", (event) => this.zoomTo(state.zoom * 2, this.paneAt(event)));
    stage.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.metaKey) return; // plain scrolling stays the page's
        event.preventDefault();
        this.zoomTo(state.zoom * Math.exp(-0.01 * event.deltaY), this.paneAt(event));
      },
      { passive: false },
    );
    stage.addEventListener("keydown", (event) => this.take(event));
    document.addEventListener("keydown", (event) => {
      if (isNobodys(event) && this.isBeforeTheReader()) this.take(event);
    });
    this.listenToControls();
  }

  private listenToControls(): void {
    const { root, state } = this;
    for (const button of root.querySelectorAll<HTMLElement>("button[data-mode]"))
      button.addEventListener("click", () => {
        if (button.dataset.mode === "flip" && state.mode === "flip") state.front = 1 - state.front;
        state.mode = button.dataset.mode!;
        this.changed();
      });
    const zooms: Record<string, () => void> = {
      in: () => this.zoomTo(state.zoom * 1.5),
      out: () => this.zoomTo(state.zoom / 1.5),
      fit: () => this.zoomTo(1),
    };
    for (const button of root.querySelectorAll<HTMLElement>("[data-zoom]")) button.addEventListener("click", zooms[button.dataset.zoom!]!);
    this.slider.addEventListener("input", () => {
      state.split = Number(this.slider.value) / 100;
      this.changed();
    });
    this.exposure.addEventListener("input", () => {
      state.exposure = Number(this.exposure.value);
      this.show();
      this.events.changed();
    });
    this.picks.forEach((pick, i) =>
      pick.addEventListener("change", () => {
        state[i === 0 ? "left" : "right"] = pick.selectedOptions[0]!.textContent!;
        this.show();
        this.events.changed();
      }),
    );
  }

  private take(event: KeyboardEvent): void {
    if (!event.ctrlKey && !event.metaKey && !event.altKey && this.key(event)) event.preventDefault();
  }

  /** The middle of the window lies on the pictures: of two viewers on a page only one has it. */
  private isBeforeTheReader(): boolean {
    const { top, bottom, width } = this.stage.getBoundingClientRect(),
      middle = window.innerHeight / 2;
    return width > 0 && top < middle && bottom > middle && document.querySelector("dialog[open]") === null;
  }

  /** Whether the key meant something here. */
  private key(event: KeyboardEvent): boolean {
    const s = this.state,
      step = steps[event.key],
      page = this.size;
    if (step && event.shiftKey) {
      const from = this.last ?? s.pixel ?? [Math.floor(page.width / 2), Math.floor(page.height / 2)];
      this.last = [clamp(from[0] + step[0], 0, page.width - 1), clamp(from[1] + step[1], 0, page.height - 1)];
      this.events.pin(...this.last);
    } else if (step && s.zoom > 1) {
      s.x -= 0.1 * step[0];
      s.y -= 0.1 * step[1];
      this.changed();
    } else if (step && s.mode === "swipe" && step[0] !== 0) {
      s.split = clamp(s.split + 0.02 * step[0], 0, 1);
      this.changed();
    } else if (event.key === "f" || event.key === "F") {
      s.mode = "flip";
      s.front = 1 - s.front;
      this.changed();
    } else if (event.key === "+" || event.key === "=") this.zoomTo(s.zoom * 1.5);
    else if (event.key === "-") this.zoomTo(s.zoom / 1.5);
    else if (event.key === "0") this.zoomTo(1);
    else if (event.key === "Escape" && s.pixel) this.events.unpin();
    else return false;
    return true;
  }
}
