// One cell of a sweep in pictures: its labels as codes (studies/sweep/engine.h), the ray-traced picture that it is
// compared with, and its drawing where it was drawn.
import { falseShadow, missedShadow, rgbOf, type Rgb } from "./colour_maps";
import { wordsOf } from "./data";
import type { SweepCell } from "./sweep_document";
import { unpack, type Packed } from "./packed";
import { isBeside, pageData, part } from "./parts";
import { isolatedLabel, painted } from "./pictures";

const nameOf = (cell: number): string => `cell-${String(cell).padStart(6, "0")}`;

/** Where a picture is. */
async function pictureUrl(name: string): Promise<string> {
  return isBeside ? `${pageData<{ folder: string }>().folder}/${name}.png` : part<string>(`${name}.png`);
}

// Loaded is enough: what draws it waits for its decoding. (decode() settles only with a frame of the page.)
function loaded(url: string): Promise<HTMLImageElement> {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error(`${isBeside ? url : "a picture of the cell"} cannot be read`));
    image.src = url;
  });
}

const trueShadow = 0x20,
  darker = 0x40,
  small = 0x80,
  labelMask = 0x1f,
  rightInShadow: Rgb = [198, 198, 194];

export class Cell {
  readonly labels: Int8Array;
  private readonly made = new Map<string, HTMLCanvasElement | ImageData>();

  private constructor(
    readonly json: SweepCell,
    readonly width: number,
    readonly height: number,
    private readonly codes: Int8Array,
    readonly truth: HTMLImageElement,
    readonly drawing: HTMLImageElement | null,
  ) {
    this.labels = codes.map((code) => (code & labelMask) - 4);
  }

  static async load(json: SweepCell): Promise<Cell> {
    const data = await part<{ width: number; height: number; truth: string; classes: Packed }>(nameOf(json.cell));
    const [codes, truth, drawing] = await Promise.all([
      unpack(data.classes),
      pictureUrl(data.truth).then(loaded),
      json.drawn ? pictureUrl(nameOf(json.cell)).then(loaded) : null,
    ]);
    return new Cell(json, data.width, data.height, codes as Int8Array, truth, drawing);
  }

  /** Wrong pixels by label. */
  counts(): Map<number, number> {
    const counts = new Map<number, number>();
    this.labels.forEach((label, i) => {
      if (!(this.codes[i]! & small)) counts.set(label, (counts.get(label) ?? 0) + 1);
    });
    return counts;
  }

  /** "acne, false shadow" */
  nameAt(index: number): string {
    const label = this.labels[index]!,
      words = wordsOf(label);
    return label > 0
      ? `${words.name}, ${
          this.codes[index]! & small
            ? `drawn too ${this.codes[index]! & darker ? "dark" : "light"}`
            : `${this.codes[index]! & darker ? "false" : "missed"} shadow`
        }`
      : words.name;
  }

  labelPicture(alone: number | null): ImageData {
    const key = `labels ${alone}`,
      size = { width: this.width, height: this.height };
    return this.keep(key, () => {
      if (alone !== null) return isolatedLabel(this.labels, alone, size);
      const colours = new Map<number, Rgb>();
      return painted((i) => {
        const code = this.codes[i]!,
          label = this.labels[i]!;
        if (label === 0 && code & trueShadow) return rightInShadow;
        const key = code & (labelMask | small | trueShadow);
        if (!colours.has(key)) {
          const whole = rgbOf(wordsOf(label).colour),
            right = code & trueShadow ? rightInShadow : rgbOf(wordsOf(0).colour);
          colours.set(key, code & small ? (whole.map((c, k) => (c + 2 * right[k]!) / 3) as unknown as Rgb) : whole);
        }
        return colours.get(key)!;
      }, size);
    }) as ImageData;
  }

  /** The ray-traced picture in grey with false and missed shadow in their colours. Nothing is read back: a picture beside
      the page may be shown, but not read. */
  difference(): HTMLCanvasElement {
    return this.keep("difference", () => {
      const [canvas, marks] = [0, 1].map(() =>
        Object.assign(document.createElement("canvas"), { width: this.width, height: this.height }),
      ) as [HTMLCanvasElement, HTMLCanvasElement];
      const errors = new ImageData(this.width, this.height),
        context = canvas.getContext("2d")!;
      this.codes.forEach((code, i) => {
        if (this.labels[i]! <= 0) return;
        const colour = code & darker ? falseShadow : missedShadow;
        errors.data.set([...colour, code & small ? 85 : 255], 4 * i);
      });
      marks.getContext("2d")!.putImageData(errors, 0, 0);
      context.filter = "grayscale(1) brightness(0.66)";
      context.drawImage(this.truth, 0, 0, this.width, this.height);
      context.filter = "none";
      context.globalCompositeOperation = "lighter";
      context.fillStyle = "rgb(64 64 64)";
      context.fillRect(0, 0, this.width, this.height);
      context.globalCompositeOperation = "source-over";
      context.drawImage(marks, 0, 0);
      return canvas;
    }) as HTMLCanvasElement;
  }

  private keep(key: string, make: () => HTMLCanvasElement | ImageData): HTMLCanvasElement | ImageData {
    if (!this.made.has(key)) this.made.set(key, make());
    return this.made.get(key)!;
  }
}
