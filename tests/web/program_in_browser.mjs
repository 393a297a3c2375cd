// The program for the web in a worker of a browser page, as a page's engine has it: command lines over files in memory.
import { createServer } from "node:http";
import { createReadStream, existsSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import path from "node:path";
import { browser } from "../browser/open_page.mjs";

export { skip } from "../browser/open_page.mjs";

export const app = fileURLToPath(new URL("../../build/web/app/", import.meta.url));
export const isBuilt = existsSync(path.join(app, "gnomon.wasm"));

const worker = (lacking) => `
const extension = WebGL2RenderingContext.prototype.getExtension;
WebGL2RenderingContext.prototype.getExtension = function (name) { return ${JSON.stringify(lacking)}.includes(name) ? null : extension.call(this, name); };
${readFileSync(path.join(app, "gnomon_worker.mjs"), "utf8")}`;
const types = { ".mjs": "text/javascript", ".js": "text/javascript", ".wasm": "application/wasm", ".html": "text/html" };

/** A host of plain files; `made`: {PATH: [TYPE, TEXT]} besides. Returns its address and what ends it. */
export async function serveFolder(folder, made = {}) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    const file = path.join(folder, path.normalize(pathname.endsWith("/") ? `${pathname}index.html` : pathname));
    const [type, text] = made[pathname] ?? [types[path.extname(file)]];
    if (!type || (text === undefined && !existsSync(file))) return response.writeHead(404).end();
    response.writeHead(200, { "Content-Type": type, "Access-Control-Allow-Origin": "*" }); // as page hosts say
    return text === undefined ? createReadStream(file).pipe(response) : response.end(text);
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${server.address().port}/`, stop: () => server.close() };
}

/** Opens a page that has the built program in a worker. `lacking`: extensions of WebGL that are not there; `given`: {PATH: TEXT}, for each run. */
export async function openProgram(lacking = [], given = {}) {
  const host = await serveFolder(app, {
    "/": ["text/html", "<!doctype html><title>Program</title>"],
    "/worker.mjs": ["text/javascript", worker(lacking)],
  });
  const page = await browser.newPage();
  page.on("console", (message) => console.log(`browser: ${message.text()}`));
  await page.goto(host.url);
  await page.evaluate(() => {
    globalThis.program = new Worker("worker.mjs", { type: "module" });
  });
  /** Runs a command line, and hands out the files that it wrote. */
  const run = async (words, ...files) => {
    const done = await page.evaluate(
      (asked) =>
        new Promise((tell, fail) => {
          globalThis.program.onerror = (event) => fail(new Error(event.message));
          globalThis.program.onmessage = ({ data }) => {
            const text = (bytes) => {
              const parts = [];
              for (let at = 0; at < bytes.length; at += 4096) parts.push(String.fromCharCode(...bytes.subarray(at, at + 4096)));
              return btoa(parts.join(""));
            };
            if (data.status !== 200) return fail(new Error(new TextDecoder().decode(data.body)));
            tell({ ...data, said: data.out + data.err, files: data.files.map((bytes) => (bytes ? text(bytes) : null)) });
          };
          globalThis.program.postMessage({ id: 1, name: "run", parameters: asked });
        }),
      { words, files: given, wanted: files },
    );
    return { ...done, files: done.files.map((text) => (text === null ? null : Buffer.from(text, "base64"))) };
  };
  return { run, close: () => page.close().then(() => host.stop()) };
}
