// OpenEXR files of 32-bit channels in scan lines, uncompressed or by ZIP (openexr.com, "OpenEXR File Layout"), taken apart and put
// together. In between somebody inflates the blocks, which Node and pages do each in a way of their own.

/** {width, height, names, blocks: [{y, lines, deflated, data}]} of a file's bytes; the rows of a block count from 0 at the top. */
export function exrBlocks(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength),
    latin = new TextDecoder("latin1");
  let at = 8;
  const text = () => {
    const end = bytes.indexOf(0, at),
      word = latin.decode(bytes.subarray(at, end));
    at = end + 1;
    return word;
  };
  const attributes = {};
  for (let name = text(); name; name = text()) {
    text(); // the type
    const length = view.getInt32(at, true);
    attributes[name] = bytes.subarray(at + 4, at + 4 + length);
    at += 4 + length;
  }
  const names = latin
    .decode(attributes.channels)
    .match(/[^\0]+\0\x02\0\0\0[^]{12}/g)
    .map((entry) => entry.slice(0, entry.indexOf("\0")));
  const window = attributes.dataWindow,
    [x0, y0, x1, y1] = [0, 4, 8, 12].map((k) => new DataView(window.buffer, window.byteOffset).getInt32(k, true));
  const width = x1 - x0 + 1,
    height = y1 - y0 + 1,
    rows = { 0: 1, 2: 1, 3: 16 }[attributes.compression[0]];
  if (rows === undefined) throw new Error("an EXR with a compression that is not read here");
  const blocks = [];
  for (let block = 0; block < Math.ceil(height / rows); ++block) {
    const start = Number(view.getBigUint64(at + 8 * block, true)),
      y = view.getInt32(start, true) - y0,
      lines = Math.min(rows, height - y);
    const size = view.getInt32(start + 4, true);
    blocks.push({ y, lines, deflated: size < lines * width * names.length * 4, data: bytes.subarray(start + 8, start + 8 + size) });
  }
  return { width, height, names, blocks };
}

/** {width, height, channels {NAME: Float32Array}} of such blocks and of what each holds, inflated where it was deflated. */
export function exrChannels({ width, height, names, blocks }, inflated) {
  const channels = Object.fromEntries(names.map((name) => [name, new Float32Array(width * height)]));
  blocks.forEach(({ y, lines, deflated }, i) => {
    const data = deflated ? restored(inflated[i]) : inflated[i],
      view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    for (let line = 0, k = 0; line < lines; ++line)
      for (const name of names) for (let x = 0; x < width; ++x, k += 4) channels[name][(y + line) * width + x] = view.getFloat32(k, true);
  });
  return { width, height, channels };
}

/** The format stores differences, of the even bytes first and then of the odd ones. */
function restored(data) {
  for (let i = 1; i < data.length; ++i) data[i] = (data[i - 1] + data[i] - 128) & 255;
  const out = new Uint8Array(data.length),
    half = (data.length + 1) >> 1;
  for (let i = 0; i < data.length; ++i) out[i] = data[i % 2 === 0 ? i >> 1 : half + (i >> 1)];
  return out;
}
