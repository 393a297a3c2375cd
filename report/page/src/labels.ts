// The label table: a label's name is a button that shows its pixels alone, in the picture and in the viewer.
import { page } from "./data";
import { dataUrl, isolatedLabel } from "./pictures";

export class LabelTable {
  private readonly image: HTMLImageElement;
  private readonly original: string;
  private readonly buttons = new Map<string, HTMLButtonElement>();

  constructor(
    section: Element,
    index: number,
    private readonly labels: Int8Array,
    chosen: (label: string | null) => void,
  ) {
    this.image = document.getElementById(`picture-labels-${index}`) as HTMLImageElement; // in the light's section, or on the first screen
    this.original = this.image.src;
    for (const row of section.querySelectorAll<HTMLElement>(".labels tr[data-colour]")) {
      const heading = row.querySelector("th")!,
        name = heading.firstChild!,
        button = document.createElement("button");
      button.type = "button";
      button.textContent = name.textContent;
      button.title = "Show only this label in the picture";
      heading.replaceChild(button, name);
      this.buttons.set(row.dataset.label!, button);
      button.addEventListener("click", () => chosen(button.getAttribute("aria-pressed") === "true" ? null : row.dataset.label!));
    }
    this.show(null);
  }

  show(label: string | null): void {
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(name === label));
    const value = label !== null && this.buttons.has(label) ? page.labels.find((words) => words.name === label)?.value : undefined;
    this.image.src = value === undefined ? this.original : dataUrl(isolatedLabel(this.labels, value));
  }
}
