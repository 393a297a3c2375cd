// The picture alone, as large as the window, or picture, pixel drawing, cross-section and bias on one screen, as a lecture
// wants them. They are the same elements as on the page, moved into a dialog that fills the window and back again, so that they stay
// linked as they are.
import { html } from "./svg";

export interface Pieces {
  controls: HTMLElement[]; // above all
  picture: HTMLElement;
  drawing: HTMLElement;
  words: HTMLElement;
  section: HTMLElement[];
}

/** Pictures to lay over the live one, by name; the first name is the live one's, whose picture is null. */
export type Overlays = [name: string, picture: HTMLImageElement | null][];

export class Presenter {
  private readonly dialog: HTMLDialogElement;
  private readonly areas: [HTMLElement, HTMLElement[]][];
  private places: [HTMLElement, Comment][] = [];
  private readonly overlay = html("img", { class: "presenter-overlay", alt: "" });
  private readonly choices: HTMLButtonElement[];
  private readonly details = html(
    "button",
    { type: "button", "aria-pressed": "false", title: "Pixel drawing, cross-section and words (D)" },
    "Details",
  );

  constructor(
    host: Element,
    name: string,
    private readonly pieces: Pieces,
    private readonly overlays: Overlays,
    private readonly step: (x: number, y: number) => void,
  ) {
    const area = (kind: string, elements: HTMLElement[]): [HTMLElement, HTMLElement[]] => [
      html("div", { class: `presenter-${kind}` }),
      elements,
    ];
    this.areas = [
      area("controls", pieces.controls),
      area("picture", [pieces.picture]),
      area("drawing", [pieces.drawing]),
      area("words", [pieces.words]),
      area("section", pieces.section),
    ];
    const close = html("button", { type: "button", class: "presenter-close" }, "Close");
    this.choices = overlays.map(([title], i) => {
      const button = html("button", { type: "button", title: `Key ${i + 1}` }, title);
      button.addEventListener("click", () => this.choose(i));
      return button;
    });
    const bar = html(
      "div",
      { class: "presenter-bar modes", role: "group", "aria-label": "What is shown" },
      ...this.choices,
      this.details,
      close,
    );
    this.dialog = html(
      "dialog",
      { class: "presenter", "aria-label": `Presentation: ${name}` },
      bar,
      ...this.areas.map(([element]) => element),
    );
    const open = html("button", { type: "button", class: "present" }, "Present");
    open.title = "The picture as large as the window; with its details picture, pixel drawing, cross-section and bias on one screen";
    open.addEventListener("click", () => this.open());
    close.addEventListener("click", () => this.dialog.close());
    this.details.addEventListener("click", () => this.showDetails(!this.dialog.classList.contains("detailed")));
    this.dialog.addEventListener("close", () => this.putBack());
    this.dialog.addEventListener("keydown", (event) => this.key(event));
    this.choose(0);
    host.append(open);
    host.after(this.dialog);
  }

  private key(event: KeyboardEvent): void {
    if ((event.target as Element).closest(".stage, input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const choice = Number(event.key) - 1;
    if (way && event.shiftKey) this.step(way[0]!, way[1]!);
    else if (this.choices[choice]) this.choose(choice);
    else if (event.key === "d" || event.key === "D") this.showDetails(!this.dialog.classList.contains("detailed"));
    else return;
    event.preventDefault();
  }

  private choose(index: number): void {
    const [name, picture] = this.overlays[index]!;
    this.overlay.hidden = picture === null;
    if (picture) this.overlay.src = picture.src;
    this.overlay.alt = picture ? name : "";
    this.choices.forEach((button, i) => button.setAttribute("aria-pressed", String(i === index)));
  }

  private showDetails(shown: boolean): void {
    this.dialog.classList.toggle("detailed", shown);
    this.details.setAttribute("aria-pressed", String(shown));
  }

  private open(): void {
    for (const [area, elements] of this.areas)
      for (const element of elements) {
        const place = document.createComment("");
        element.replaceWith(place);
        this.places.push([element, place]);
        area.append(element);
      }
    this.pieces.picture.append(this.overlay);
    this.dialog.showModal();
  }

  private putBack(): void {
    this.overlay.remove();
    for (const [element, place] of this.places) place.replaceWith(element);
    this.places = [];
  }
}
