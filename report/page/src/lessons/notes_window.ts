// The speaker's window: what is said on the slide, what comes next, and whether the lecture is in time. It is a page of this one's
// own, so that it works from disk.
import { html } from "../svg";
import type { Slide } from "./lecture";
import { say } from "./say";

const clock = (seconds: number): string =>
  `${seconds < 0 ? "−" : ""}${Math.floor(Math.abs(seconds) / 60)}:${String(Math.floor(Math.abs(seconds) % 60)).padStart(2, "0")}`;

export class NotesWindow {
  private window: Window | null = null;
  private begun = 0; // ms: when it was opened
  private readonly time = html("output", { class: "notes-time" });
  private readonly body = html("main", { class: "notes-window" });
  private planned = 0; // minutes until this slide ends

  /** `act`: what the lecture does with a key that is pressed here. */
  constructor(private readonly act: (key: string) => boolean) {}

  open(slides: Slide[], at: number, left: number): void {
    if (this.window && !this.window.closed) return this.window.focus();
    this.window = window.open("", "gnomon-notes", "width=900,height=700");
    if (!this.window) return; // the browser lets no window open
    const { document: page } = this.window;
    page.documentElement.lang = "en";
    page.title = say`Notes: ${document.title}`;
    page.head.replaceChildren(...[...document.querySelectorAll("style")].map((style) => page.importNode(style, true)));
    page.body.replaceChildren(page.adoptNode(this.body));
    page.addEventListener("keydown", (event) => {
      if (this.act(event.key)) event.preventDefault();
    });
    this.begun = Date.now();
    this.window.setInterval(() => this.tick(), 1000);
    this.show(slides, at, left);
  }

  /** `left`: steps of the slide that are to come. */
  show(slides: Slide[], at: number, left: number): void {
    if (!this.window || this.window.closed) return;
    const { heading, notes, minutes, beyond } = slides[at]!,
      next = slides[at + 1];
    this.planned = slides.slice(0, at + 1).reduce((sum, slide) => sum + slide.minutes, 0);
    const text = html("div", { class: "notes-text" });
    text.append(...[...notes.children].map((child) => child.cloneNode(true)));
    this.body.replaceChildren(
      this.time,
      html(
        "p",
        {},
        say`Slide ${at + 1} of ${slides.length}, ${minutes} min${beyond ? say(", may be left out") : ""}. ${left === 0 ? say("All of it is shown.") : say`${left} more to show.`}`,
      ),
      html("h1", {}, heading),
      text,
      html("p", { class: "notes-next" }, next ? say`Next: ${next.heading}` : say("The last slide.")),
    );
    this.tick();
  }

  private tick(): void {
    const seconds = (Date.now() - this.begun) / 1000,
      ahead = 60 * this.planned - seconds;
    this.time.textContent = say`${clock(seconds)} gone; this slide ends at ${this.planned}:00, ${ahead < 0 ? say`${clock(-ahead)} ago` : say`in ${clock(ahead)}`}. Now ${new Date().toLocaleTimeString(
      [],
      { hour: "2-digit", minute: "2-digit" },
    )}.`;
  }
}
