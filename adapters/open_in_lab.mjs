// Opens the scene that a page of three.js is showing in the lab of a site (gnomon site), which writes this file beside its lab. In
// the page's console, or in its code:
//   import("https://HOST/open_in_lab.mjs").then(({ openInLab }) => openInLab(scene))
// and without the scene, as a bookmark, whatever scene the page draws next. The scene goes as GLB, made by three.js' own exporter;
// the shadow's settings go as the lab's options (docs/engine-units.md has the translation). Nothing of the page is changed for
// longer than one of its frames.

const patience_ms = 20_000; // until a frame is drawn, and until the lab answers
const [frontSide, backSide] = [0, 1]; // three.js' constants
const techniques = ["hard", "pcf", "pcf", "vsm"]; // of its types of shadow maps

/** Rejects with these words when nothing has come for a while. `begin` gets what resolves; what it returns ends the waiting. */
function within(words, begin) {
  return new Promise((done, failed) => {
    let end = () => {};
    const timer = setTimeout(() => {
      end();
      failed(new Error(words));
    }, patience_ms);
    end = begin((value) => {
      clearTimeout(timer);
      end();
      done(value);
    });
  });
}

/** The scene that is drawn next. A renderer asks each object whether it is a level of detail; all but those ask their prototypes. */
export const nextScene = () =>
  within("No scene was drawn by three.js in this page. If it draws only when something changes, turn its camera.", (found) => {
    Object.defineProperty(Object.prototype, "isLOD", {
      configurable: true,
      get() {
        if (this.isScene) found(this);
        return undefined;
      },
      set(value) {
        Object.defineProperty(this, "isLOD", { value, writable: true, enumerable: true, configurable: true });
      },
    });
    return () => delete Object.prototype.isLOD;
  });

/** Renderer and camera of the next frame of a scene; the sides of a reflection's cube are none. */
const nextFrame = (scene) =>
  within("The scene was not drawn. If the page draws only when something changes, turn its camera.", (found) => {
    const before = scene.onBeforeRender;
    scene.onBeforeRender = function (renderer, own, camera, target) {
      before.call(this, renderer, own, camera, target);
      if (!target?.isWebGLCubeRenderTarget) found({ renderer, camera });
    };
    return () => {
      scene.onBeforeRender = before;
    };
  });

function isShown(object) {
  for (let at = object; at; at = at.parent) if (!at.visible) return false;
  return true;
}

function everything(scene) {
  const all = [];
  scene.traverse((object) => {
    if (isShown(object)) all.push(object);
  });
  return all;
}

/** The middle of the meshes' boxes, in the world. */
function middleOf(meshes) {
  let box = null;
  for (const mesh of meshes) {
    if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
    const own = mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrixWorld);
    box = box ? box.union(own) : own;
  }
  const middle = box.min.clone();
  return middle.add(box.max).multiplyScalar(0.5);
}

/** A shadow's near and far plane, the width and height of its map, and the depth at which those hold. */
function measuresOf(light, meshes) {
  const { camera } = light.shadow,
    { near, far } = camera;
  if (light.isDirectionalLight)
    return { near, far, wide: (camera.right - camera.left) / camera.zoom, high: (camera.top - camera.bottom) / camera.zoom };
  const at = middleOf(meshes).applyMatrix4(camera.matrixWorldInverse);
  const depth = light.isSpotLight ? -at.z : Math.max(Math.abs(at.x), Math.abs(at.y), Math.abs(at.z));
  return {
    near,
    far,
    depth,
    wide: (2 * depth) / camera.projectionMatrix.elements[0],
    high: (2 * depth) / camera.projectionMatrix.elements[5],
  };
}

