// The page of a comparison: each light's section comes to life when its data is there. Data beside the page is loaded
// when the reader comes near the light that it belongs to.
import { Light, page } from "./data";
import { LightPanel } from "./light_panel";
import { showSections } from "./frame";
import { isBeside } from "./parts";
import { result } from "./report_document";
import { reportSections } from "./report_sections";
import { readLight } from "./state";
import { html } from "./svg";
import { LightTabs } from "./tabs";

const panels: (Promise<LightPanel | null> | undefined)[] = [];

async function load(index: number): Promise<LightPanel | null> {
  const section = document.getElementById(`light-${index}`)!;
  try {
    return new LightPanel(await Light.load(index), index, section, result.lights[index]!.best_bias.constant_world ?? 0);
  } catch (error) {
    section
      .querySelector(".viewer")!
      .after(html("p", { class: "left-out" }, `The viewer and the pixel probe of this light are missing: ${(error as Error).message}.`));
    return null;
  }
}

const panel = (index: number): Promise<LightPanel | null> => (panels[index] ??= load(index));

function loadWhenNear(index: number): void {
  const near = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      near.disconnect();
      void panel(index);
    },
    { rootMargin: "100%" },
  );
  near.observe(document.getElementById(`light-${index}`)!);
}

let tabs: LightTabs | undefined;

async function restore(): Promise<void> {
  const section = /^#light-(\d+)/.exec(location.hash);
  if (section && tabs && Number(section[1]) < page.lights) {
    tabs.show(Number(section[1]));
    if (!location.hash.includes("?")) document.getElementById(`light-${Number(section[1])}`)!.scrollIntoView();
  }
  const wanted = readLight(location.hash);
  if (!wanted || wanted.light >= page.lights) return;
  (await panel(wanted.light))?.restore(wanted.state);
  document.querySelector(`#light-${wanted.light} .viewer`)!.scrollIntoView({ block: "start" });
}

declare global {
  var gnomon: { light: (index: number) => Promise<Light> } | undefined; // eslint-disable-line no-var
}

export async function startComparison(): Promise<void> {
  showSections(reportSections());
  for (const copy of document.querySelectorAll<HTMLImageElement>("img[data-copy]"))
    copy.src = (document.getElementById(copy.dataset.copy!) as HTMLImageElement | null)?.src ?? "";
  // For the browser's console, and for tests: a light's numbers, unpacked.
  globalThis.gnomon = { light: Light.load };
  const sections = Array.from({ length: page.lights }, (_, i) => document.getElementById(`light-${i}`)!);
  if (page.lights > 1) tabs = new LightTabs(sections, (index) => void panel(index).then((of) => of?.save()));
  for (let i = 0; i < page.lights; ++i)
    if (isBeside && i > 0) loadWhenNear(i);
    else await panel(i);
  await restore();
  window.addEventListener("hashchange", () => void restore());
}
