// What a lesson's page gains when scripts may run: live figures in the place of pictures, commands to copy, and a slide view
// for a projector; and a lecture's: slides and notes. Without it the page is text and pictures.
import "../report.css";
import "./lessons.css";
import "./lecture.css";
import { copyButton } from "../clipboard";
import { startFigures } from "./figures";
import { Lecture } from "./lecture";
import { SlideView } from "./slides";
import { say } from "./say";
import { addWays } from "./ways";

async function start(): Promise<void> {
  for (const code of document.querySelectorAll<HTMLElement>("code.language-sh")) code.parentElement!.after(copyButton(code, say("Copy")));
  // Slides before their figures: a deck is shown, and takes keys, from its first moment.
  const article = document.querySelector<HTMLElement>(".lecture"),
    lecture = article && new Lecture(article);
  await startFigures((host) => lecture?.refit(host));
  await lecture?.fitAll();
  const lesson = document.querySelector<HTMLElement>(".lesson-text");
  if (lesson?.querySelector(".part h2")) {
    new SlideView(lesson);
    addWays(lesson);
  }
  document.documentElement.dataset.ready = "true";
}
void start();
