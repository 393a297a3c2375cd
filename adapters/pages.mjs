// The page in which an engine of the web draws: what it is made of, and a server of it for a browser that nobody drives.
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const types = { js: "text/javascript", mjs: "text/javascript", html: "text/html", wasm: "application/wasm", glb: "model/gltf-binary" };
const importMap = JSON.stringify({
  imports: {
    three: "/node_modules/three/build/three.module.js",
    "three/addons/": "/node_modules/three/examples/jsm/",
    playcanvas: "/node_modules/playcanvas/build/playcanvas.mjs",
  },
});

/** A page with a canvas, and a module of its own. */
export const html = (module = "") =>
  `<!doctype html><script type="importmap">${importMap}</script><body style="margin:0"><canvas></canvas>${module && `<script type="module">${module}</script>`}`;

/** {contentType, body} of a path: files of this folder, and of the scene's as /scene/. Undefined: there is none. */
export function fileAt(path, scene) {
  const file = path.startsWith("/scene/") ? join(dirname(scene), path.slice(7)) : join(here, path);
  if (!existsSync(file)) return undefined;
  return { contentType: types[file.split(".").pop()] || "application/octet-stream", body: readFileSync(file) };
}

/** A server for this machine alone whose page draws a job's scene with an engine: {address, close()}. */
export async function serve(engine, { scene, light, width, height, settings }) {
  const task = JSON.stringify({ scene: `/scene/${basename(scene)}`, light, width, height, settings });
  const page = html(`import { show } from "/engines/${engine}.js";
    const task = ${task};
    await show(document.querySelector("canvas"), { ...task, scene: location.origin + task.scene });`);
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://page").pathname);
    const file = path === "/" ? { contentType: "text/html", body: page } : fileAt(path, scene);
    response.writeHead(file ? 200 : 404, { "content-type": file?.contentType ?? "text/plain" }).end(file?.body);
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const close = () => (server.close(), server.closeAllConnections());
  return { address: `http://127.0.0.1:${server.address().port}/`, close };
}
