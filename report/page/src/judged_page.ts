// The page of several captures: a row for each, the worst first.
import { resultDocument } from "./document";
import { showSections } from "./frame";
import { percent, plainNumber } from "./number_text";
import { markup, scrollRegion, type Markup } from "./template";

interface Judged {
  name: string;
  folder: string; // of its own page, as a part of an address
  refused?: string; // why it was not judged
  scene: string;
  renderer: string;
  compared: number;
  wrong: number;
  mean_error: number;
  labels: string;
  edge_pixels: number;
  detachment_world: number | null;
  advice: string;
}

function row(capture: Judged): Markup {
  const { name, folder, refused, scene, renderer, compared, advice } = capture;
  if (refused) return markup`<tr><th scope="row">${name}</th><td colspan="7">not judged: ${refused}</td></tr>\n`;
  const head = markup`<tr><th scope="row"><a href="${folder}/report.html">${name}</a><small>${scene}</small></th><td>${renderer}</td>`;
  if (compared === 0) return markup`${head}<td colspan="5">nothing compared</td><td>${advice}</td></tr>\n`;
  return markup`${head}<td class="n">${percent(capture.wrong)}</td><td class="n">${percent(
    capture.mean_error,
  )}</td><td>${capture.labels}</td><td
class="n">${plainNumber(capture.edge_pixels)}</td><td class="n">${
    capture.detachment_world === null ? "–" : plainNumber(capture.detachment_world)
  }</td><td>${advice}</td></tr>\n`;
}

export function startJudged(): void {
  const { captures } = resultDocument<{ captures: Judged[] }>();
  showSections([
    {
      id: "captures",
      link: "Captures",
      html: markup`<section id="captures" aria-labelledby="captures-title"><h1 id="captures-title">Captures judged</h1>
<p>The worst first. Each name opens that capture's own report. Edges: how far drawn shadow edges lie from the true
ones, root mean square in pixels. Detached: how far shadows start from what casts them, mean in world units.</p>
${scrollRegion(
  "Captures",
  markup`<table class="captures"><thead><tr><th scope="col">capture</th><th scope="col">drawn by</th><th
scope="col" class="n">wrong</th><th scope="col" class="n">mean error</th><th scope="col">mostly</th><th
scope="col" class="n">edges</th><th scope="col" class="n">detached</th><th scope="col">advice</th></tr></thead><tbody>
${captures.map(row)}</tbody></table>`,
)}</section>
`,
    },
  ]);
}
