// The label table: a label's name is a button that shows its pixels alone, in the picture and in the viewer.
import { dataUrl, pixelsOf } from "./pictures";

// The label picture with every other label faded towards white.
function isolated(image: HTMLImageElement, colour: string): string {
  const pixels = pixelsOf(image), shown = new ImageData(new Uint8ClampedArray(pixels.data), pixels.width, pixels.height);
  const wanted = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  const { data } = shown;
  for (let i = 0; i < data.length; i += 4) {
    if (wanted.every((v, k) => data[i + k] === v)) continue;
    const grey = 0.3 * data[i]! + 0.6 * data[i + 1]! + 0.1 * data[i + 2]!;
    for (let k = 0; k < 3; ++k) data[i + k] = 200 + 0.2 * grey;
  }
  return dataUrl(shown);
}

export class LabelTable {
  private readonly image: HTMLImageElement;
  private readonly original: string;
  private readonly buttons = new Map<string, { button: HTMLButtonElement; colour: string }>();

  constructor(section: Element, chosen: (label: string | null) => void) {
    this.image = section.querySelector("[id^=picture-labels]")!;
    this.original = this.image.src;
    for (const row of section.querySelectorAll<HTMLElement>(".labels tr[data-colour]")) {
      const heading = row.querySelector("th")!, name = heading.firstChild!, button = document.createElement("button");
      button.type = "button";
      button.textContent = name.textContent;
      button.title = "Show only this label in the picture";
      heading.replaceChild(button, name);
      this.buttons.set(row.dataset.label!, { button, colour: row.dataset.colour! });
      button.addEventListener("click", () => chosen(button.getAttribute("aria-pressed") === "true" ? null : row.dataset.label!));
    }
    this.show(null);
  }

  show(label: string | null): void {
    for (const [name, { button }] of this.buttons) button.setAttribute("aria-pressed", String(name === label));
    const entry = label === null ? undefined : this.buttons.get(label);
    if (entry) pixelsOf(this.image);  // of the original, before it is replaced
    this.image.src = entry ? isolated(this.image, entry.colour) : this.original;
  }
}
