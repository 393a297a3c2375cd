// How quickly the lab's page answers (docs/lab.md): changes of the bias, each from the key to the first labels and to all of
// them, in a browser on this machine. Usage: node served_lab_answers.mjs PROGRAM WORK_FOLDER [SCENE [WxH]]
import { browser, openAt } from "../browser/open_page.mjs";
import { serve } from "../serve/served_lab.mjs";

const [scene = "fence", size = "640x360"] = process.argv.slice(4);
const lab = await serve(scene, "--size", size),
  page = await openAt(lab.url, lab.url);
const isDone = () => document.body.dataset.busy === "false";
await page.waitForFunction(isDone, null, { timeout: 300000 });

/** Milliseconds to another verdict, and to the whole comparison. */
const change = (texels) =>
  page.evaluate(
    (value) =>
      new Promise((done) => {
        const begin = performance.now(),
          verdict = document.getElementById("lab-verdict"),
          before = verdict.textContent;
        const box = document.querySelector("[data-setting=bias] input[type=text]");
        let first = NaN;
        box.value = value;
        box.dispatchEvent(new Event("change"));
        const timer = setInterval(() => {
          if (isNaN(first) && verdict.textContent !== before) first = performance.now() - begin;
          if (document.body.dataset.busy !== "false") return;
          clearInterval(timer);
          done([first, performance.now() - begin]);
        }, 2);
      }),
    texels,
  );

const answers = [];
for (let i = 0; i < 9; ++i) answers.push(await change(String(0.1 + i)));
const told = (k) => {
  const sorted = answers
    .map((answer) => answer[k])
    .filter((ms) => !isNaN(ms))
    .sort((a, b) => a - b);
  return `${Math.round(sorted[Math.floor(sorted.length / 2)])} ms (${Math.round(sorted[0])} to ${Math.round(sorted.at(-1))})`;
};
console.log(`${scene} ${size}: first labels after ${told(0)}, all of them after ${told(1)}`);
await browser.close();
await lab.stop();
