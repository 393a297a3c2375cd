// The frames of a film of shadows (../../../shimmer/film.h), decoded when they are asked for and kept as long as they fit.

export interface FilmJson {
  seen: string[]; // red V6, green V0, blue bits: V1 … V5, counted, outside the map
  flips: string[]; // red: the label of the flip that led to the frame + 1; 0: none
}

export interface Frame {
  seen: Uint8ClampedArray; // four a pixel
  flips: Uint8Array; // one a pixel
}

const keptBytes = 320e6;

export class Decoder {
  private readonly context: CanvasRenderingContext2D;
  constructor(
    readonly width: number,
    readonly height: number,
  ) {
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = height;
    this.context = canvas.getContext("2d", { willReadFrequently: true })!;
  }
  async pixels(url: string): Promise<Uint8ClampedArray> {
    const image = new Image();
    image.src = url;
    await image.decode();
    this.context.drawImage(image, 0, 0);
    return this.context.getImageData(0, 0, this.width, this.height).data;
  }
}

export class FilmFrames {
  readonly count: number;
  private readonly kept = new Map<number, Promise<Frame>>();
  constructor(
    private readonly json: FilmJson,
    private readonly decoder: Decoder,
  ) {
    this.count = json.seen.length;
  }

  frame(index: number): Promise<Frame> {
    const known = this.kept.get(index);
    if (known) return known;
    const most = Math.max(2, Math.floor(keptBytes / (5 * this.decoder.width * this.decoder.height)));
    if (this.kept.size >= most) this.kept.delete(this.kept.keys().next().value!);
    const made = this.decode(index);
    this.kept.set(index, made);
    return made;
  }

  private async decode(index: number): Promise<Frame> {
    const [seen, marked] = await Promise.all([this.decoder.pixels(this.json.seen[index]!), this.decoder.pixels(this.json.flips[index]!)]);
    const flips = new Uint8Array(seen.length / 4);
    for (let i = 0; i < flips.length; ++i) flips[i] = marked[4 * i]!;
    return { seen, flips };
  }
}

/** One receiver in one frame. */
export interface Moment {
  counted: boolean;
  rungs: number[]; // V0 … V6
  flip: number; // label of the flip that led here; -1: none
}

export function momentAt(frame: Frame, pixel: number): Moment {
  const drawn = frame.seen[4 * pixel]! / 255,
    truth = frame.seen[4 * pixel + 1]! / 255,
    bits = frame.seen[4 * pixel + 2]!;
  // Outside the map the rungs from V2 on are what was drawn.
  const rung = (k: number): number => ((bits & 64) !== 0 && k >= 2 ? drawn : (bits >> (k - 1)) & 1);
  return { counted: (bits & 32) !== 0, rungs: [truth, ...[1, 2, 3, 4, 5].map(rung), drawn], flip: frame.flips[pixel]! - 1 };
}
