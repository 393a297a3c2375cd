// The lab as one file that opens from the disk: its page with the program for the web packed into it. Such a page starts its worker from
// its own text; browsers start none that is a module there, so that the files of the program become one classic script.

const id = "program";

interface Packed {
  from: string; // the site's address
  state: string; // the page's, "#scene=..."
  worker: string; // its text
  wasm: string; // gzip, base64
}

const held = document.getElementById(id)?.textContent;
/** What this page holds itself; null: its program lies beside it. */
export const packed = held ? (JSON.parse(held) as Packed) : null;

/** Two modules as one classic script: the one that is made by the compiler, and the one that imports it (platform/web). */
function asOneScript(program: string, worker: string): string {
  const plain = program.replaceAll("import.meta.url", `"file:///"`).replace(/export default (\w+);?\s*$/, "");
  return `(async () => {\n${plain}\n${worker.replace(/^import .*$/m, "")}\n})();`;
}

async function through(bytes: BodyInit, by: CompressionStream | DecompressionStream): Promise<ArrayBuffer> {
  return new Response(
    new Response(bytes).body!.pipeThrough(by as ReadableWritablePair<Uint8Array<ArrayBuffer>, Uint8Array<ArrayBuffer>>),
  ).arrayBuffer();
}

function base64(bytes: Uint8Array): string {
  const parts = [],
    step = 0x8000;
  for (let at = 0; at < bytes.length; at += step) parts.push(String.fromCharCode(...bytes.subarray(at, at + step)));
  return btoa(parts.join(""));
}

async function fetched(name: string): Promise<Response> {
  const response = await fetch(name);
  if (!response.ok) throw new Error(`${name}: ${response.status} ${response.statusText}`);
  return response;
}

/** This page, its program within. Rejects where a file of the site cannot be had. */
export async function asOneFile(): Promise<Blob> {
  const [page, program, worker, wasm] = await Promise.all(
    ["", "gnomon.mjs", "gnomon_worker.mjs", "gnomon.wasm"].map((name) => fetched(name || location.pathname)),
  );
  const all: Packed = {
    from: location.href.split("#")[0]!,
    state: location.hash,
    worker: asOneScript(await program!.text(), await worker!.text()),
    wasm: base64(new Uint8Array(await through(await wasm!.arrayBuffer(), new CompressionStream("gzip")))),
  };
  const text = (await page!.text()).replace("worker-src 'self'", "worker-src blob:");
  return new Blob([text, `<script type="application/json" id="${id}">`, JSON.stringify(all).replaceAll("<", "\\u003c"), "</script>\n"], {
    type: "text/html",
  });
}

/** The worker of such a page, and the bytes of its program, which it is to begin with. */
export const startPacked = ({ worker, wasm }: Packed): { worker: Worker; program: Promise<ArrayBuffer> } => ({
  worker: new Worker(URL.createObjectURL(new Blob([worker], { type: "text/javascript" }))),
  program: through(
    Uint8Array.from(atob(wasm), (character) => character.charCodeAt(0)),
    new DecompressionStream("gzip"),
  ),
});
