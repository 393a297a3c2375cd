// A scene from the page that opened this one: a page of three.js, whose script is adapters/open_in_lab.mjs.
import type { Options } from "./lab_state";

export interface Handed {
  file: File;
  options: Options;
  words: string; // where it came from, and what was left there
}

function read({ data, origin }: MessageEvent): Handed | null {
  const said = (typeof data === "object" && data !== null ? data : {}) as Record<string, unknown>;
  if (said.gnomon !== "scene" || !(said.glb instanceof ArrayBuffer)) return null;
  const options = Object.entries(said.options ?? {}).filter(
    ([name, value]) => /^[a-z][a-z0-9-]*$/.test(name) && typeof value === "string",
  ) as [string, string][];
  const left = Array.isArray(said.notes) ? said.notes.filter((note) => typeof note === "string").join("; ") : "";
  return {
    file: new File([said.glb], "scene.glb"),
    options: new Map(options),
    words: `This scene came from the page at ${origin}.${left && ` Not brought along: ${left}.`}`,
  };
}

/** Asks the page that opened this one for its scene, and takes the first that it hands in, as if it had been dropped. Nothing goes back
    but the question. */
export function listenToOpener(take: (handed: Handed) => void): void {
  const opener = window.opener as Window | null;
  if (!opener) return;
  const hear = (event: MessageEvent): void => {
    const handed = event.source === opener ? read(event) : null;
    if (!handed) return;
    window.removeEventListener("message", hear);
    take(handed);
  };
  window.addEventListener("message", hear);
  opener.postMessage({ gnomon: "ready" }, "*");
}
