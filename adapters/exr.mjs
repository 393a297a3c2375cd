// OpenEXR files of 32-bit float channels, uncompressed (openexr.com, "OpenEXR File Layout").
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

/** channels: {NAME: Float32Array, row 0 at the top}. Returns the file's bytes. */
export function exr(width, height, channels) {
  const names = Object.keys(channels).sort();  // the format keeps them sorted by name
  const text = (s) => Buffer.from(s + "\0", "latin1");
  const int = (...values) => Buffer.from(Int32Array.from(values).buffer);
  const float = (...values) => Buffer.from(Float32Array.from(values).buffer);
  const attribute = (name, type, value) => Buffer.concat([text(name), text(type), int(value.length), value]);
  const list = Buffer.concat([...names.map((name) => Buffer.concat([text(name), int(2, 0, 1, 1)])), Buffer.from([0])]);
  const header = Buffer.concat([
    int(20000630, 2),
    attribute("channels", "chlist", list),
    attribute("compression", "compression", Buffer.from([0])),
    attribute("dataWindow", "box2i", int(0, 0, width - 1, height - 1)),
    attribute("displayWindow", "box2i", int(0, 0, width - 1, height - 1)),
    attribute("lineOrder", "lineOrder", Buffer.from([0])),
    attribute("pixelAspectRatio", "float", float(1)),
    attribute("screenWindowCenter", "v2f", float(0, 0)),
    attribute("screenWindowWidth", "float", float(1)),
    Buffer.from([0]),
  ]);
  const row = names.length * width * 4;
  const offsets = new BigInt64Array(height);
  const lines = Buffer.alloc(height * (8 + row));
  for (let y = 0; y < height; ++y) {
    const at = y * (8 + row);
    offsets[y] = BigInt(header.length + height * 8 + at);
    lines.writeInt32LE(y, at);
    lines.writeInt32LE(row, at + 4);
    names.forEach((name, c) => {
      const values = channels[name].subarray(y * width, (y + 1) * width);
      Buffer.from(values.buffer, values.byteOffset, width * 4).copy(lines, at + 8 + c * width * 4);
    });
  }
  return Buffer.concat([header, Buffer.from(offsets.buffer), lines]);
}

/** {width, height, channels {NAME: Float32Array}} of a file of 32-bit channels in scan lines, uncompressed or by deflate. */
export function readExr(path) {
  const bytes = readFileSync(path);
  let at = 8;
  const text = () => { const end = bytes.indexOf(0, at), word = bytes.toString("latin1", at, end); at = end + 1; return word; };
  const attributes = {};
  for (let name = text(); name; name = text()) {
    text();  // the type
    const length = bytes.readInt32LE(at);
    attributes[name] = bytes.subarray(at + 4, at + 4 + length);
    at += 4 + length;
  }
  const names = attributes.channels.toString("latin1").match(/[^\0]+\0\x02\0\0\0[^]{12}/g).map((entry) => entry.slice(0, entry.indexOf("\0")));
  const [x0, y0, x1, y1] = [0, 4, 8, 12].map((k) => attributes.dataWindow.readInt32LE(k)), width = x1 - x0 + 1, height = y1 - y0 + 1;
  const rows = { 0: 1, 2: 1, 3: 16 }[attributes.compression[0]];
  if (rows === undefined) throw new Error(`${path}: a compression that is not read here`);
  const channels = Object.fromEntries(names.map((name) => [name, new Float32Array(width * height)]));
  for (let block = 0; block < Math.ceil(height / rows); ++block) {
    const start = Number(bytes.readBigUInt64LE(at + 8 * block)), y = bytes.readInt32LE(start) - y0, lines = Math.min(rows, height - y);
    const size = bytes.readInt32LE(start + 4), whole = lines * width * names.length * 4;
    let data = bytes.subarray(start + 8, start + 8 + size);
    if (size < whole) data = restored(inflateSync(data));
    for (let line = 0, k = 0; line < lines; ++line)
      for (const name of names)
        for (let x = 0; x < width; ++x, k += 4) channels[name][(y + line) * width + x] = data.readFloatLE(k);
  }
  return { width, height, channels };
}

/** The format stores differences, of the even bytes first and then of the odd ones. */
function restored(data) {
  for (let i = 1; i < data.length; ++i) data[i] = (data[i - 1] + data[i] - 128) & 255;
  const out = Buffer.alloc(data.length), half = (data.length + 1) >> 1;
  for (let i = 0; i < data.length; ++i) out[i] = data[i % 2 === 0 ? i >> 1 : half + (i >> 1)];
  return out;
}
