// OpenEXR files of 32-bit float channels, uncompressed (openexr.com, "OpenEXR File Layout").
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";
import { exrBlocks, exrChannels } from "./exr_blocks.mjs";

/** channels: {NAME: Float32Array, row 0 at the top}. Returns the file's bytes. */
export function exr(width, height, channels) {
  const names = Object.keys(channels).sort(); // the format keeps them sorted by name
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
  const parts = exrBlocks(readFileSync(path));
  return exrChannels(
    parts,
    parts.blocks.map(({ deflated, data }) => (deflated ? inflateSync(data) : data)),
  );
}
