// What the page knows: words, and each light's pixels, map and geometry (../../page_data.cpp), unpacked on first use.
import { endless, expectedGaps, nothingStored } from "./expected_gaps";
import { alongRay, texelRay, add, type LightView, type MapPoint, type Vec3 } from "./light_view";
import { surfaceSources, unpack, unpackAll, type Channel, type Numbers, type Packed } from "./packed";
import { pageData, part, putParts } from "./parts";
import { addPredicted, type PixelRays, type PixelSurfaces } from "./surface_prediction";

export interface LabelWords {
  value: number;
  name: string;
  what: string;
  cause: string;
  cure: string;
  colour: string;
}

export interface RungWords {
  name: string;
  what: string;
  step?: string;
}

type Shape = { name: string } & ({ center: Vec3; radius: number } | { point: Vec3; normal: Vec3 });

export interface LightJson {
  name: string;
  view: LightView;
  map_known: boolean; // false: of another renderer's picture without its map; nothing is drawn in light space
  technique: string;
  gaps_decide: boolean; // a pixel is drawn dark exactly when its gap exceeds the constant bias
  sized: boolean; // the light has a size
  as_cast: boolean; // of few rays: no denoiser
  compares_depths: boolean; // false: an exact technique, without a bias
  bias: { constant: number; slope: number; normal_offset: number; receiver_plane: boolean; adaptive: number | null; scales: boolean };
  // adaptive: its slack, world units; scales: gaps and constant are those of a texel of texel_world
  texel_world: number;
  depth_step: number;
  channels: Record<string, Channel>;
  map: Packed & { step: number };
}

/** A material that the two pictures show differently: shares of the light that it mirrors and lets through. */
export interface ShownMaterial {
  name: string;
  mirror: number;
  transmission: number;
}

/** What the lights of one comparison share. */
export interface ComparisonJson {
  exposure: number; // linear factor of both pictures
  rays: PixelRays;
  materials: ShownMaterial[]; // those that mirror or transmit
}

interface PageJson extends ComparisonJson {
  labels: LabelWords[];
  rungs: RungWords[];
  width: number;
  height: number;
  position_steps: number;
  visibility_steps: number;
  colour_steps: number; // of an octave of linear light
  darkest_octave: number; // 1: 2 to this power; 0: black
  lights: number;
  comparisons?: Record<string, ComparisonJson>; // where a page has several, by what stands before the names of their parts
}

interface GeometryJson {
  shapes: Shape[];
  solid_sectors: number;
  complete: boolean;
  triangles?: { low: Vec3; step: number; channels: Record<string, Channel> };
}

export const page = pageData<PageJson>();
const labelWords = new Map(page.labels.map((label) => [label.value, label]));
export const wordsOf = (label: number): LabelWords => labelWords.get(label)!;

/** Makes at most one thing for each comparison of the page. */
class Once<T> {
  private readonly made = new Map<string, Promise<T>>();
  constructor(private readonly make: (comparison: string) => Promise<T>) {}
  of(comparison: string): Promise<T> {
    if (!this.made.has(comparison)) this.made.set(comparison, this.make(comparison));
    return this.made.get(comparison)!;
  }
  forget(comparison: string): void {
    this.made.delete(comparison);
  }
}

/** What both renderers see, and their linear pictures. */
export class Pixels {
  private static readonly loaded = new Once((comparison) => Pixels.unpacked(comparison));
  private constructor(
    readonly comparison: ComparisonJson,
    readonly channels: Record<string, Numbers>,
    readonly sources: Int32Array,
  ) {}
  static load(comparison: string): Promise<Pixels> {
    return Pixels.loaded.of(comparison);
  }
  static forget(comparison: string): void {
    Pixels.loaded.forget(comparison);
  }
  private static async unpacked(comparison: string): Promise<Pixels> {
    let sources: Int32Array | undefined;
    const sourcesOf = (done: Record<string, Numbers>) => (sources ??= surfaceSources(done.primitive!));
    const channels = await unpackAll(await part<Record<string, Channel>>(`${comparison}pixels`), sourcesOf);
    return new Pixels(page.comparisons?.[comparison] ?? page, channels, sources!);
  }
  surfaces(): PixelSurfaces {
    const { primitive, nx, ny, nz } = this.channels;
    return { width: page.width, rays: this.comparison.rays, primitives: primitive!, normals: [nx!, ny!, nz!], sources: this.sources };
  }
  /** Red, green and blue of a picture, as logarithms (linear.ts). */
  picture(name: PictureName): Int16Array[] {
    return ["R", "G", "B"].map((c) => this.channels[name + c] as Int16Array);
  }
}
export type PictureName = "raster" | "raytraced";

