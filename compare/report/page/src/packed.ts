// Arrays of numbers as the C++ writer packs them (../../packing.h): base64 of a zlib stream of byte planes,
// optionally as differences from the number before.

export interface Packed {
  bytes: 1 | 2 | 4;
  difference: boolean;
  data: string;
}

/** One of several arrays by name; `same`: the name of one that holds the same numbers and stands before it. */
export type Channel = Packed | { same: string };
export type Numbers = Int8Array | Int16Array | Int32Array;

function bytesFromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The numbers, signed, in the narrowest array that holds them. */
export async function unpack(packed: Packed): Promise<Numbers> {
  const planes = await inflate(bytesFromBase64(packed.data));
  const count = planes.length / packed.bytes;
  const Numbers = { 1: Int8Array, 2: Int16Array, 4: Int32Array }[packed.bytes];
  const numbers = new Numbers(count);
  for (let plane = 0; plane < packed.bytes; ++plane) {
    const from = plane * count, shift = 8 * plane;
    for (let i = 0; i < count; ++i) numbers[i]! |= planes[from + i]! << shift;
  }
  if (packed.difference) for (let i = 1; i < count; ++i) numbers[i] = numbers[i]! + numbers[i - 1]!;
  return numbers;
}

/** Equal channels share their array. */
export async function unpackAll(channels: Record<string, Channel>): Promise<Record<string, Numbers>> {
  const loading: Record<string, Promise<Numbers>> = {};
  for (const [name, channel] of Object.entries(channels))
    loading[name] = "same" in channel ? loading[channel.same]! : unpack(channel);
  const names = Object.keys(loading);
  const arrays = await Promise.all(Object.values(loading));
  return Object.fromEntries(names.map((name, i) => [name, arrays[i]!]));
}
