// Gnomon for pages and Node: the program in a worker, asked by its own command lines over files in memory (index.d.ts has the types).
import { exrBlocks, exrChannels } from "./exr_blocks.mjs";

/** Why there is no result. `code` is the program's exit code: 2 usage, 3 bad input, 5 graphics or resources, 6 internal. */
export class GnomonError extends Error {
  constructor(code, message) {
    super(message);
    this.name = "GnomonError";
    this.code = code;
  }
}

const waiting = new Map(); // {done, refuse} of each request
let last = 0,
  worker; // a promise

/** Ends the program; the next call starts another. What has not come is refused. */
export async function close(why = "the program was closed") {
  const ended = worker;
  worker = undefined;
  for (const { refuse } of waiting.values()) refuse(new GnomonError(6, why));
  waiting.clear();
  await (await ended)?.terminate();
}

function answer(from, { id, status, body, ...ran }) {
  if (status !== 200) return void close(new TextDecoder().decode(body)); // it broke off, and is not to be trusted with more
  waiting.get(id)?.done(ran);
  waiting.delete(id);
  if (waiting.size === 0) from.unref?.(); // Node ends where nobody waits
}

async function startWorker() {
  if (globalThis.Worker) {
    const made = new Worker(new URL("./gnomon_worker.mjs", import.meta.url), { type: "module" });
    made.onmessage = ({ data }) => answer(made, data);
    made.onerror = ({ message }) => void close(message || "the program cannot be loaded: its files are not beside index.mjs");
    return made;
  }
  const threads = await import(/* @vite-ignore */ /* webpackIgnore: true */ "node:worker_threads");
  const made = new threads.Worker(new URL("./gnomon_worker.mjs", import.meta.url));
  made.on("message", (data) => answer(made, data));
  made.on("error", ({ message }) => void close(message));
  return made;
}

async function ask(words, files, wanted) {
  const own = (worker ??= startWorker()),
    asked = await own;
  if (worker !== own) throw new GnomonError(6, "the program was closed");
  asked.ref?.();
  return new Promise((done, refuse) => {
    waiting.set(++last, { done, refuse });
    asked.postMessage({ id: last, name: "run", parameters: { words, files, wanted } });
  });
}

/** {map_size: 512, no_snap: true} as words of a command line. */
function words(options) {
  return Object.entries(options).flatMap(([key, value]) => {
    if (value === undefined || value === false) return [];
    const name = `--${key.replaceAll("_", "-")}`;
    return value === true ? [name] : [`${name}=${Array.isArray(value) ? value.join(",") : value}`];
  });
}

/** Runs a command; `wanted`: files that it writes. An exit code of 1, a limit that is not kept, is a result. */
async function run(command, argument, files, options, more, wanted) {
  const ran = await ask([command, argument, ...words(options), ...more, "--quiet"], files, wanted);
  if (ran.code > 1) throw new GnomonError(ran.code, ran.err.trim());
  return ran;
}

const inflate = async (data) =>
  new Uint8Array(await new Response(new Blob([data]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());

async function channelsOf(bytes) {
  const parts = exrBlocks(bytes);
  return exrChannels(parts, await Promise.all(parts.blocks.map(({ deflated, data }) => (deflated ? inflate(data) : data))));
}

async function comparison(command, argument, files, { report = false, channels = false, ...options }) {
  const more = ["--json", "-", ...(report ? ["-o", "out"] : []), ...(channels ? ["--aov", "channels.exr"] : [])];
  const {
    code,
    out,
    files: [page, exr],
  } = await run(command, argument, files, options, more, ["out/report.html", "channels.exr"]);
  return {
    code,
    result: JSON.parse(out),
    ...(page && { report: new TextDecoder().decode(page) }),
    ...(exr && { frame: await channelsOf(exr) }),
  };
}

class Scene {
  #name;
  #files;

  constructor(name, files, plan) {
    this.#name = name;
    this.#files = files;
    this.plan = plan;
  }
  async #frame(command, options) {
    const {
      files: [exr],
    } = await run(command, this.#name, this.#files, options, ["-o", "frame.exr"], ["frame.exr"]);
    return channelsOf(exr);
  }
  async #picture(command, options) {
    return (await run(command, this.#name, this.#files, options, ["-o", "picture.png"], ["picture.png"])).files[0];
  }
  draw(options = {}) {
    return this.#frame("raster", options);
  }
  drawPicture(options = {}) {
    return this.#picture("raster", options);
  }
  trace(options = {}) {
    return this.#frame("raytrace", options);
  }
  tracePicture(options = {}) {
    return this.#picture("raytrace", options);
  }
  compare(options = {}) {
    return comparison("compare", this.#name, this.#files, options);
  }
}

export async function load(name, files = {}) {
  return new Scene(name, files, JSON.parse((await run("plan", name, files, {}, ["--json", "-"], [])).out));
}

export async function judge(capture, files, options = {}) {
  return comparison("judge", capture, files, options);
}
