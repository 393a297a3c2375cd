// A lecture to project: one slide a screen, revealed step by step, and a second window with the speaker's notes and a clock. A slide
// is laid out 768 units high, and 1024 wide or as wide as the window's shape allows; what fits there fits every
// screen and the printed page. The URL's hash is the slide, "#slide-3".
import { html } from "../svg";
import { NotesWindow } from "./notes_window";
import { pause } from "./pause";
import { say } from "./say";

const height = 768,
  least = 1024,
  most = 1366; // of a slide, CSS pixels
const largest = 38,
  beside = 27,
  smallest = 18; // of its letters, CSS pixels; beside a figure

/** What belongs together stays on one line: an option and its value, both sides of an operator, a number and its unit. */
function keepTogether(element: HTMLElement): void {
  for (const code of element.querySelectorAll(":not(pre) > code"))
    code.innerHTML = code.innerHTML.replace(/--[\w-]+( [^\s-][^\s]*)?/g, '<span class="option">$&</span>');
  const texts = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
  for (let text = texts.nextNode(); text; text = texts.nextNode())
    if (!text.parentElement!.closest("code, .live-figure"))
      text.textContent = text.textContent!.replace(/ (?=[=−+·≤≥<>≈×%])/g, "\u00a0").replace(/(?<=\u00a0[=−+·≤≥<>≈×]) /g, "\u00a0");
}

/** Whether a slide shows all that is in it. */
function fits(element: HTMLElement): boolean {
  const whole = (e: Element) => e.scrollHeight <= e.clientHeight + 1 && e.scrollWidth <= e.clientWidth + 1;
  const inside = (e: Element) => e.getBoundingClientRect().bottom <= e.parentElement!.getBoundingClientRect().bottom + 1;
  return (
    [element, ...element.querySelectorAll("pre, .scroll")].every(whole) && [...element.querySelectorAll(".live-figure > *")].every(inside)
  );
}

export interface Slide {
  element: HTMLElement;
  heading: string;
  steps: HTMLElement[];
  notes: HTMLElement;
  minutes: number;
  beyond: boolean; // may be left out
}

/** What is asked stands there at once, with the figure that it is asked of; the rest is revealed. */
function slideOf(element: HTMLElement, at: number): Slide {
  element.id = `slide-${at + 1}`;
  const steps = [...element.querySelectorAll<HTMLElement>(".step")],
    heading = element.querySelector<HTMLElement>("h1, h2")!,
    notes = element.querySelector<HTMLElement>(".notes")!;
  keepTogether(element);
  heading.setAttribute("role", "heading");
  heading.setAttribute("aria-level", "1"); // of what is shown it is the first
  if (steps[0]?.matches(".figure, .question")) steps.shift();
  if (element.querySelector(".step.question")) element.classList.add("asks");
  const beyond = notes.dataset.beyond !== undefined;
  if (beyond) element.append(html("p", { class: "beyond" }, say("may be left out")));
  return { element, heading: heading.textContent!, steps, notes, minutes: Number(notes.dataset.minutes), beyond };
}

export class Lecture {
  readonly slides: Slide[];
  private readonly stage: HTMLElement;
  private readonly count = html("output", {});
  private readonly black = html("div", { class: "black", hidden: "" });
  private readonly notes: NotesWindow;
  private readonly fitted = new Set<Slide>();
  private at = 0;
  private shown = 0; // steps

  constructor(article: HTMLElement) {
    this.stage = article;
    this.slides = [...article.querySelectorAll<HTMLElement>(".part")].map(slideOf);
    this.notes = new NotesWindow((key) => this.act(key));
    const button = (name: string, key: string) => {
      const made = html("button", { type: "button" }, name);
      made.addEventListener("click", () => this.act(key));
      return made;
    };
    article.append(
      html(
        "div",
        { class: "lecture-bar", role: "group", "aria-label": say("Slides") },
        button(say("Back"), "ArrowLeft"),
        this.count,
        button(say("Next"), "ArrowRight"),
        button(say("Black (B)"), "b"),
        button(say("Notes (N)"), "n"),
      ),
      this.black,
    );
    document.documentElement.dataset.view = "lecture";
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("hashchange", () => this.restore());
    window.addEventListener("resize", () => this.scale());
    window.addEventListener("beforeprint", () => this.fit(this.slides));
    this.restore();
  }

