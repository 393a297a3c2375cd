// PlayCanvas. Options, by its own names: --shadowType PCF1_32F | PCF3_32F | PCF5_32F | VSM_16F | PCSS_32F, --shadowResolution,
// --shadowBias, --normalOffsetBias, --shadowDistance, --numCascades (a sun's). Defaults are PlayCanvas' own.
// A spot's or point's range, which glTF leaves infinite, ends behind the scene: its map's near plane is a thousandth of it.
// The visibility is the ratio of two pictures in a white matte material, with shadows and without.
import * as pc from "playcanvas";
import { channel, readGltf, settled, shadowFlags } from "./common.js";

const types = ["PCF1_32F", "PCF3_32F", "PCF5_32F", "VSM_16F", "PCSS_32F"];

function loadScene(app, url) {
  return new Promise((done, failed) =>
    app.assets.loadFromUrl(url, "container", (error, asset) => (error ? failed(new Error(error)) : done(asset))),
  );
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
  for (const { aabb } of instancesOf(root)) farthest = Math.max(farthest, aabb.center.distance(from) + aabb.halfExtents.length());
  return farthest;
}

/** White; a mask's own alpha stays. */
function white(original) {
  const material = new pc.StandardMaterial();
  material.specular.set(0, 0, 0);
  material.cull = pc.CULLFACE_NONE;
  material.twoSidedLighting = true;
  material.useTonemap = material.useSkybox = material.useFog = false;
  if (original.alphaTest > 0)
    Object.assign(material, {
      opacityMap: original.opacityMap || original.diffuseMap,
      opacityMapChannel: "a",
      alphaTest: original.alphaTest,
    });
  material.update();
  return material;
}

/** World positions; transparent where a mask cuts. */
function places(original) {
  const masked = original.alphaTest > 0;
  const material = new pc.ShaderMaterial({
    uniqueName: masked ? "masked-places" : "places",
    attributes: { vertex_position: pc.SEMANTIC_POSITION, ...(masked && { vertex_texCoord0: pc.SEMANTIC_TEXCOORD0 }) },
    vertexGLSL: `attribute vec4 vertex_position; uniform mat4 matrix_model; varying vec3 place;
      ${masked ? "attribute vec2 vertex_texCoord0; varying vec2 at;" : ""}
      void main() { vec4 p = matrix_model * vec4(vertex_position.xyz, 1.0); place = p.xyz; ${masked ? "at = vertex_texCoord0;" : ""} gl_Position = matrix_viewProjection * p; }`,
    fragmentGLSL: `varying highp vec3 place; ${masked ? "varying vec2 at; uniform sampler2D mask; uniform float cutoff;" : ""}
      void main() { ${masked ? "if (texture2D(mask, at).a < cutoff) discard;" : ""} gl_FragColor = vec4(place, 1.0); }`,
  });
  material.cull = pc.CULLFACE_NONE;
  if (masked) {
    material.setParameter("mask", original.opacityMap || original.diffuseMap);
    material.setParameter("cutoff", original.alphaTest);
  }
  material.update();
  return material;
}

/** As the file's extras say for each primitive; entities have the names of the file's nodes. */
function setFlags(root, gltf) {
  for (const render of root.findComponents("render")) {
    const nodes = gltf.nodes.flatMap(({ mesh, name }, i) =>
      mesh !== undefined && (name ?? `node_${i}`) === render.entity.name ? [i] : [],
    );
    render.meshInstances.forEach((instance, primitive) => {
      const [flags, ...others] = nodes.map((node) => shadowFlags(gltf, node, primitive));
      if (others.some(({ casts, receives }) => casts !== flags.casts || receives !== flags.receives))
        throw new Error(`nodes of one name (${render.entity.name}) cast or receive shadows differently`);
      Object.assign(instance, { castShadow: flags.casts, receiveShadow: flags.receives });
    });
  }
}

const instancesOf = (root) => root.findComponents("render").flatMap((render) => render.meshInstances);

function dress(instances, originals, make) {
  const made = new Map();
  instances.forEach((instance, i) => {
    if (!made.has(originals[i])) made.set(originals[i], make(originals[i]));
    instance.material = made.get(originals[i]);
  });
}

/** One frame is drawn. Left alone the application draws sixty a second, which software falls ever farther behind. */
function frame(app) {
  app.renderNextFrame = true;
  return new Promise((done) => app.once("frameend", done));
}

async function drawFloats(app, camera, width, height) {
  const texture = new pc.Texture(app.graphicsDevice, {
    width,
    height,
    format: pc.PIXELFORMAT_RGBA32F,
    mipmaps: false,
    minFilter: pc.FILTER_NEAREST,
    magFilter: pc.FILTER_NEAREST,
  });
  camera.renderTarget = new pc.RenderTarget({ colorBuffer: texture, depth: true, flipY: false });
  await frame(app);
  await frame(app);
  const pixels = await texture.read(0, 0, width, height, { renderTarget: camera.renderTarget, immediate: true });
  camera.renderTarget = null;
  return [0, 1, 2, 3].map((c) => channel(pixels, width, height, c));
}

async function prepare(canvas, task) {
  const settings = settled(
    task.settings,
    { shadowType: "PCF3_32F", shadowResolution: 1024, shadowBias: 0.05, normalOffsetBias: 0, shadowDistance: 40, numCascades: 1 },
    { shadowType: types },
  );
  const { width, height } = task;
  const app = new pc.Application(canvas, { graphicsDeviceOptions: { antialias: false, preserveDrawingBuffer: true } });
  app.setCanvasFillMode(pc.FILLMODE_NONE, width, height);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, width, height);
  app.scene.ambientLight = new pc.Color(0, 0, 0);
  const root = (await loadScene(app, task.scene)).resource.instantiateRenderEntity({ castShadows: true, receiveShadows: true });
  app.root.addChild(root);
  setFlags(root, await readGltf(task.scene));
  const camera = root.findComponent("camera"),
    light = chooseLight(root, task.light);
  Object.assign(camera, {
    enabled: true,
    clearColor: new pc.Color(0, 0, 0, 0),
    toneMapping: pc.TONEMAP_NONE,
    gammaCorrection: pc.GAMMA_NONE,
    frustumCulling: false,
    aspectRatioMode: pc.ASPECT_AUTO,
  });
  const { shadowType, ...rest } = settings;
  Object.assign(light, { castShadows: true, shadowType: pc[`SHADOW_${shadowType}`], ...rest });
  if (light.type !== "directional") light.range = reach(root, light);
  return { settings, width, height, app, root, camera, light };
}

/** A page that draws the scene in each animation frame. */
export async function show(canvas, task) {
  const { app } = await prepare(canvas, task);
  app.start();
}

export async function capture(canvas, task) {
  const { settings, width, height, app, root, camera, light } = await prepare(canvas, task);
  app.autoRender = false;
  app.start();
  await frame(app);
  await frame(app);
  const picture = canvas.toDataURL();
  const instances = instancesOf(root),
    originals = instances.map((instance) => instance.material);
  dress(instances, originals, white);
  const [shadowed] = await drawFloats(app, camera, width, height);
  light.castShadows = false;
  const [unshadowed] = await drawFloats(app, camera, width, height);
  dress(instances, originals, places);
  const [x, y, z, covered] = await drawFloats(app, camera, width, height);
  return {
    renderer: { name: "PlayCanvas", version: pc.version, settings },
    light: light.entity.name,
    picture,
    shadowed,
    unshadowed,
    covered,
    position: [x, y, z],
  };
}
