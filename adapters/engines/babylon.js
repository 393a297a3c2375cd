// Babylon.js. Options, by its own names: --type none | poisson | pcf | pcss | esm (its filters), --mapSize, --bias,
// --normalBias. Also --full_float 0 | 1 (a map of 32-bit floats, which its shadow generators do not take by themselves). Defaults
// are Babylon's; it has none for mapSize, and its guide's 1024 is taken. A sun is moved before the scene's box.
// The visibility is the ratio of two pictures in a white matte material, with shadows and without.
import { channel, loadScript, readGltf, settled, shadowFlags } from "./common.js";

const types = {
  none: null,
  poisson: "usePoissonSampling",
  pcf: "usePercentageCloserFiltering",
  pcss: "useContactHardeningShadow",
  esm: "useBlurExponentialShadowMap",
};

function chooseLight(scene, wanted) {
  const light = wanted === undefined ? scene.lights[0] : scene.lights.find((l) => l.name === wanted);
  if (!light) throw new Error(`--light: no such light (got ${wanted}, allowed ${scene.lights.map((l) => l.name).join(", ")})`);
  for (const other of scene.lights) other.setEnabled(other === light);
  return light;
}

/** Before everything that the light's rays pass, as the guide asks for; its map is then fitted by the engine itself. */
function placeSun(scene, light) {
  light.computeTransformedInformation();
  const direction = light.transformedDirection.clone();
  const { min, max } = scene.getWorldExtends();
  light.parent = null;
  light.direction = direction;
  light.position = min
    .add(max)
    .scale(0.5)
    .subtract(direction.scale(0.51 * max.subtract(min).length()));
  light.autoCalcShadowZBounds = true;
}

/** The place of a mesh in the file, by the pointers that the loader leaves: a primitive, whose node is itself or its parent. */
function placeInFile(mesh) {
  const find = (object, pattern) =>
    object?._internalMetadata?.gltf?.pointers?.map((pointer) => pattern.exec(pointer)?.[1]).find((found) => found !== undefined);
  const isNode = /^\/nodes\/(\d+)$/;
  return { node: find(mesh, isNode) ?? find(mesh.parent, isNode), primitive: find(mesh, /\/primitives\/(\d+)$/) ?? 0 };
}

/** The picture's height is the file's; its width follows from its size. */
function setAspect(camera, aspect) {
  if (camera.mode === BABYLON.Camera.ORTHOGRAPHIC_CAMERA)
    Object.assign(camera, { orthoLeft: -aspect * camera.orthoTop, orthoRight: aspect * camera.orthoTop });
}

function white(scene, original) {
  const material = new BABYLON.StandardMaterial("white", scene);
  material.specularColor = BABYLON.Color3.Black();
  material.backFaceCulling = false;
  material.twoSidedLighting = true;
  if (original?.transparencyMode !== BABYLON.PBRMaterial.PBRMATERIAL_ALPHATEST) return material;
  material.opacityTexture = original.albedoTexture; // the mask alone
  material.alphaCutOff = original.alphaCutOff;
  material.transparencyMode = BABYLON.Material.MATERIAL_ALPHATEST;
  return material;
}

const placesShader = {
  vertexSource: `attribute vec3 position; attribute vec2 uv; uniform mat4 world, viewProjection; varying vec3 place; varying vec2 at;
    void main() { vec4 p = world * vec4(position, 1.0); place = p.xyz; at = uv; gl_Position = viewProjection * p; }`,
  fragmentSource: `precision highp float; varying vec3 place; varying vec2 at; uniform sampler2D mask; uniform float cutoff;
    void main() { if (cutoff > 0.0 && texture2D(mask, at).a < cutoff) discard; gl_FragColor = vec4(place, 1.0); }`,
};

function places(scene, original) {
  const material = new BABYLON.ShaderMaterial("places", scene, placesShader, {
    attributes: ["position", "uv"],
    uniforms: ["world", "viewProjection", "cutoff"],
    samplers: ["mask"],
  });
  material.backFaceCulling = false;
  const masked = original?.transparencyMode === BABYLON.PBRMaterial.PBRMATERIAL_ALPHATEST;
  material.setFloat("cutoff", masked ? original.alphaCutOff : 0);
  if (masked) material.setTexture("mask", original.albedoTexture);
  return material;
}

