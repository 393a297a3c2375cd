// The engine of the lab's page where no program serves it: a worker that has the program for the web, takes the page's requests, and
// draws and compares between them.
import gnomon from "./gnomon.mjs";

const quiet_turns = 8;  // that nothing came of, more than a comparison takes: then there is nothing to do
const waiting = [];     // requests for news of a moment that has not come
let module, number = 0, quiet = 0, turning = false;

function asked(name, parameters, body) {
  const bytes = new Uint8Array(body ?? 0), at = module._malloc(bytes.length || 1);
  module.HEAPU8.set(bytes, at);
  module.ccall("gnomon_lab_answer", null, ["string", "string", "number", "number"], [name, Object.entries(parameters).map(([key, value]) => `${key}=${value}`).join("\n"), at, bytes.length]);
  module._free(at);
  return module.answer;
}
const tell = (id, answer) => postMessage({ id, ...answer }, [answer.body.buffer]);
const failed = (error) => ({ status: 500, type: "text/plain", body: new TextEncoder().encode(String(error?.message ?? error)) });

function tellNews() {
  for (const request of waiting.splice(0))
    if (number > Number(request.parameters.after)) tell(request.id, asked("news", request.parameters));
    else waiting.push(request);
}

const channel = new MessageChannel();
const turnSoon = () => { if (!turning) { turning = true; channel.port2.postMessage(null); } };
channel.port1.onmessage = () => {
  turning = false;
  try {
    const now = module.ccall("gnomon_lab_turn", "number", [], []);
    quiet = now === number ? quiet + 1 : 0;
    number = now;
    tellNews();
    if (quiet < quiet_turns) turnSoon();
  } catch (error) {
    postMessage({ gone: module.ctx?.isContextLost() ? "The browser has taken the graphics away (context lost)." : String(error?.message ?? error) });
  }
};

async function begin({ scene, size }) {
  module = await gnomon({ thisProgram: "gnomon" });
  module.FS.mkdirTree("/dropped");
  module.ccall("gnomon_lab_begin", null, ["string", "number", "number"], [scene, size.width, size.height]);
  if (module.answer.status !== 200) throw new Error(new TextDecoder().decode(module.answer.body));
  turnSoon();
}
/** A command line over files in memory: its exit code, what it said, and a file that it wrote. */
function ran(words, file) {
  const code = module.callMain(words);
  return { status: code === 0 ? 200 : 500, type: "text/html", body: code === 0 ? module.FS.readFile(file) : new Uint8Array(0) };
}

let begun;
onmessage = async ({ data: { id, name, parameters, body } }) => {
  try {
    if (name === "begin") return void (await (begun = begin(parameters)), tell(id, { status: 200, type: "text/plain", body: new Uint8Array(0) }));
    await begun;
    if (name === "news") { waiting.push({ id, parameters }); return tellNews(); }
    tell(id, name === "report" ? ran([...parameters.words.split("\n"), "-o", "/report", "--quiet", "--report-max-mb", "1000"], "/report/report.html") : asked(name, parameters, body));
    quiet = 0;
    turnSoon();
  } catch (error) {
    tell(id, failed(error));
  }
};
