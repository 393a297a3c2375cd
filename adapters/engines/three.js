// three.js. Options, by its own names: --type basic | pcf | vsm, --mapSize, --bias, --normalBias, --radius; their
// defaults are three.js'. (PCFSoftShadowMap is no longer a type of its own there: it draws as PCFShadowMap.)
// A sun's camera is fitted to the scene's bounding box; a spot's and a point's are what three.js makes of them.
// What is captured is three.js' own getShadowMask(), drawn through its own vertex code at every visible pixel.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { channel, settled, shadowFlags } from "./common.js";

const types = { basic: THREE.BasicShadowMap, pcf: THREE.PCFShadowMap, vsm: THREE.VSMShadowMap };

/** The light by its name in the file, all others switched off. */
function chooseLight(gltf, wanted) {
  const lights = [];
  gltf.scene.traverse((object) => object.isLight && lights.push(object));
  const nameOf = (light) => gltf.parser.json.nodes[gltf.parser.associations.get(light).nodes].name;
  const light = wanted === undefined ? lights[0] : lights.find((l) => nameOf(l) === wanted);
  if (!light) throw new Error(`--light: no such light (got ${wanted}, allowed ${lights.map(nameOf).join(", ")})`);
  for (const other of lights) other.visible = other === light;
  return { light, name: nameOf(light) };
}

/** Moves a sun before the scene's box and fits its camera around it. */
function fitSun(scene, light) {
  const from = new THREE.Vector3().setFromMatrixPosition(light.matrixWorld);
  const direction = new THREE.Vector3().setFromMatrixPosition(light.target.matrixWorld).sub(from).normalize();
  const box = new THREE.Box3().setFromObject(scene),
    center = box.getCenter(new THREE.Vector3());
  const radius = 0.5 * box.getSize(new THREE.Vector3()).length();
  scene.add(light, light.target);
  light.position.copy(center).addScaledVector(direction, -1.01 * radius);
  light.target.position.copy(center);
  light.quaternion.identity();
  scene.updateMatrixWorld(true);
  const { camera } = light.shadow;
  camera.position.copy(light.position);
  camera.lookAt(center);
  camera.updateMatrixWorld();
  const seen = new THREE.Box3();
  for (let corner = 0; corner < 8; ++corner)
    seen.expandByPoint(
      new THREE.Vector3(...["x", "y", "z"].map((axis, i) => ((corner >> i) & 1 ? box.max : box.min)[axis])).applyMatrix4(
        camera.matrixWorldInverse,
      ),
    );
  Object.assign(camera, {
    left: seen.min.x,
    right: seen.max.x,
    bottom: seen.min.y,
    top: seen.max.y,
    near: 0.99 * -seen.max.z,
    far: 1.01 * -seen.min.z,
  });
  camera.updateProjectionMatrix();
}

/** As the file's extras say for each mesh: a primitive, whose node is itself or a group around it. */
function setFlags(gltf) {
  const { associations, json } = gltf.parser;
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    let holder = object;
    while (associations.get(holder)?.nodes === undefined) holder = holder.parent;
    const { casts, receives } = shadowFlags(json, associations.get(holder).nodes, associations.get(object).primitives ?? 0);
    Object.assign(object, { castShadow: casts, receiveShadow: receives });
  });
}

/** The picture's height is the file's; its width follows from its size. */
function setAspect(camera, aspect) {
  if (camera.isOrthographicCamera) Object.assign(camera, { left: -aspect * camera.top, right: aspect * camera.top });
  else camera.aspect = aspect;
  camera.updateProjectionMatrix();
}

/** The material's own geometry, sides and alpha test, but a colour of ours. */
function probe(original, color) {
  const material = new THREE.MeshStandardMaterial({
    map: original.map,
    alphaTest: original.alphaTest,
    side: original.side,
    flatShading: original.flatShading,
    opacity: original.opacity,
  });
  material.shadowSide = original.shadowSide;
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("void main() {", "varying vec3 vWorldPlace;\nvoid main() {")
      .replace("#include <project_vertex>", "#include <project_vertex>\nvWorldPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;");
    shader.fragmentShader = shader.fragmentShader
      .replace("void main() {", "varying vec3 vWorldPlace;\n#include <shadowmask_pars_fragment>\nvoid main() {")
      .replace("#include <opaque_fragment>", `gl_FragColor = vec4(${color}, 1.0);`);
  };
  material.customProgramCacheKey = () => color;
  return material;
}

function withMaterials(scene, make, work) {
  const before = new Map();
  scene.traverse((object) => {
    if (!object.isMesh) return;
    before.set(object, object.material);
    object.material = make(object.material);
  });
  const result = work();
  for (const [object, material] of before) object.material = material;
  return result;
}

