// Where a page's numbers come from: the command and what it ran on.
import { resultDocument } from "./document";
import { markup, type Markup } from "./template";

interface Provenance {
  command: string;
  version: string;
  scene: { path: string; sha256: string };
  gl: { version: string; backend: string; renderer: string };
}

export function provenance(): Markup {
  const { command, version, scene, gl } = resultDocument<Provenance>();
  const entries = [["Scene", scene.path], ["SHA-256 of the scene file", scene.sha256], ["Gnomon", version], ["OpenGL", `${gl.version} through ${gl.backend}: ${gl.renderer}`]];
  return markup`<section id="provenance" aria-labelledby="provenance-title"><h2 id="provenance-title">Where this comes from</h2>
<p class="command"><code>${command}</code></p>
<dl class="provenance">${entries.map(([name, text]) => markup`<div><dt>${name}</dt><dd>${text}</dd></div>`)}</dl></section>
`;
}