  /** A figure has come into the slide that the element is on. */
  refit(host: Element): void {
    const slide = this.slides.find(({ element }) => element.contains(host));
    if (!slide) return;
    this.fitted.delete(slide);
    if (slide === this.slides[this.at]) this.fit([slide]);
  }

  /** The slides that were not shown yet, one by one: keys are taken between them. */
  async fitAll(): Promise<void> {
    for (const slide of this.slides) {
      await pause();
      this.fit([slide]);
    }
  }

  /** The largest letters with which each slide fits at its narrowest. To measure takes a while, so it is done once. */
  private fit(slides: Slide[]): void {
    const left = slides.filter((slide) => !this.fitted.has(slide));
    if (left.length === 0) return;
    Object.assign(this.stage.style, { width: `${least}px`, transform: "none" });
    for (const slide of left) {
      const { element } = slide;
      let size = element.querySelector(".figure") ? beside : largest;
      do element.style.fontSize = `${size}px`;
      while (!fits(element) && --size >= smallest);
      this.fitted.add(slide);
    }
    this.scale();
  }

  private scale(): void {
    const width = Math.min(Math.max((height * innerWidth) / innerHeight, least), most),
      by = Math.min(innerWidth / width, innerHeight / height);
    Object.assign(this.stage.style, {
      width: `${width}px`,
      transform: `translate(${(innerWidth - by * width) / 2}px, ${(innerHeight - by * height) / 2}px) scale(${by})`,
    });
  }

  private restore(): void {
    const match = /^#slide-(\d+)$/.exec(location.hash);
    this.show(match ? Math.min(Math.max(Number(match[1]), 1), this.slides.length) - 1 : 0, 0);
  }

  private show(at: number, shown: number): void {
    [this.at, this.shown] = [at, shown];
    const slide = this.slides[at]!;
    this.fit([slide]);
    this.slides.forEach(({ element }, i) => element.classList.toggle("on-slide", i === at));
    slide.steps.forEach((step, i) => step.classList.toggle("to-come", i >= shown));
    this.count.textContent = say`${at + 1} of ${this.slides.length}`;
    history.replaceState(null, "", `#slide-${at + 1}`);
    this.notes.show(this.slides, at, slide.steps.length - shown);
  }

  private step(by: 1 | -1): void {
    const slide = this.slides[this.at]!,
      shown = this.shown + by;
    if (shown >= 0 && shown <= slide.steps.length) return this.show(this.at, shown);
    const next = this.at + by;
    if (next >= 0 && next < this.slides.length) this.show(next, by > 0 ? 0 : this.slides[next]!.steps.length);
  }

  /** Whether the key means something. */
  private act(key: string): boolean {
    if (["ArrowRight", "PageDown", " ", "Enter"].includes(key)) this.step(1);
    else if (["ArrowLeft", "PageUp", "Backspace"].includes(key)) this.step(-1);
    else if (key === "Home") this.show(0, 0);
    else if (key === "End") this.show(this.slides.length - 1, 0);
    else if (key === "b" || key === "B" || key === ".") this.black.hidden = !this.black.hidden;
    else if (key === "n" || key === "N") this.notes.open(this.slides, this.at, this.slides[this.at]!.steps.length - this.shown);
    else return false;
    return true;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    // A clicker's keys are the lecture's wherever the focus is; others belong to the slider, field or button that has it.
    const taken = (event.target as Element).closest?.("input, select, button, [data-arrows]");
    if ((!taken || event.key.startsWith("Page")) && this.act(event.key)) event.preventDefault();
  }
}
