// Puts a page together: the bar on top and its sections take the place of the plain page that readers without scripts see
// (../../plain_page.h). Its pictures move to where the sections want them.
import { addCopyButtons } from "./clipboard";
import { markup, type Markup } from "./template";

export interface Section {
  id: string;
  link: string; // in the bar on top
  html: Markup;
}

/** Where a picture of the plain page goes; `id` and `kind`, a class, may be empty. */
export const picture = (name: string, id = "", kind = ""): Markup =>
  markup`<img data-picture="${name}"${id ? markup` id="${id}"` : ""}${kind ? markup` class="${kind}"` : ""} alt="">`;

const pictures = new Map<string, HTMLImageElement>();

/** A picture of the plain page, for a place of its own; none where the page has not got it. */
export const pictureNamed = (name: string): HTMLImageElement | undefined => pictures.get(name);

export const main = document.getElementById("main")!;
for (const image of main.querySelectorAll<HTMLImageElement>(".plain img[data-picture]")) pictures.set(image.dataset.picture!, image);

const save = main.querySelector(".plain .save");
/** Where the links to the page's files go, if it has any. */
export const saveLinks = save && markup`<p class="save"></p>`;

export function showSections(sections: Section[]): void {
  document.querySelector("nav ul")!.innerHTML = sections
    .filter(({ link }) => link !== "")
    .map(({ id, link }) => markup`<li><a href="#${id}">${link}</a></li>`.text)
    .join("");
  main.innerHTML = sections.map(({ html }) => html.text).join("");
  for (const place of main.querySelectorAll<HTMLImageElement>("img[data-picture]")) {
    const image = pictures.get(place.dataset.picture!)!;
    if (place.id) image.id = place.id;
    if (place.className) image.className = place.className;
    image.removeAttribute("data-picture");
    place.replaceWith(image);
  }
  if (save) main.querySelector(".save")!.replaceWith(save);
  addCopyButtons();
}
