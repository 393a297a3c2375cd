// A page of three.js with a sun, a spot or a point light over a floor, a box and a ring: what its users have, for the tests of
// adapters/open_in_lab.mjs.
import { createServer } from "node:http";
import { existsSync, readFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const adapters = fileURLToPath(new URL("../../adapters/", import.meta.url));
export const hasThree = existsSync(path.join(adapters, "node_modules/three"));

const page = `<!doctype html><title>A page of three.js</title><canvas id="canvas"></canvas>
<script type="importmap">{"imports": {"three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
const asked = new URLSearchParams(location.search), kind = asked.get("light");
const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById("canvas"), preserveDrawingBuffer: true });
renderer.setPixelRatio(1);
renderer.setSize(320, 180);
renderer.shadowMap.enabled = true;
renderer.shadowMap.type = Number(asked.get("type") ?? THREE.BasicShadowMap);
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(40, 320 / 180, 0.1, 100);
camera.position.set(3, 2.5, 5);
camera.lookAt(0, 0.4, 0);
const add = (geometry, place, more = {}) => {
  const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0xffffff, side: Number(asked.get("side") ?? THREE.DoubleSide) }));
  mesh.position.set(...place);
  scene.add(Object.assign(mesh, { castShadow: true, receiveShadow: true }, more));
  return mesh;
};
add(new THREE.PlaneGeometry(8, 8), [0, 0, 0], { name: "floor" }).rotation.x = -Math.PI / 2;
add(new THREE.BoxGeometry(1, 1, 1), [-0.8, 0.5, 0]);
add(new THREE.TorusGeometry(0.5, 0.15, 24, 48), [1, 0.9, 0.3]).rotation.y = 0.7;
add(new THREE.SphereGeometry(0.3, 24, 16), [0.2, 0.3, 1.5], { name: "ball", castShadow: false });
const light = kind === "sun" ? new THREE.DirectionalLight(0xffffff, 2) : kind === "spot" ? new THREE.SpotLight(0xffffff, 60, 0, 0.5, 0.2) : new THREE.PointLight(0xffffff, 60);
light.position.set(1.5, 4, 2.5);
Object.assign(light, { castShadow: true, name: kind });
if (light.target) { light.target.position.set(0.1, 0, 0.2); scene.add(light.target); }
light.shadow.mapSize.set(256, 256);
Object.assign(light.shadow.camera, kind === "sun" ? { left: -3, right: 2.5, bottom: -2.5, top: 2.75, near: 1, far: 9 } : { near: 1, far: 12 });
light.shadow.camera.updateProjectionMatrix();
light.shadow.bias = Number(asked.get("bias") ?? 0);
const group = new THREE.Group();  // lights hang on what moves
group.rotation.set(0.2, 0.4, 0);
scene.add(group);
group.attach(light);
setInterval(() => renderer.render(scene, camera), 100);
const levels = (casts) => {
  light.castShadow = casts;
  renderer.render(scene, camera);
  const gl = renderer.getContext(), bytes = new Uint8Array(4 * 320 * 180);
  gl.readPixels(0, 0, 320, 180, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  light.castShadow = true;
  return bytes;
};
/** Of each pixel from the top: 1 lit, 0 in shadow, 2 dark without any. */
const shadows = () => {
  const own = levels(true), without = levels(false);
  return Array.from({ length: 320 * 180 }, (_, i) => { const at = 4 * ((179 - Math.floor(i / 320)) * 320 + i % 320); return without[at] < 8 ? 2 : Number(own[at] > without[at] / 2); });
};
Object.assign(globalThis, { scene: asked.has("hidden") ? undefined : scene, shadows });
document.documentElement.dataset.ready = "true";
</script>`;

/** Its host, on which adapters/ lies as well; "?light=sun|spot|point&type=0&bias=-0.002&hidden" chooses. */
export async function serveThree() {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost"),
      file = path.join(adapters, path.normalize(pathname));
    if (pathname === "/") return response.writeHead(200, { "Content-Type": "text/html" }).end(page);
    if (!existsSync(file)) return response.writeHead(404).end();
    return response.writeHead(200, { "Content-Type": "text/javascript" }).end(readFileSync(file));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${server.address().port}/`, stop: () => server.close() };
}