/** Which sides the map leaves out; undefined where that is not the same for all casters. */
function cullOf(meshes, isVsm) {
  const sides = new Set(
    meshes
      .filter(({ castShadow }) => castShadow)
      .flatMap(({ material }) => material)
      .map(({ side, shadowSide }) => shadowSide ?? (isVsm || side > backSide ? side : 1 - side)),
  );
  const [only] = sides;
  return sides.size > 1 ? undefined : only === frontSide ? "back" : only === backSide ? "front" : "none";
}

/** The shadow's settings as the lab's options, and what of them has no such option. */
function settingsOf(light, renderer, camera, meshes) {
  const { shadow } = light,
    notes = [],
    round = (value) => String(Number(value.toPrecision(7)));
  const { near, far, wide, high, depth } = measuresOf(light, meshes),
    technique = techniques[renderer.shadowMap.type];
  if (!technique) throw new Error(`This type of shadow map (${renderer.shadowMap.type}) is none that the lab knows.`);
  const { width, height } = shadow.mapSize,
    { elements } = camera.projectionMatrix;
  if (width !== height) notes.push(`the map's height of ${height} texels (the lab's maps are square)`);
  // A difference of stored depths, and the length that it is.
  const bias = -shadow.bias * (depth === undefined ? far - near : (depth * depth * (far - near)) / (near * far));
  if (depth !== undefined && (shadow.bias || shadow.normalBias))
    notes.push(`how the bias changes with depth (it is right at ${Number(depth.toPrecision(3))} from the light)`);
  const options = {
    size: `640x${Math.max(1, Math.round((640 * elements[0]) / elements[5]))}`,
    "map-size": String(width),
    technique,
    bias: round(bias),
    "normal-offset": round((shadow.normalBias * width) / wide),
    "window-depths": `${round(near)},${round(far)}`,
  };
  if (light.isDirectionalLight) {
    const { left, right, top, bottom, zoom, position } = shadow.camera;
    const middle = position
      .clone()
      .set((left + right) / 2 / zoom, (top + bottom) / 2 / zoom, 0)
      .applyMatrix4(shadow.camera.matrixWorld);
    Object.assign(options, { "window-size": `${round(wide)},${round(high)}`, "window-origin": middle.toArray().map(round).join(",") });
  } else if (light.isSpotLight && shadow.focus !== 1) notes.push("the shadow's focus");
  if (technique === "pcf") {
    Object.assign(options, { "filter-radius": round(Math.max(shadow.radius, 0) + 0.5), "filter-plane": "off" });
    notes.push("the places of the filter's five lookups (the lab's filter is a square)");
  }
  if (technique === "vsm")
    Object.assign(options, { "blur-radius": String(Math.round(shadow.radius)), "bleeding-reduction": "0.3", mipmaps: "off" });
  const cull = cullOf(meshes, technique === "vsm");
  if (cull === undefined) notes.push("which sides cast (materials differ)");
  else options.cull = cull;
  return { options, notes };
}

/** What the exporter writes, with one camera and one light as they stand in the world, and with who casts and receives shadows. */
function asGnomonReads(writer, light, camera) {
  const { elements } = camera.projectionMatrix,
    { near: znear, far: zfar } = camera;
  const node = (object, matrix, more) => {
    writer.json.scenes[0].nodes.push(writer.json.nodes.push({ name: object.name || object.type, matrix: matrix.toArray(), ...more }) - 1);
  };
  return {
    beforeParse() {
      // the exporter's own lights lose the direction of their target
      writer.plugins.find(({ name }) => name === "KHR_lights_punctual").writeNode = () => {};
    },
    writeNode(object, written) {
      delete written.camera;
      if (object.isMesh && !(object.castShadow && object.receiveShadow))
        written.extras = { ...written.extras, casts_shadow: object.castShadow, receives_shadow: object.receiveShadow };
    },
    afterParse() {
      writer.json.cameras = [
        camera.isOrthographicCamera
          ? { type: "orthographic", orthographic: { xmag: 1 / elements[0], ymag: 1 / elements[5], znear: Math.max(znear, 0), zfar } }
          : {
              type: "perspective",
              perspective: { aspectRatio: elements[5] / elements[0], yfov: 2 * Math.atan(1 / elements[5]), znear, zfar },
            },
      ];
      node(camera, camera.matrixWorld, { camera: 0 });
      const { color, intensity, distance, angle, penumbra } = light,
        type = light.isSpotLight ? "spot" : light.isPointLight ? "point" : "directional";
      const punctual = { name: light.name || type, type, color: color.toArray(), intensity };
      if (distance > 0) punctual.range = distance;
      if (type === "spot") punctual.spot = { innerConeAngle: (1 - penumbra) * angle, outerConeAngle: angle };
      writer.json.extensions = { ...writer.json.extensions, KHR_lights_punctual: { lights: [punctual] } };
      writer.extensionsUsed.KHR_lights_punctual = true;
      node(light, light.shadow.camera.matrixWorld, { extensions: { KHR_lights_punctual: { light: 0 } } });
    },
  };
}

