// A picture that is pointed at: by mouse or finger, and by arrow keys for who has neither.
import { html } from "../svg";

const arrows: Record<string, readonly [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const clamp = (v: number, high: number): number => Math.min(Math.max(v, 0), high);

export class PicturePointer {
  readonly canvas: HTMLCanvasElement;
  readonly frame: HTMLElement;
  private readonly marker = html("div", { class: "marker" });
  private x = 0;
  private y = 0;

  /** A canvas of so many pixels, with a marker over the chosen one. */
  constructor(
    private readonly size: { width: number; height: number },
    name: string,
    private readonly chosen: (x: number, y: number) => void,
  ) {
    this.canvas = html("canvas", {
      role: "application",
      "aria-label": name,
      tabindex: "0",
      "data-arrows": "",
      width: String(size.width),
      height: String(size.height),
    });
    this.frame = html("div", { class: "live-picture" }, this.canvas, this.marker);
    const pick = (event: PointerEvent) => {
      const box = this.canvas.getBoundingClientRect();
      this.choose(
        Math.floor(((event.clientX - box.left) / box.width) * size.width),
        Math.floor(((event.clientY - box.top) / box.height) * size.height),
      );
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (this.canvas.hasPointerCapture(event.pointerId)) pick(event);
    });
    this.canvas.addEventListener("keydown", (event) => {
      const way = arrows[event.key],
        far = event.shiftKey ? 10 : 1;
      if (!way) return;
      event.preventDefault();
      this.choose(this.x + far * way[0], this.y + far * way[1]);
    });
  }

  private choose(x: number, y: number): void {
    this.chosen(clamp(x, this.size.width - 1), clamp(y, this.size.height - 1));
  }

  /** Where the marker stands. */
  mark(x: number, y: number): void {
    [this.x, this.y] = [x, y];
    const { width, height } = this.size;
    Object.assign(this.marker.style, {
      left: `${(100 * x) / width}%`,
      top: `${(100 * y) / height}%`,
      width: `${100 / width}%`,
      height: `${100 / height}%`,
    });
  }

  put(image: ImageData): void {
    this.canvas.getContext("2d")!.putImageData(image, 0, 0);
  }
}