export interface Geometry {
  shapes: Shape[];
  positions: Float64Array; // three per vertex
  corners: Int32Array; // three per triangle
  solidSectors: number; // of the meshes that stand for solids; 0: none do
  complete: boolean; // false: the scene has more triangles or solids than the page carries
}

async function loadGeometry(comparison: string): Promise<Geometry> {
  const { shapes, triangles, solid_sectors: solidSectors, complete } = await part<GeometryJson>(`${comparison}geometry`);
  if (!triangles) return { shapes, positions: new Float64Array(), corners: new Int32Array(), solidSectors, complete };
  const { x, y, z, corner } = await unpackAll(triangles.channels);
  const positions = new Float64Array(3 * x!.length);
  [x!, y!, z!].forEach((axis, k) =>
    axis.forEach((value, i) => {
      positions[3 * i + k] = triangles.low[k]! + value * triangles.step;
    }),
  );
  return { shapes, positions, corners: corner as Int32Array, solidSectors, complete };
}
const geometries = new Once(loadGeometry);
export const geometry = (comparison = ""): Promise<Geometry> => geometries.of(comparison);

/** Takes a comparison that came later, in the place of the one before of that key; the names of its parts begin with the key. */
export function putComparison(key: string, shared: ComparisonJson, parts: Record<string, unknown>): void {
  Pixels.forget(key);
  geometries.forget(key);
  page.comparisons![key] = shared;
  putParts(key, parts);
}

/** One pixel as one light sees it. */
export interface Pixel {
  x: number;
  y: number;
  index: number;
  label: number;
  seen: boolean; // a surface that both renderers see: the fields below mean something
  rungs: number[];
  face: number;
  at: MapPoint;
  distance: number;
  gap: number;
  position: Vec3;
  normal: Vec3;
  primitive: number;
  material: ShownMaterial | null; // its own, where that mirrors or transmits
  storedGlass: ShownMaterial | null; // what its texel holds, where that is other glass
}

const shownMaterial = (materials: ShownMaterial[], places: Numbers | undefined, index: number): ShownMaterial | null =>
  materials[(places?.[index] ?? 0) - 1] ?? null;

/** The stored map; depths in world units, infinity where nothing is stored. */
export class DepthMap {
  readonly size: number;
  constructor(
    private readonly light: LightJson,
    readonly step: number,
    private readonly numbers: Numbers,
  ) {
    this.size = Math.ceil(light.view.size / step);
  }
  depth(face: number, column: number, row: number): number {
    if (column < 0 || row < 0 || column >= this.light.view.size || row >= this.light.view.size) return Infinity;
    const i = (face * this.size + Math.floor(row / this.step)) * this.size + Math.floor(column / this.step);
    const number = this.numbers[i]!;
    return number === nothingStored ? Infinity : this.light.view.near + number * this.light.depth_step;
  }
}

