// The ways on from a lesson, three buttons at its head: its first command's state in the lab, its exercise, and back to where the reader
// came from. A page without a lab beside it copies the lab's command instead.
import { copyButton } from "../clipboard";
import { addressOf, optionsOf } from "../lab/lab_state";
import { pageData } from "../parts";
import { html } from "../svg";
import { say } from "./say";

/** "gnomon compare acne-floor --bias 0": the lab has compare's options; of another command it has the scene. */
function labState(command: string): { scene: string; words: string[] } | null {
  const [program, name, scene, ...words] = command.trim().split(/\s+/);
  return program === "gnomon" && scene && !scene.startsWith("-") ? { scene, words: name === "compare" ? words : [] } : null;
}

function toLab(lesson: HTMLElement): HTMLElement | null {
  const first = lesson.querySelector("code.language-sh")?.textContent?.split("\n")[0] ?? "",
    state = labState(first),
    { lab } = pageData<{ lab?: string }>(),
    name = say("This state in the lab");
  if (!state) return null;
  if (lab) return html("a", { class: "way", href: lab + addressOf({ scene: state.scene, options: optionsOf(state.words) }) }, name);
  const command = ["gnomon view", state.scene, ...state.words].join(" "),
    button = copyButton(html("code", {}, command), name);
  button.title = say`Copies ${command}`;
  button.className = "way";
  return button;
}

/** What is to be written; where there is nothing, what is to be tried. */
function toExercise(lesson: HTMLElement): HTMLElement | null {
  const headings = [...lesson.querySelectorAll<HTMLElement>(".part > h2")],
    of = (name: string) => headings.find((heading) => heading.textContent === name),
    target = of(say("Exercise")) ?? of(say("Experiments"));
  if (!target) return null;
  target.id = "exercise";
  return html("a", { class: "way", href: "#exercise" }, say("This exercise"));
}

/** Where the reader came from; all lessons, where that is nowhere. */
function back(): HTMLElement {
  const link = html("a", { class: "way", href: "index.html" }, say("Back"));
  link.addEventListener("click", (event) => {
    if (history.length < 2) return;
    event.preventDefault();
    history.back();
  });
  return link;
}

export function addWays(lesson: HTMLElement): void {
  const ways = [toLab(lesson), toExercise(lesson), back()].filter((way) => way !== null);
  lesson.prepend(html("nav", { class: "ways", "aria-label": say("Ways on") }, ...ways));
}
