// The program for the web in a worker, of a page or of Node. It runs command lines over files in memory ("run"), computes a lesson's
// figure ("figure"), and is the engine of the lab's page. It takes the page's requests, and draws and compares between them.
import gnomon from "./gnomon.mjs";

const quiet_turns = 8; // that nothing came of, more than a comparison takes: then there is nothing to do
const looks = 40,
  between_looks = 25; // after them, and milliseconds apart: whether the GPU tells what shadows took
const waiting = []; // requests for news of a moment that has not come
const port = globalThis.WorkerGlobalScope ? globalThis : (await import("node:worker_threads")).parentPort;
let loading,
  module,
  said = { out: "", err: "" },
  number = 0,
  quiet = 0,
  turning = false;

const load = (wasmBinary) =>
  (loading ??= gnomon({
    ...(wasmBinary && { wasmBinary }),
    thisProgram: "gnomon",
    print: (line) => {
      said.out += `${line}\n`;
    },
    printErr: (line) => {
      said.err += `${line}\n`;
    },
  }).then((made) => {
    module = made;
    module.FS.mkdirTree("/given");
    module.FS.chdir("/given");
  }));

/** A command line: its exit code, what it said, how long it took, and the files that it was to write, which are gone then like those it
 *  was given. `files`: {PATH: bytes or text}; a path that is not there is null. */
function run({ words, files = {}, wanted = [] }) {
  for (const [path, content] of Object.entries(files)) {
    const whole = `${path.startsWith("/") ? "" : "/given/"}${path}`;
    module.FS.mkdirTree(whole.slice(0, whole.lastIndexOf("/")));
    module.FS.writeFile(path, content);
  }
  said = { out: "", err: "" };
  const begin = performance.now(),
    code = module.callMain(words),
    ms = performance.now() - begin;
  const read = (path) => {
    try {
      return module.FS.readFile(path);
    } catch {
      return null;
    }
  };
  const written = wanted.map(read);
  for (const path of [...Object.keys(files), ...wanted])
    try {
      module.FS.unlink(path);
    } catch {
      /* not there */
    }
  return { code, ...said, ms, files: written };
}
function report(words) {
  const {
    code,
    err,
    files: [page],
  } = run({ words: [...words, "-o", "/report", "--quiet", "--report-max-mb", "1000"], wanted: ["/report/report.html"] });
  return code === 0
    ? { status: 200, type: "text/html", body: page }
    : { status: 500, type: "text/plain", body: new TextEncoder().encode(err) };
}

function asked(name, parameters, body) {
  const bytes = new Uint8Array(body ?? 0),
    at = module._malloc(bytes.length || 1);
  module.HEAPU8.set(bytes, at);
  module.ccall(
    "gnomon_lab_answer",
    null,
    ["string", "string", "number", "number"],
    [
      name,
      Object.entries(parameters)
        .map(([key, value]) => `${key}=${value}`)
        .join("\n"),
      at,
      bytes.length,
    ],
  );
  module._free(at);
  return module.answer;
}
const tell = (id, answer) =>
  port.postMessage(
    { id, ...answer },
    [answer.body, ...(answer.files ?? [])].filter(Boolean).map(({ buffer }) => buffer),
  );
const failed = (error) => ({
  status: 500,
  type: "text/plain",
  body: new TextEncoder().encode(String(error?.message ?? error?.name ?? error)),
});

function tellNews() {
  for (const request of waiting.splice(0))
    if (number > Number(request.parameters.after)) tell(request.id, asked("news", request.parameters));
    else waiting.push(request);
}

const channel = new MessageChannel();
const turnSoon = () => {
  if (!turning) {
    turning = true;
    channel.port2.postMessage(null);
  }
};
channel.port1.onmessage = () => {
  turning = false;
  try {
    const now = module.ccall("gnomon_lab_turn", "number", [], []);
    quiet = now === number ? quiet + 1 : 0;
    number = now;
    tellNews();
    if (quiet < quiet_turns) turnSoon();
    else if (quiet < quiet_turns + looks) setTimeout(turnSoon, between_looks);
  } catch (error) {
    port.postMessage({
      gone: module.ctx?.isContextLost() ? "The browser has taken the graphics away (context lost)." : String(error?.message ?? error),
    });
  }
};

/** `program`: its bytes, where they are no file beside this one. */
async function begin({ scene, size, program }) {
  await load(program);
  module.FS.mkdirTree("/dropped");
  module.ccall("gnomon_lab_begin", null, ["string", "number", "number"], [scene, size.width, size.height]);
  if (module.answer.status !== 200) throw new Error(new TextDecoder().decode(module.answer.body));
  turnSoon();
}

let begun;
port.onmessage = async ({ data: { id, name, parameters, body } }) => {
  try {
    if (name === "run") return void (await (begun ?? load()), tell(id, { status: 200, ...run(parameters) }));
    if (name === "figure") return void (await (begun ?? load()), tell(id, asked(name, parameters)));
    if (name === "begin")
      return void (await (begun = begin(parameters)), tell(id, { status: 200, type: "text/plain", body: new Uint8Array(0) }));
    await begun;
    if (name === "news") {
      waiting.push({ id, parameters });
      return tellNews();
    }
    tell(id, name === "report" ? report(parameters.words.split("\n")) : asked(name, parameters, body));
    quiet = 0;
    turnSoon();
  } catch (error) {
    tell(id, failed(error));
  }
};
