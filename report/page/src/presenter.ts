// Picture, pixel drawing, cross-section and bias on one screen, as a lecture wants them: the same elements as on the page,
// moved into a dialog that fills the window and back again, so that they stay linked as they are.
import { html } from "./svg";

export interface Pieces {
  controls: HTMLElement[];  // above all
  picture: HTMLElement;
  drawing: HTMLElement;
  words: HTMLElement;
  section: HTMLElement[];
}

export class Presenter {
  private readonly dialog: HTMLDialogElement;
  private readonly areas: [HTMLElement, HTMLElement[]][];
  private places: [HTMLElement, Comment][] = [];

  constructor(host: Element, name: string, pieces: Pieces, step: (x: number, y: number) => void) {
    const area = (kind: string, elements: HTMLElement[]): [HTMLElement, HTMLElement[]] => [html("div", { class: `presenter-${kind}` }), elements];
    this.areas = [area("controls", pieces.controls), area("picture", [pieces.picture]), area("drawing", [pieces.drawing]),
      area("words", [pieces.words]), area("section", pieces.section)];
    const close = html("button", { type: "button", class: "presenter-close" }, "Close");
    this.dialog = html("dialog", { class: "presenter", "aria-label": `Presentation: ${name}` }, close, ...this.areas.map(([element]) => element));
    const open = html("button", { type: "button", class: "present" }, "Present");
    open.title = "Picture, pixel drawing, cross-section and bias on one screen";
    open.addEventListener("click", () => this.open());
    close.addEventListener("click", () => this.dialog.close());
    this.dialog.addEventListener("close", () => this.putBack());
    this.dialog.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!way || !event.shiftKey || (event.target as Element).closest(".stage, input")) return;
      event.preventDefault();
      step(way[0]!, way[1]!);
    });
    host.append(open);
    host.after(this.dialog);
  }

  private open(): void {
    for (const [area, elements] of this.areas)
      for (const element of elements) {
        const place = document.createComment("");
        element.replaceWith(place);
        this.places.push([element, place]);
        area.append(element);
      }
    this.dialog.showModal();
  }

  private putBack(): void {
    for (const [element, place] of this.places) place.replaceWith(element);
    this.places = [];
  }
}