async function pagesExporter() {
  try {
    return (await import("three/addons/exporters/GLTFExporter.js")).GLTFExporter;
  } catch {
    throw new Error(
      "This page does not say where three/addons lies (it has no import map of it): its own code has to call openInLab(scene, { GLTFExporter }).",
    );
  }
}

/** The scene as the lab takes it: {glb, options, notes}. */
export async function exportForLab(scene, { GLTFExporter, light: wanted } = {}) {
  const Exporter = GLTFExporter ?? (await pagesExporter());
  const { renderer, camera } = await nextFrame(scene);
  const all = everything(scene),
    meshes = all.filter(({ isMesh }) => isMesh);
  const casting = all.filter((object) => object.isLight && object.castShadow),
    light = wanted ?? casting[0];
  if (!renderer.shadowMap.enabled || !light?.shadow || meshes.length === 0)
    throw new Error(
      "The scene has no light with castShadow over a mesh, or its renderer's shadowMap is not enabled: there is no shadow to look at.",
    );
  if (!light.isDirectionalLight && !light.isSpotLight && !light.isPointLight) throw new Error(`The lab has no such light (${light.type}).`);
  if (light.isPointLight) {
    // its six cameras stand where it stands
    light.shadow.camera.position.setFromMatrixPosition(light.matrixWorld);
    light.shadow.camera.quaternion.identity();
    light.shadow.camera.updateMatrixWorld();
  } else light.shadow.updateMatrices(light);
  const { options, notes } = settingsOf(light, renderer, camera, meshes);
  const others = all.filter((object) => object.isLight && object !== light).map(({ name, type }) => name || type);
  if (others.length > 0) notes.push(`other lights (${others.join(", ")})`);
  const glb = await new Exporter().register((writer) => asGnomonReads(writer, light, camera)).parseAsync(scene, { binary: true });
  return { glb, options, notes };
}

/** Opens the lab with a scene, or with the one that the page draws next, in a window of its own. `lab`: its address. `GLTFExporter`,
    where the page has no import map; `light`: another than the first that casts shadows. */
export async function openInLab(scene, { lab = new URL("lab.html", import.meta.url).href, ...more } = {}) {
  const opened = window.open(lab);
  if (!opened) throw new Error("The browser did not open a window. Allow this page to open some, and try again.");
  const ready = within(`The lab at ${lab} does not answer. A page with the header Cross-Origin-Opener-Policy cannot reach it.`, (found) => {
    const hear = ({ source, data }) => {
      if (source === opened && data?.gnomon === "ready") found();
    };
    window.addEventListener("message", hear);
    return () => window.removeEventListener("message", hear);
  });
  const [handed] = await Promise.all([(async () => exportForLab(scene ?? (await nextScene()), more))(), ready]);
  opened.postMessage({ gnomon: "scene", ...handed }, new URL(lab, location.href).origin, [handed.glb]);
}
