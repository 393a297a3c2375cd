// The slide view: the lesson's own elements, one idea a screen, as large as the screen allows. A part of the lesson makes one
// slide; a picture, a live figure and a question are slides of their own, and so is text beyond what can be read at a glance.
// The URL's hash is the slide, "#slide-3", so that a lecture can be linked to and resumed.
import { html } from "../svg";
import { say } from "./say";

interface Slide {
  part: HTMLElement;
  elements: Element[]; // besides the part's heading
}

const mostText = 620; // characters
const largest = 34,
  smallest = 15; // CSS pixels, of the root's font

const isAlone = (element: Element): boolean => element.matches(".live, details, p:has(> img), .scroll");
/** So many characters before a table or a figure are its heading, and share its slide. */
const leadOf = (element: Element): number => (element.matches(".scroll") ? 260 : element.matches(".live, p:has(> img)") ? 60 : 0);
/** Buttons to copy belong to the commands before them and are not for a projector. */
const isShown = (element: Element): boolean => !element.matches("h1, h2, .copy");
/** "1. No bias": an experiment begins. */
const begins = (element: Element): boolean => /^\d+\.\s/.test(element.firstElementChild?.matches("strong") ? element.textContent! : "");
// A line of code takes the room of a line, however short it is.
const weight = (element: Element): number =>
  element.matches("pre") ? 60 * element.textContent!.trim().split("\n").length : element.textContent!.length;

function slidesOf(part: HTMLElement): Slide[] {
  const slides: Slide[] = [];
  let group: Element[] = [],
    size = 0;
  const close = () => {
    if (group.length > 0) slides.push({ part, elements: group });
    [group, size] = [[], 0];
  };
  for (const element of [...part.children].filter(isShown)) {
    const more = weight(element);
    const joins = size > 0 && size < leadOf(element);
    if (!joins && (isAlone(element) || begins(element) || size + more > mostText)) close();
    group.push(element);
    size += more;
    if (isAlone(element)) close();
  }
  close();
  return slides.length > 0 ? slides : [{ part, elements: [] }];
}

/** A slide's heading is the first of what is there. */
function headLevel(part: HTMLElement, level: string | null): void {
  const heading = part.querySelector("h1, h2");
  if (level) heading?.setAttribute("aria-level", level);
  else heading?.removeAttribute("aria-level");
  if (level) heading?.setAttribute("role", "heading");
  else heading?.removeAttribute("role");
}

export class SlideView {
  private readonly slides: Slide[];
  private readonly count = html("output", {});
  private readonly bar: HTMLElement;
  private at = -1; // -1: the page is read as a page

  constructor(lesson: HTMLElement) {
    this.slides = [...lesson.querySelectorAll<HTMLElement>(".part")].flatMap(slidesOf);
    const open = this.button(say("Slides"), () => this.go(0));
    open.classList.add("open-slides");
    document.querySelector("header.bar-top")!.append(open);
    this.bar = html(
      "div",
      { class: "slide-bar", role: "group", "aria-label": say("Slides") },
      this.button(say("Previous"), () => this.step(-1)),
      this.count,
      this.button(say("Next"), () => this.step(1)),
      this.button(say("Close"), () => this.go(-1)),
    );
    lesson.after(this.bar);
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("hashchange", () => this.restore());
    window.addEventListener("resize", () => this.fit());
    lesson.addEventListener("toggle", () => this.fit(), true);
    this.restore();
  }

  private button(name: string, act: () => void): HTMLButtonElement {
    const button = html("button", { type: "button" }, name);
    button.addEventListener("click", act);
    return button;
  }

  private restore(): void {
    const match = /^#slide-(\d+)$/.exec(location.hash);
    this.show(match ? Math.min(Math.max(Number(match[1]), 1), this.slides.length) - 1 : -1);
  }

  private go(to: number): void {
    history.replaceState(null, "", to < 0 ? location.pathname : `#slide-${to + 1}`);
    this.show(to);
  }

  private step(by: number): void {
    this.go(Math.min(Math.max(this.at + by, 0), this.slides.length - 1));
  }

  private show(at: number): void {
    const was = this.slides[this.at];
    this.at = at;
    if (was) headLevel(was.part, null);
    document.documentElement.dataset.view = at < 0 ? "page" : "slides";
    for (const element of document.querySelectorAll(".on-slide")) element.classList.remove("on-slide");
    const slide = this.slides[at];
    if (slide) {
      for (const element of [slide.part, ...slide.elements]) element.classList.add("on-slide");
      headLevel(slide.part, "1");
      this.count.textContent = say`${at + 1} of ${this.slides.length}`;
      window.scrollTo(0, 0);
    }
    this.fit();
    if (!slide && was) was.part.scrollIntoView();
  }

  /** The largest font with which the slide fits the window. */
  private fit(): void {
    const root = document.documentElement,
      part = this.slides[this.at]?.part;
    root.style.fontSize = "";
    if (!part) return;
    for (let size = largest; size >= smallest; --size) {
      root.style.fontSize = `${size}px`;
      if (part.scrollHeight <= part.clientHeight && part.scrollWidth <= part.clientWidth) return;
    }
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey || this.at < 0) return;
    const far = { PageUp: -1, PageDown: 1 }[event.key],
      near = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    // A slider and a drawing that is dragged by keys keep the arrows.
    const taken = (event.target as Element).closest?.("input, select, [data-arrows]");
    const by = far ?? (taken ? undefined : near);
    const to = taken ? undefined : { Home: 0, End: this.slides.length - 1 }[event.key];
    if (event.key === "Escape") this.go(-1);
    else if (by !== undefined) this.step(by);
    else if (to !== undefined) this.go(to);
    else return;
    event.preventDefault();
  }
}
