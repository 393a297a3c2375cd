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

/** A library that is a plain script. */
export function loadScript(path) {
  return new Promise((done, failed) => {
    const script = document.createElement("script");
    Object.assign(script, { src: path, onload: done, onerror: () => failed(new Error(`${path} is missing: npm install --prefix adapters`)) });
    document.head.append(script);
  });
}
