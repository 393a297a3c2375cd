// Why a second truth differs from Gnomon's at single pixels. It says how far a receiver would have to be moved for the exact
// answer to change. Beside it stands the spacing of the 32-bit floats in which the other tracer keeps its places.
//   node adapters/second_truth.mjs SCENE.glb AOV.exr CAPTURE_FOLDER
// AOV.exr is that of `gnomon judge CAPTURE --aov`. Prints a line for each differing pixel. Works in 64-bit floats on the file's own
// numbers, with code of its own: no structure, every triangle is tried.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { readExr } from "./exr.mjs";

const add = (a, b, k = 1) => a.map((v, i) => v + k * b[i]);
const sub = (a, b) => add(a, b, -1);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.hypot(...a));

/** A node's matrix, column-major. */
function matrixOf({ matrix, translation = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale = [1, 1, 1] }) {
  if (matrix) return matrix;
  const axes = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
  ];
  return [...axes.flatMap((axis, k) => [...axis.map((v) => v * scale[k]), 0]), ...translation, 1];
}
const product = (a, b) =>
  Array.from({ length: 16 }, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i % 4)] * b[4 * Math.floor(i / 4) + k], 0));
const moved = (m, p, w) => [0, 1, 2].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i] * w);

/** {triangles [[a, b, c]], eye, toLight}: world places of a binary glTF file with one camera and one sun. */
function readScene(path) {
  const bytes = readFileSync(path),
    length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length)),
    binary = bytes.subarray(28 + length);
  const numbers = (index) => {
    const { bufferView, byteOffset = 0, componentType, count, type } = json.accessors[index],
      view = json.bufferViews[bufferView];
    const read = { 5126: "readFloatLE", 5125: "readUInt32LE", 5123: "readUInt16LE", 5121: "readUInt8" }[componentType];
    const width = { 5126: 4, 5125: 4, 5123: 2, 5121: 1 }[componentType],
      parts = { SCALAR: 1, VEC3: 3 }[type];
    const at = (view.byteOffset || 0) + byteOffset,
      stride = view.byteStride || parts * width;
    return Array.from({ length: count }, (_, i) => Array.from({ length: parts }, (_, k) => binary[read](at + i * stride + k * width)));
  };
  const out = { triangles: [] };
  const visit = (index, parent) => {
    const node = json.nodes[index],
      world = product(parent, matrixOf(node));
    for (const { attributes, indices } of node.mesh === undefined ? [] : json.meshes[node.mesh].primitives) {
      const places = numbers(attributes.POSITION).map((p) => moved(world, p, 1));
      const order = indices === undefined ? places.map((_, i) => i) : numbers(indices).flat();
      for (let i = 0; i + 2 < order.length; i += 3) out.triangles.push([places[order[i]], places[order[i + 1]], places[order[i + 2]]]);
    }
    if (node.camera !== undefined) out.eye = moved(world, [0, 0, 0], 1);
    if (node.extensions?.KHR_lights_punctual) out.toLight = unit(moved(world, [0, 0, 1], 0));
    (node.children || []).forEach((child) => visit(child, world));
  };
  json.scenes[json.scene || 0].nodes.forEach((node) => visit(node, matrixOf({})));
  return out;
}

/** The distance along a ray to a triangle (Möller and Trumbore 1997), or nothing. */
function meets([a, b, c], from, along) {
  const e1 = sub(b, a),
    e2 = sub(c, a),
    p = cross(along, e2),
    det = dot(e1, p);
  if (det === 0) return undefined;
  const s = sub(from, a),
    u = dot(s, p) / det;
  if (u < 0 || u > 1) return undefined;
  const q = cross(s, e1),
    v = dot(along, q) / det;
  return v >= 0 && u + v <= 1 ? dot(e2, q) / det : undefined;
}

/** The nearest triangle on the sight line through a place, and where it is met. */
function receiver({ triangles, eye }, place) {
  const along = unit(sub(place, eye));
  let nearest = { t: Infinity };
  for (const triangle of triangles) {
    const t = meets(triangle, eye, along);
    if (t > 0 && t < nearest.t) nearest = { t, triangle };
  }
  const [a, b, c] = nearest.triangle;
  return { at: add(eye, along, nearest.t), triangle: nearest.triangle, normal: unit(cross(sub(b, a), sub(c, a))) };
}

/** Whether places near the receiver are dark: a function of the place. Its own triangle casts no shadow on it. */
function darkness({ triangles, toLight }, { at, triangle }, farthest) {
  // Only what comes near the ray can matter.
  const near = triangles.filter((t) => {
    if (t === triangle) return false;
    const off = t.map((p) => {
      const d = sub(p, at);
      return { d, along: dot(d, toLight), beside: Math.hypot(...cross(d, toLight)) };
    });
    const reach = Math.max(...off.map(({ d }) => Math.hypot(...sub(d, off[0].d))));
    return off.some(({ along }) => along > -reach) && Math.min(...off.map(({ beside }) => beside)) <= reach + farthest;
  });
  return (place) => near.some((t) => meets(t, place, toLight) > 0);
}

/** How far the receiver has to be moved in its own plane, in the best of 64 directions, for the answer to change: world units. */
function margin(dark, { at, normal }, farthest) {
  const side = unit(cross(normal, Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])),
    other = cross(normal, side);
  const before = dark(at);
  let least = Infinity;
  for (let k = 0; k < 64; ++k) {
    const angle = (Math.PI * k) / 32,
      step = side.map((v, i) => v * Math.cos(angle) + other[i] * Math.sin(angle));
    for (let d = 2 ** -40; d < Math.min(farthest, least); d *= 1.05) if (dark(add(at, step, d)) !== before) least = d;
  }
  return least;
}

/** The distance between neighbouring 32-bit floats of the largest coordinate. */
const spacing = (place) => 2 ** (Math.floor(Math.log2(Math.max(...place.map(Math.abs)))) - 23);

/** The differing pixels: [{x, y, shadowed: the exact answer, atItsPlace: that at the place which the other tracer found,
    margin, spacing}]. */
export function differences(scenePath, aovPath, captureFolder) {
  const scene = readScene(scenePath),
    aov = readExr(aovPath),
    position = readExr(join(captureFolder, "position.exr"));
  const out = [];
  for (let i = 0; i < aov.width * aov.height; ++i) {
    if (aov.channels["class.V"][i] <= 0) continue;
    const place = ["X", "Y", "Z"].map((c) => position.channels[c][i]),
      found = receiver(scene, place),
      step = spacing(found.at);
    const dark = darkness(scene, found, 1000 * step),
      shadowed = dark(found.at);
    if (shadowed !== aov.channels["truth.V"][i] < 0.5) throw new Error(`${i % aov.width}, ${Math.floor(i / aov.width)}: the truths differ`);
    out.push({
      x: i % aov.width,
      y: Math.floor(i / aov.width),
      shadowed,
      atItsPlace: dark(place),
      margin: margin(dark, found, 1000 * step),
      spacing: step,
    });
  }
  return out;
}

/** What explains one difference, or nothing. */
export function explanation({ shadowed, atItsPlace, margin, spacing }) {
  if (atItsPlace !== shadowed) return "right at the place that it found";
  return margin < spacing ? "edge nearer than one step" : undefined;
}

if (import.meta.url === pathToFileURL(process.argv[1] || "").href)
  for (const d of differences(...process.argv.slice(2)))
    console.log(
      `${d.x}, ${d.y}: ${d.shadowed ? "shadowed" : "lit"}, edge ${d.margin.toExponential(2)} away, floats ${d.spacing.toExponential(2)} apart: ${explanation(d) || "not explained"}`,
    );
