// Several lights in tabs. Without scripts, and in print, their sections follow each other.
import { html } from "./svg";

export class LightTabs {
  private readonly buttons: HTMLButtonElement[];

  constructor(
    private readonly sections: HTMLElement[],
    private readonly chosen: (index: number) => void,
  ) {
    this.buttons = sections.map((section, i) => {
      const name = section.querySelector("h2")!.textContent!.replace(/^Light: /, "");
      const button = html("button", { type: "button", role: "tab", id: `tab-${i}`, "aria-controls": section.id }, name);
      button.addEventListener("click", () => this.choose(i));
      button.addEventListener("keydown", (event) => this.key(event, i));
      section.setAttribute("role", "tabpanel");
      section.setAttribute("aria-labelledby", button.id);
      return button;
    });
    sections[0]!.before(html("div", { class: "tabs", role: "tablist", "aria-label": "Lights" }, ...this.buttons));
    this.show(0);
  }

  show(index: number): void {
    this.sections.forEach((section, i) => section.classList.toggle("tab-away", i !== index));
    this.buttons.forEach((button, i) => {
      button.setAttribute("aria-selected", String(i === index));
      button.tabIndex = i === index ? 0 : -1;
    });
  }

  private choose(index: number): void {
    this.show(index);
    this.chosen(index);
  }

  private key(event: KeyboardEvent, at: number): void {
    const last = this.buttons.length - 1;
    const next = { ArrowRight: at === last ? 0 : at + 1, ArrowLeft: at === 0 ? last : at - 1, Home: 0, End: last }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    this.choose(next);
    this.buttons[next]!.focus();
  }
}
