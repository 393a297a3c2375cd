// Filament, as it is: PCF with a map of 1024 texels. It has no options here: the npm package of 1.53.4 does not bind its
// ShadowOptions to JavaScript. The visibility is the ratio of two linear pictures of 8 bits a channel, with shadows and without; for
// that every material of the file is made white and rough before it is loaded, and the light is dimmed until nothing is clipped.
import { channel, loadScript, settled } from "./common.js";

/** The file's bytes with its JSON changed. */
function withJson(bytes, change) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length),
    binary = view.getUint32(0, true) === 0x46546c67;
  const length = binary ? view.getUint32(12, true) : bytes.length,
    start = binary ? 20 : 0;
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(start, start + length)));
  change(json);
  const text = new TextEncoder().encode(JSON.stringify(json));
  if (!binary) return { json, bytes: text };
  const padded = (text.length + 3) & ~3,
    rest = bytes.subarray(start + length),
    out = new Uint8Array(20 + padded + rest.length).fill(32);
  out.set(bytes.subarray(0, 20));
  out.set(text, 20);
  out.set(rest, 20 + padded);
  new DataView(out.buffer).setUint32(8, out.length, true);
  new DataView(out.buffer).setUint32(12, padded, true);
  return { json, bytes: out };
}

function whiten(json) {
  for (const material of json.materials || []) {
    const { baseColorTexture } = material.pbrMetallicRoughness || {};
    material.pbrMetallicRoughness = { metallicFactor: 0, roughnessFactor: 1, ...(material.alphaMode === "MASK" && { baseColorTexture }) };
    material.extensions = { KHR_materials_specular: { specularFactor: 0 } };
    delete material.emissiveFactor;
  }
}

function chooseLight(asset, wanted) {
  const lights = asset.getLightEntities(),
    names = lights.map((l) => asset.getName(l));
  const index = wanted === undefined ? 0 : names.indexOf(wanted);
  if (!lights[index]) throw new Error(`--light: no such light (got ${wanted}, allowed ${names.join(", ")})`);
  return { entity: lights[index], name: names[index], others: lights.filter((l, i) => i !== index) };
}

const nextFrame = () => new Promise((done) => requestAnimationFrame(done));

/** The first channel, in [0, 1]. A frame may be left out, so several are drawn. */
async function draw({ canvas, engine, renderer, swapChain, view }, width, height) {
  for (let i = 0; i < 5; ++i) {
    renderer.render(swapChain, view);
    engine.execute();
    await nextFrame();
  }
  renderer.render(swapChain, view);
  engine.execute();
  const gl = canvas.getContext("webgl2"),
    pixels = new Uint8Array(width * height * 4);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  return channel(
    Float32Array.from(pixels, (v) => v / 255),
    width,
    height,
    0,
  );
}

/** Sets the light's intensity so that the brightest pixel is less than white, and not much less. */
async function exposed(lights, instance, drawn) {
  for (let intensity = 3, i = 0; i < 16; ++i) {
    lights.setIntensity(instance, intensity);
    const pixels = await drawn(),
      brightest = pixels.reduce((a, b) => Math.max(a, b), 0);
    if (brightest === 0) throw new Error("the light reaches nothing that is seen");
    if (brightest > 0.97) intensity *= 0.5;
    else if (brightest < 0.5) intensity *= 0.8 / brightest;
    else return pixels;
  }
  throw new Error("no intensity of the light shows its whole range");
}

async function prepare(canvas, task) {
  await loadScript("/node_modules/filament/filament.js");
  settled(task.settings, {});
  const { width, height } = task;
  ((canvas.width = width), (canvas.height = height));
  await new Promise((done) => Filament.init([], done));
  const engine = Filament.Engine.create(canvas, { preserveDrawingBuffer: true, antialias: false });
  const [scene, view, renderer, swapChain] = [engine.createScene(), engine.createView(), engine.createRenderer(), engine.createSwapChain()];
  const { json, bytes } = withJson(new Uint8Array(await (await fetch(task.scene)).arrayBuffer()), whiten);
  const asset = engine.createAssetLoader().createAsset(bytes);
  await new Promise((done) => asset.loadResources(done, null, null, 20));
  scene.addEntities(asset.getEntities());
  const light = chooseLight(asset, task.light);
  for (const other of light.others) scene.remove(other);

  const { yfov, znear, zfar } = json.cameras[0].perspective;
  const camera = engine.getCameraComponent(asset.getCameraEntities()[0]);
  camera.setProjectionFov((yfov * 180) / Math.PI, width / height, znear, zfar || 1e6, Filament.Camera$Fov.VERTICAL);
  camera.setExposureDirect(1);
  Object.entries({
    setScene: scene,
    setCamera: camera,
    setViewport: [0, 0, width, height],
    setPostProcessingEnabled: false,
    setAntiAliasing: Filament.View$AntiAliasing.NONE,
  }).forEach(([name, value]) => view[name](value));
  renderer.setClearOptions({ clearColor: [0, 0, 0, 0], clear: true });
  const lights = engine.getLightManager(),
    instance = lights.getInstance(light.entity);
  return { width, height, light, lights, instance, tools: { canvas, engine, renderer, swapChain, view } };
}

/** A page that draws the scene in each animation frame. */
export async function show(canvas, task) {
  const { width, height, lights, instance, tools } = await prepare(canvas, task);
  lights.setShadowCaster(instance, true);
  await exposed(lights, instance, () => draw(tools, width, height));
  const next = () => {
    tools.renderer.render(tools.swapChain, tools.view);
    tools.engine.execute();
    requestAnimationFrame(next);
  };
  next();
}

export async function capture(canvas, task) {
  const { width, height, light, lights, instance, tools } = await prepare(canvas, task);
  lights.setShadowCaster(instance, false);
  const unshadowed = await exposed(lights, instance, () => draw(tools, width, height));
  lights.setShadowCaster(instance, true);
  const shadowed = await draw(tools, width, height),
    picture = canvas.toDataURL();
  const { version } = await (await fetch("/node_modules/filament/package.json")).json();
  return {
    renderer: { name: "Filament", version, settings: { mapSize: 1024, shadowType: "PCF", constantBias: 0.001, normalBias: 1 } },
    light: light.name,
    picture,
    shadowed,
    unshadowed,
  };
}
