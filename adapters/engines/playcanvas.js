// PlayCanvas. Options, by its own names: --shadowType PCF1_32F | PCF3_32F | PCF5_32F | VSM_16F | PCSS_32F, --shadowResolution,
// --shadowBias, --normalOffsetBias, --shadowDistance, --numCascades (a sun's). Defaults are PlayCanvas' own.
// A spot's or point's range, which glTF leaves infinite, ends behind the scene: its map's near plane is a thousandth of it.
// The visibility is the ratio of two pictures in a white matte material, with shadows and without.
import * as pc from "playcanvas";
import { channel, settled } from "./common.js";

const types = ["PCF1_32F", "PCF3_32F", "PCF5_32F", "VSM_16F", "PCSS_32F"];

function loadScene(app, url) {
  return new Promise((done, failed) => app.assets.loadFromUrl(url, "container", (error, asset) => (error ? failed(new Error(error)) : done(asset))));
}

function chooseLight(root, wanted) {
  const lights = root.findComponents("light");
  const light = wanted === undefined ? lights[0] : lights.find((l) => l.entity.name === wanted || l.entity.parent.name === wanted);
  if (!light) throw new Error(`--light: no such light (got ${wanted}, allowed ${lights.map((l) => l.entity.name).join(", ")})`);
  light.enabled = true;
  light.intensity = 1;
  return light;
}

/** How far the farthest corner of the scene's boxes is from the light. */
function reach(root, light) {
  const from = light.entity.getPosition();
  let farthest = 0;
  for (const render of root.findComponents("render"))
    for (const { aabb } of render.meshInstances) farthest = Math.max(farthest, aabb.center.distance(from) + aabb.halfExtents.length());
  return farthest;
}

/** White; a mask's own alpha stays. */
function white(original) {
  const material = new pc.StandardMaterial();
  material.specular.set(0, 0, 0);
  material.cull = pc.CULLFACE_NONE;
  material.twoSidedLighting = true;
  material.useTonemap = material.useSkybox = material.useFog = false;
  if (original.alphaTest > 0) Object.assign(material, { opacityMap: original.opacityMap || original.diffuseMap, opacityMapChannel: "a", alphaTest: original.alphaTest });
  material.update();
  return material;
}

function whiten(root) {
  const made = new Map();
  for (const render of root.findComponents("render"))
    for (const instance of render.meshInstances) {
      if (!made.has(instance.material)) made.set(instance.material, white(instance.material));
      instance.material = made.get(instance.material);
    }
}

const frame = (app) => new Promise((done) => app.once("frameend", done));

async function drawFloats(app, camera, width, height) {
  const texture = new pc.Texture(app.graphicsDevice, { width, height, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false, minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST });
  camera.renderTarget = new pc.RenderTarget({ colorBuffer: texture, depth: true, flipY: false });
  await frame(app);
  await frame(app);
  const pixels = await texture.read(0, 0, width, height, { renderTarget: camera.renderTarget, immediate: true });
  camera.renderTarget = null;
  return channel(pixels, width, height, 0);
}

export async function capture(canvas, task) {
  const settings = settled(task.settings, { shadowType: "PCF3_32F", shadowResolution: 1024, shadowBias: 0.05, normalOffsetBias: 0, shadowDistance: 40, numCascades: 1 }, { shadowType: types });
  const { width, height } = task;
  const app = new pc.Application(canvas, { graphicsDeviceOptions: { antialias: false, preserveDrawingBuffer: true } });
  app.setCanvasFillMode(pc.FILLMODE_NONE, width, height);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, width, height);
  app.scene.ambientLight = new pc.Color(0, 0, 0);
  const root = (await loadScene(app, task.scene)).resource.instantiateRenderEntity({ castShadows: true, receiveShadows: true });
  app.root.addChild(root);
  const camera = root.findComponent("camera"), light = chooseLight(root, task.light);
  Object.assign(camera, { enabled: true, clearColor: new pc.Color(0, 0, 0, 0), toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE, frustumCulling: false });
  const { shadowType, ...rest } = settings;
  Object.assign(light, { castShadows: true, shadowType: pc[`SHADOW_${shadowType}`], ...rest });
  if (light.type !== "directional") light.range = reach(root, light);
  app.start();
  await frame(app);
  await frame(app);
  const picture = canvas.toDataURL();
  whiten(root);
  const shadowed = await drawFloats(app, camera, width, height);
  light.castShadows = false;
  const unshadowed = await drawFloats(app, camera, width, height);
  return { renderer: { name: "PlayCanvas", version: pc.version, settings }, light: light.entity.name, picture, shadowed, unshadowed };
}
