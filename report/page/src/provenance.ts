// Where a page's numbers come from: the command and what it ran on.
import { resultDocument } from "./document";
import { saveLinks } from "./frame";
import { markup, type Markup } from "./template";

interface Provenance {
  command: string;
  version: string;
  scene: { path: string; sha256: string };
  gl: { version: string; backend: string; renderer: string };
}

export type Entry = [name: string, value: Markup | string];

/** `before` and `after` OpenGL. */
export function provenance(before: Entry[] = [], after: Entry[] = []): Markup {
  const { command, version, scene, gl } = resultDocument<Provenance>();
  const entries: Entry[] = [
    ["Scene", scene.path],
    ["SHA-256 of the scene file", scene.sha256],
    ["Gnomon", version],
    ...before,
    ["OpenGL", `${gl.version} through ${gl.backend}: ${gl.renderer}`],
    ...after,
  ];
  return markup`<section id="provenance" aria-labelledby="provenance-title">
<h2 id="provenance-title">Where this comes from</h2>
<p class="command"><code>${command}</code></p>
<dl class="provenance">
${entries.filter(([, value]) => value !== "").map(([name, value]) => markup`<div><dt>${name}</dt><dd>${value}</dd></div>\n`)}</dl>
${saveLinks}</section>
`;
}
