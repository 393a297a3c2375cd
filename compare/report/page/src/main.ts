// What the report page gains when scripts may run: the viewer that swipes, flips and enlarges, the probe that reads a
// pixel and draws it in light space, a bias to drag, labels to show alone, views to link to. Without it everything
// that result.json says is still on the page.
import "./report.css";
import { Light, page } from "./data";
import { LightPanel } from "./light_panel";
import { readHash } from "./state";
import { html, svg } from "./svg";

// Exposure in stops, applied to linear light; the pictures are 8 bits deep, so what was clipped stays white.
function addExposureFilter(): void {
  const channels = ["feFuncR", "feFuncG", "feFuncB"].map((name) => svg(name, { type: "linear", slope: "1" }));
  document.body.append(svg("svg", { width: 0, height: 0, "aria-hidden": "true", class: "filters" },
    svg("filter", { id: "exposure", "color-interpolation-filters": "linearRGB" }, svg("feComponentTransfer", {}, ...channels))));
}

async function copy(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {  // no permission, or a page from disk: the old way
    const area = html("textarea", { "aria-hidden": "true" }, text);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
}

function addCopyButtons(): void {
  for (const code of document.querySelectorAll<HTMLElement>(".command code")) {
    const button = html("button", { type: "button", class: "copy" }, "Copy the command");
    button.addEventListener("click", async () => {
      await copy(code.textContent!);
      button.textContent = "Copied";
    });
    code.after(button);
  }
}

// A page that would grow too large goes without the pixels' numbers, and says so.
function sayLeftOut(section: HTMLElement): void {
  section.querySelector(".viewer")!.after(html("p", { class: "left-out" },
    "The viewer and the pixel probe of this light are left out, to keep the page small: a smaller picture (--size) or one light at a time (--light) brings them."));
}

async function startLights(): Promise<(LightPanel | null)[]> {
  const result = JSON.parse(document.getElementById("result")!.textContent!);
  const panels: (LightPanel | null)[] = [];
  for (const [i, json] of page.lights.entries()) {
    const section = document.getElementById(`light-${i}`)!;
    if (!json) sayLeftOut(section);
    panels.push(json && new LightPanel(await Light.load(json), i, section, result.lights[i].best_bias.constant_world ?? 0));
  }
  return panels;
}

// Pictures must be decoded before their pixels and sizes are read.
async function start(): Promise<void> {
  await Promise.all([...document.images].filter((image) => image.src).map((image) => image.decode()));
  addExposureFilter();
  addCopyButtons();
  const panels = await startLights();
  const restore = () => {
    const wanted = readHash(location.hash), panel = wanted && panels[wanted.light];
    if (!panel) return;
    panel.restore(wanted.state);
    document.querySelector(`#light-${wanted.light} .viewer`)!.scrollIntoView({ block: "start" });
  };
  restore();
  window.addEventListener("hashchange", restore);
  document.documentElement.dataset.ready = "true";
}
void start();