async function drawFloats(scene, width, height, make) {
  const target = new BABYLON.RenderTargetTexture("floats", { width, height }, scene, {
    generateMipMaps: false,
    type: BABYLON.Constants.TEXTURETYPE_FLOAT,
    samplingMode: BABYLON.Texture.NEAREST_SAMPLINGMODE,
  });
  target.renderList = scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
  target.clearColor = new BABYLON.Color4(0, 0, 0, 0);
  target.activeCamera = scene.activeCamera;
  const made = new Map();
  for (const mesh of target.renderList) {
    if (!made.has(mesh.material)) made.set(mesh.material, make(scene, mesh.material));
    target.setMaterialForRendering(mesh, made.get(mesh.material));
  }
  scene.customRenderTargets.push(target);
  await scene.whenReadyAsync();
  while (!target.isReadyForRendering()) await new Promise((done) => setTimeout(done, 20));
  scene.render();
  scene.render(); // in the first frame the shadow map comes after this target
  const pixels = await target.readPixels();
  scene.customRenderTargets.pop();
  target.dispose();
  return pixels;
}

async function prepare(canvas, task) {
  await loadScript("/node_modules/babylonjs/babylon.js");
  await loadScript("/node_modules/babylonjs-loaders/babylonjs.loaders.min.js");
  const settings = settled(
    task.settings,
    { type: "none", mapSize: 1024, bias: 0.00005, normalBias: 0, full_float: 0 },
    { type: Object.keys(types), full_float: [0, 1] },
  );
  const { width, height } = task;
  ((canvas.width = width), (canvas.height = height));
  const engine = new BABYLON.Engine(canvas, false, { preserveDrawingBuffer: true });
  const scene = new BABYLON.Scene(engine);
  scene.useRightHandedSystem = true; // the glTF's own world
  scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
  scene.imageProcessingConfiguration.isEnabled = false;
  // As meshes of their own: our shader does not draw hardware instances.
  await BABYLON.AppendSceneAsync(task.scene, scene, { pluginOptions: { gltf: { createInstances: false } } });
  scene.activeCamera = scene.cameras[0];
  setAspect(scene.activeCamera, width / height);
  const light = chooseLight(scene, task.light),
    sun = light instanceof BABYLON.DirectionalLight;
  if (sun) placeSun(scene, light);
  const generator = new BABYLON.ShadowGenerator(settings.mapSize, light, settings.full_float === 1);
  Object.assign(generator, { bias: settings.bias, normalBias: settings.normalBias });
  if (types[settings.type]) generator[types[settings.type]] = true;
  const gltf = await readGltf(task.scene);
  for (const mesh of scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0)) {
    const { node, primitive } = placeInFile(mesh),
      { casts, receives } = shadowFlags(gltf, node, primitive);
    if (casts) generator.addShadowCaster(mesh, false);
    mesh.receiveShadows = receives;
  }
  await scene.whenReadyAsync();
  return { settings, width, height, engine, scene, light, sun, generator };
}

/** A page that draws the scene in each animation frame. */
export async function show(canvas, task) {
  const { engine, scene } = await prepare(canvas, task);
  engine.runRenderLoop(() => scene.render());
}

export async function capture(canvas, task) {
  const { settings, width, height, engine, scene, light, sun, generator } = await prepare(canvas, task);
  const shadowed = await drawFloats(scene, width, height, white);
  const picture = await new Promise(
    (done) =>
      engine.onEndFrameObservable.addOnce(() => done(canvas.toDataURL())) && (engine.beginFrame(), scene.render(), engine.endFrame()),
  );
  let map;
  if (sun && settings.type === "none") {
    const texels = await generator.getShadowMap().readPixels();
    map = [
      {
        texels: channel(texels, settings.mapSize, settings.mapSize, 0, { flip: false }),
        size: settings.mapSize,
        convention: "minus_one_to_one",
        rows: "bottom_up",
        clip_from_world: [...generator.getTransformMatrix().asArray()],
      },
    ];
  }
  light.shadowEnabled = false;
  const unshadowed = await drawFloats(scene, width, height, white),
    world = await drawFloats(scene, width, height, places);
  return {
    renderer: { name: "Babylon.js", version: BABYLON.Engine.Version, settings },
    light: light.name,
    picture,
    shadowed: channel(shadowed, width, height, 0),
    unshadowed: channel(unshadowed, width, height, 0),
    covered: channel(world, width, height, 3),
    position: [0, 1, 2].map((c) => channel(world, width, height, c)),
    map,
    bias: {},
    filter: { kind: "none" }, // its biases move the casters and so lie in the map
  };
}
