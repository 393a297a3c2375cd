// Arrays of numbers as the C++ writer packs them (../../packing.h): byte planes of what a prediction leaves, in a zlib
// stream, as pairs of characters.

/** What a number is predicted from: nothing, the number before, or the last one of the same surface. */
type From = "nothing" | "previous" | "surface";

export interface Packed {
  bytes: 1 | 2 | 4;
  from: From;
  unit?: number; // what 1 stands for, where all are this, its opposite or 0
  minus?: string; // the name of an array to be added, which stands before this one
  data: string;
}

/** One of several arrays by name; `same`: the name of one that holds the same numbers and stands before it. */
export type Channel = Packed | { same: string };
export type Numbers = Int8Array | Int16Array | Int32Array;

const base = 91,
  place = new Uint8Array(128);
for (let c = 0x21, i = 0; c <= 0x7e; ++c) if (c !== 0x22 && c !== 0x5c && c !== 0x3c) place[c] = i++;

function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const pairs = text.length >> 1,
    rest = text.length & 1;
  // A last pair may hold up to six bits too many, a single character up to five.
  const bytes = new Uint8Array(Math.floor((13 * pairs + 6 * rest) / 8));
  let bits = 0,
    count = 0,
    at = 0;
  for (let i = 0; i < text.length; i += 2) {
    const single = i + 1 === text.length,
      first = place[text.charCodeAt(i)]!;
    bits |= (single ? first : base * first + place[text.charCodeAt(i + 1)]!) << count;
    for (count += single ? 6 : 13; count >= 8 && at < bytes.length; count -= 8, bits >>>= 8) bytes[at++] = bits & 255;
  }
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** What the prediction leaves, signed. */
async function residues(packed: Packed): Promise<Numbers> {
  const planes = await inflate(bytesOf(packed.data)),
    count = planes.length / packed.bytes;
  const unit = packed.unit ?? 1,
    numbers = new { 1: Int8Array, 2: Int16Array, 4: Int32Array }[unit === 1 ? packed.bytes : 2](count);
  for (let i = 0; i < count; ++i) {
    let folded = 0;
    for (let plane = 0; plane < packed.bytes; ++plane) folded |= planes[plane * count + i]! << (8 * plane);
    numbers[i] = unit * ((folded >>> 1) ^ -(folded & 1));
  }
  return numbers;
}

function predicted(numbers: Numbers, from: From, sources: Int32Array | null): Numbers {
  if (from === "previous") for (let i = 1; i < numbers.length; ++i) numbers[i] = numbers[i]! + numbers[i - 1]!;
  else if (from === "surface") for (let i = 1; i < numbers.length; ++i) numbers[i] = numbers[i]! + numbers[sources![i]!]!;
  return numbers;
}

/** The numbers, signed, in the narrowest array that holds them. */
export const unpack = async (packed: Packed): Promise<Numbers> => predicted(await residues(packed), packed.from, null);

/** For each number the place of the last one before it of the same surface, or else of the one before. */
export function surfaceSources(surfaces: Numbers): Int32Array {
  const last = new Map<number, number>(),
    sources = new Int32Array(surfaces.length);
  surfaces.forEach((surface, i) => {
    sources[i] = last.get(surface) ?? Math.max(i - 1, 0);
    last.set(surface, i);
  });
  return sources;
}

/** Several arrays. Equal ones share theirs. `sources` is asked for the surfaces, and `made` for what `minus` names that
    is no channel, with what is unpacked by then. */
export async function unpackAll(
  channels: Record<string, Channel>,
  sources?: (done: Record<string, Numbers>) => Int32Array,
  made?: (name: string, done: Record<string, Numbers>) => Numbers,
): Promise<Record<string, Numbers>> {
  const left = await Promise.all(Object.values(channels).map((channel) => ("same" in channel ? null : residues(channel))));
  const done: Record<string, Numbers> = {};
  Object.entries(channels).forEach(([name, channel], at) => {
    if ("same" in channel) {
      done[name] = done[channel.same]!;
      return;
    }
    const numbers = predicted(left[at]!, channel.from, channel.from === "surface" ? sources!(done) : null);
    if (channel.minus) {
      const other = done[channel.minus] ?? made!(channel.minus, done);
      for (let i = 0; i < numbers.length; ++i) numbers[i] = numbers[i]! + other[i]!;
    }
    done[name] = numbers;
  });
  return done;
}
