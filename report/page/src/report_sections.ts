// The sections of a comparison's page, from its document: what stands before it, the first screen, each light, what it cost,
// what was simulated, and where the numbers come from.
import { costSection } from "./cost_section";
import { keyed, keyedCount } from "./document";
import type { Section } from "./frame";
import { lightSection } from "./light_section";
import { plainNumber } from "./number_text";
import { overviewSection } from "./overview_section";
import { provenance, type Entry } from "./provenance";
import { facts, plain, result } from "./report_document";
import { flowing, markup, scrollRegion, type Markup } from "./template";
import { tuneSection } from "./tune_sections";
import { viewsSection } from "./views_section";

// Who drew a picture of another renderer's and how, whether it shows the scene as Gnomon sees it, and what to set.
function judgeSection(lines: [name: string, value: string][]): Markup {
  const { renderer, identified } = result.judged!;
  return markup`<section id="judge" aria-labelledby="judge-title">
<h1 id="judge-title">What ${renderer.name}${renderer.version && ` ${renderer.version}`} drew</h1>
${scrollRegion(
  "What is said of the capture",
  markup`<table class="capture"><tbody>
${lines.map(([name, value]) => markup`<tr><th scope="row">${name}</th><td>${flowing(value)}</td></tr>\n`)}</tbody></table>`,
)}<p>What follows is the comparison of that picture with the truth${
    identified !== null && "; labels and steps are inferred from the nearest setting"
  }.</p></section>
`;
}

function effectsSection(): Markup {
  const {
    effects,
    scene: { notes },
  } = result;
  return markup`<section id="effects" aria-labelledby="effects-title">
<h2 id="effects-title">What was simulated</h2>
<p>Only what the scene calls for runs; the rest costs nothing.</p>
${scrollRegion(
  "Effects",
  markup`<table class="effects"><thead><tr><th scope="col">effect</th><th scope="col">here</th>
<th scope="col">because</th></tr></thead><tbody>
${effects.map(
  ({ effect, called_for, simulated, reason }) =>
    markup`<tr class="${simulated ? "on" : called_for ? "lacking" : "off"}"><th scope="row">${effect.replaceAll("_", " ")}</th><td>${
      simulated ? "simulated" : called_for ? "asked for, not simulated" : "not needed"
    }</td><td>${reason}</td></tr>\n`,
)}</tbody></table>`,
)}${notes.length > 0 && markup`<h3>Notes</h3>\n<ul class="notes">\n${notes.map((note) => markup`<li>${note}</li>\n`)}</ul>\n`}</section>
`;
}

/** What stands between the program and OpenGL, and behind it. */
const before = (): Entry[] => [
  ["Threads and seed", markup`${keyedCount("threads")} and ${keyed("seed", String)}`],
  ["Processor", `${result.machine.cpu}, ${result.machine.cores} cores`],
  ["System", result.machine.os],
  ["Load of the machine", typeof result.machine.load === "number" ? plainNumber(result.machine.load) : ""],
];
const after = (): Entry[] => [
  ...result.shaders.map(({ replaced, sha256 }): Entry => ["Replaced shader", `${replaced}, SHA-256 ${sha256}`]),
  ["Exposure of both pictures", plain("exposure")],
];

export function reportSections(): Section[] {
  const named = (id: string, link: string, html: Markup): Section => ({ id, link, html });
  return [
    ...(facts.judged ? [named("judge", "Capture", judgeSection(facts.judged))] : []),
    ...(facts.tune ? [named("tune", "Answer", tuneSection(facts.tune))] : []),
    named("overview", "Overview", overviewSection()),
    ...(result.views ? [named("views", "Views", viewsSection(result.views))] : []),
    ...result.lights.map((light, i) => named(`light-${i}`, `Light: ${facts.light_facts[i]!.name}`, lightSection(light, i))),
    named("cost", "Time and work", costSection()),
    named("effects", "Effects", effectsSection()),
    named("provenance", "Provenance", provenance(before(), after())),
  ];
}