function drawFloats(renderer, width, height, draw) {
  const target = new THREE.WebGLRenderTarget(width, height, {
    type: THREE.FloatType,
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
  });
  renderer.setRenderTarget(target);
  draw();
  const pixels = new Float32Array(width * height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  renderer.setRenderTarget(null);
  target.dispose();
  return pixels;
}

/** The depth texture's own values, row by row from the bottom; of a cube's face along the rays of its camera. */
function readDepth(renderer, shadow, size, face) {
  const cube = face !== undefined;
  const material = new THREE.ShaderMaterial({
    uniforms: { depths: { value: shadow.map.depthTexture }, rotation: { value: cube ? new THREE.Matrix3().setFromMatrix4(face) : null } },
    vertexShader: "varying vec2 place; void main() { place = position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `uniform highp ${cube ? "samplerCube" : "sampler2D"} depths; uniform mat3 rotation; varying vec2 place;
      void main() { gl_FragColor = texture(depths, ${cube ? "rotation * vec3(place, -1.0)" : "0.5 * place + 0.5"}); }`,
  });
  const scene = new THREE.Scene().add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material));
  return channel(
    drawFloats(renderer, size, size, () => renderer.render(scene, new THREE.Camera())),
    size,
    size,
    0,
    { flip: false },
  );
}

const cubeFaces = [
  [1, 0, 0, 0, -1, 0],
  [-1, 0, 0, 0, -1, 0],
  [0, 1, 0, 0, 0, 1],
  [0, -1, 0, 0, 0, -1],
  [0, 0, 1, 0, -1, 0],
  [0, 0, -1, 0, -1, 0],
];

function readMap(renderer, light, size) {
  const { shadow } = light,
    { camera } = shadow;
  const layer = (texels) => ({
    texels,
    size,
    convention: "minus_one_to_one",
    rows: "bottom_up",
    clip_from_world: new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements,
  });
  if (!light.isPointLight) return [layer(readDepth(renderer, shadow, size))];
  return cubeFaces.map(([x, y, z, ...up]) => {
    camera.up.set(...up);
    camera.lookAt(camera.position.clone().add(new THREE.Vector3(x, y, z)));
    camera.updateMatrixWorld();
    return layer(readDepth(renderer, shadow, size, camera.matrixWorld));
  });
}

async function prepare(canvas, task) {
  const settings = settled(task.settings, { type: "pcf", mapSize: 512, bias: 0, normalBias: 0, radius: 1 }, { type: Object.keys(types) });
  const { width, height } = task;
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true });
  renderer.setSize(width, height);
  renderer.setClearColor(0, 0);
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = types[settings.type];
  const gltf = await new GLTFLoader().loadAsync(task.scene);
  const scene = new THREE.Scene().add(gltf.scene);
  scene.updateMatrixWorld(true);
  setFlags(gltf);
  const camera = gltf.cameras[0];
  setAspect(camera, width / height);
  const { light, name } = chooseLight(gltf, task.light);
  if (light.isPointLight && settings.type === "vsm") throw new Error("--type vsm: three.js has none for a point light");
  light.castShadow = true;
  Object.assign(light.shadow, { bias: settings.bias, normalBias: settings.normalBias, radius: settings.radius });
  light.shadow.mapSize.set(settings.mapSize, settings.mapSize);
  if (light.isDirectionalLight) fitSun(scene, light);
  return { settings, width, height, renderer, scene, camera, light, name };
}

/** A page that draws the scene in each animation frame. */
export async function show(canvas, task) {
  const { renderer, scene, camera } = await prepare(canvas, task);
  renderer.setAnimationLoop(() => renderer.render(scene, camera));
}

export async function capture(canvas, task) {
  const { settings, width, height, renderer, scene, camera, light, name } = await prepare(canvas, task);
  const drawn = (color) =>
    withMaterials(
      scene,
      (material) => probe(material, color),
      () => drawFloats(renderer, width, height, () => renderer.render(scene, camera)),
    );
  const mask = drawn("vec3(getShadowMask())"),
    places = drawn("vWorldPlace");
  renderer.render(scene, camera);
  const picture = canvas.toDataURL();
  if (settings.type === "pcf") {
    // its texture only compares; the same map as BasicShadowMap can be read
    renderer.shadowMap.type = THREE.BasicShadowMap;
    renderer.render(scene, camera);
  }
  return {
    renderer: { name: "three.js", version: `r${THREE.REVISION}`, settings },
    light: name,
    picture,
    visibility: channel(mask, width, height, 0),
    covered: channel(mask, width, height, 3),
    position: [0, 1, 2].map((c) => channel(places, width, height, c)),
    map: readMap(renderer, light, settings.mapSize),
    bias: { constant_depth: -settings.bias, normal_offset_world: settings.normalBias },
    filter: settings.type === "basic" ? { kind: "none" } : { kind: settings.type, radius_texels: settings.radius + 1 },
  };
}