export class Light {
  readonly gap: Float32Array;
  readonly label: Int8Array;
  readonly truth: Int16Array;
  readonly drawn: Int16Array;
  readonly flip: Int8Array | null; // in hundredths
  readonly decision: Int8Array | null; // of the hybrid: 0 surely in shadow, 1 surely lit, 2 traced, 3 not asked
  readonly ssim: Int8Array | null; // in hundredths; -128 where no window fits
  private readonly us: Numbers;
  private readonly vs: Numbers;
  private readonly faces: Numbers;
  private constructor(
    readonly json: LightJson,
    private readonly channels: Record<string, Numbers>,
    readonly pixels: Pixels,
    readonly map: DepthMap,
  ) {
    this.gap = Float32Array.from(channels.gap!, (number) => (number === endless ? -Infinity : number * json.depth_step));
    this.label = channels.label as Int8Array;
    this.truth = channels.V0 as Int16Array;
    this.drawn = channels.V6 as Int16Array;
    this.flip = (channels.flip as Int8Array | undefined) ?? null;
    this.ssim = (channels.ssim as Int8Array | undefined) ?? null;
    this.decision = (channels.decision as Int8Array | undefined) ?? null;
    this.us = channels.u!;
    this.vs = channels.v!;
    this.faces = channels.face!;
  }
  /** A light of the page's comparison, or of one of several. */
  static async load(index: number, comparison = ""): Promise<Light> {
    const json = await part<LightJson>(`${comparison}light-${index}`);
    const [pixels, map] = await Promise.all([Pixels.load(comparison), unpack(json.map)]);
    const channels = await unpackAll(
      json.channels,
      () => pixels.sources,
      (_, done) => {
        addPredicted(pixels.surfaces(), json.view, page.position_steps, json.depth_step, done.u!, done.v!, done.distance!, done.face!);
        return expectedGaps(json, pixels.surfaces(), done, map);
      },
    );
    return new Light(json, channels, pixels, new DepthMap(json, json.map.step, map));
  }

  lit(index: number): boolean {
    return this.truth[index]! > 0.5 * page.visibility_steps;
  }
  halfLit(index: number): boolean {
    return this.truth[index]! === 0.5 * page.visibility_steps;
  }
  u(index: number): number {
    return this.us[index]! / page.position_steps;
  }
  v(index: number): number {
    return this.vs[index]! / page.position_steps;
  }
  face(index: number): number {
    return this.faces[index]!;
  }
  primitive(index: number): number {
    return this.pixels.channels.primitive![index]!;
  }
  /** Depth along the face's forward axis. */
  depth(index: number): number {
    const distance = this.channels.distance![index]! * this.json.depth_step;
    return distance / alongRay(this.json.view, this.face(index), this.u(index), this.v(index));
  }
  /** How the pixel is drawn wrong at a constant bias, by more than one half: -1 in false shadow, 1 in missed shadow, 0 not. By
      a hard test, on 32-bit floats as in the shader; or, where gaps do not decide, as it was drawn. */
  wrongAt(index: number, bias: number): number {
    const steps = page.visibility_steps,
      tested = this.gap[index]! > Math.fround(bias) ? 0 : steps;
    const error = (this.json.gaps_decide ? tested : this.drawn[index]!) - this.truth[index]!;
    return Math.abs(error) > 0.5 * steps ? Math.sign(error) : 0;
  }

  /** The compared pixels that look up a row (axis 0) or column (axis 1) of the map, at positions in [from, to) on it. */
  pixelsOfLine(face: number, axis: 0 | 1, line: number, from: number, to: number): number[] {
    const [along, across] = axis === 0 ? [this.us, this.vs] : [this.vs, this.us],
      steps = page.position_steps;
    const low = line * steps,
      high = low + steps,
      first = from * steps,
      last = to * steps,
      found: number[] = [];
    for (let i = 0; i < across.length; ++i) {
      const a = across[i]!,
        t = along[i]!;
      if (a >= low && a < high && t >= first && t < last && this.label[i]! >= 0 && this.faces[i] === face) found.push(i);
    }
    return found;
  }

  pixel(x: number, y: number): Pixel {
    const index = y * page.width + x,
      label = this.label[index]!,
      view = this.json.view;
    const face = this.face(index),
      at = { u: this.u(index), v: this.v(index), depth: this.depth(index) };
    const distance = this.channels.distance![index]! * this.json.depth_step;
    const ray = texelRay(view, face, at.u, at.v);
    return {
      x,
      y,
      index,
      label,
      face,
      at,
      distance,
      seen: label === -4 || label === -2 || label >= 0,
      rungs: page.rungs.map((_, k) => this.channels[`V${k}`]![index]! / page.visibility_steps),
      gap: this.gap[index]!,
      position: add(ray.origin, ray.direction, distance),
      normal: ["nx", "ny", "nz"].map((n) => this.pixels.channels[n]![index]! / 32767) as unknown as Vec3,
      primitive: this.primitive(index),
      material: shownMaterial(this.pixels.comparison.materials, this.pixels.channels.material, index),
      storedGlass: shownMaterial(this.pixels.comparison.materials, this.channels.stored_glass, index),
    };
  }
}
