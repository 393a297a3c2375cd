// What the engines' pages share.

/** Settings with defaults; an unknown name or a value that is not allowed is an error. choices: {name: [values]}. */
export function settled(given, defaults, choices = {}) {
  for (const name of Object.keys(given))
    if (!(name in defaults)) throw new Error(`--${name}: unknown (allowed ${Object.keys(defaults).join(", ")})`);
  const settings = { ...defaults, ...given };
  for (const [name, allowed] of Object.entries(choices))
    if (!allowed.includes(settings[name])) throw new Error(`--${name}: got ${settings[name]}, allowed ${allowed.join(", ")}`);
  return settings;
}

/** Rows the other way round: WebGL reads from the bottom. `stride` floats to a pixel; takes out channel c. */
export function channel(pixels, width, height, c, { flip = true, stride = 4 } = {}) {
  const out = new Float32Array(width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) out[y * width + x] = pixels[((flip ? height - 1 - y : y) * width + x) * stride + c];
  return out;
}

/** The JSON of a .gltf or .glb. */
export async function readGltf(url) {
  const bytes = await (await fetch(url)).arrayBuffer(),
    head = new DataView(bytes);
  const isBinary = head.getUint32(0, true) === 0x46546c67; // "glTF"
  return JSON.parse(new TextDecoder().decode(isBinary ? new Uint8Array(bytes, 20, head.getUint32(12, true)) : bytes));
}

/** Whether a primitive of a node's mesh casts shadows and receives them: both, unless the extras of the node or of the material say
    otherwise, as gnomon export writes them. */
export function shadowFlags(gltf, node, primitive) {
  const { mesh, extras } = gltf.nodes[node];
  const material = gltf.materials?.[gltf.meshes[mesh].primitives[primitive].material];
  const says = (flag) => [extras, material?.extras].every((from) => from?.[flag] === undefined || Boolean(from[flag]));
  return { casts: says("casts_shadow"), receives: says("receives_shadow") };
}

/** A library that is a plain script. */
export function loadScript(path) {
  return new Promise((done, failed) => {
    const script = document.createElement("script");
    Object.assign(script, {
      src: path,
      onload: done,
      onerror: () => failed(new Error(`${path} is missing: npm install --prefix adapters`)),
    });
    document.head.append(script);
  });
}
