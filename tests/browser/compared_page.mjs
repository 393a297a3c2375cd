// What the tests of the report's live parts share: comparisons of one scene at two biases, and what their pages show.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { pixelsOf } from "./open_page.mjs";

export const [program, folder] = process.argv.slice(2);
export const width = 240,
  height = 136,
  biases = ["0.02", "0.3"];
export const folderOf = (bias) => join(folder, `bias-${bias}`);
mkdirSync(folder, { recursive: true });
for (const bias of biases)
  execFileSync(
    program,
    [
      "compare",
      "sphere-plane",
      "--size",
      `${width}x${height}`,
      "--map-size",
      "64",
      "--runs",
      "1",
      "--bias",
      bias,
      "--quiet",
      "-o",
      folderOf(bias),
      "--aov",
      join(folder, `bias-${bias}.exr`),
    ],
    { stdio: "inherit" },
  );
export const resultOf = (bias) => JSON.parse(readFileSync(join(folderOf(bias), "result.json"), "utf8")).lights[0];

export const number = (text) => Number(text.replaceAll("\u2212", "-").replaceAll("∞", "Infinity"));
export const title = async (page) => (await page.locator(".pixel-title").textContent()).trim();

export async function shown(page) {
  const text = (selector) => page.locator(selector).textContent();
  const ladder = await page.locator(".pixel-ladder tbody tr td:nth-child(2)").allTextContents();
  return {
    story: await text(".story"),
    ladder: ladder.map(number),
    gap: number((await text("[data-fact=gap]")).split(" ")[0]),
    texel: (await text("[data-fact=texel]")).split(" u")[0].split(", ").map(Number),
    primitive: Number(await text("[data-fact=primitive]")),
  };
}

export const canvasOf = (page, pane) => pixelsOf(page.locator(".pane canvas").nth(pane));
export const redrawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

export async function countsAt(page, bias) {
  await page.locator(".bias-bar input[type=number]").fill(String(bias));
  await page.keyboard.press("Enter");
  await page.waitForFunction(
    (b) =>
      document.querySelector(".bias-counts").textContent.startsWith("At a bias of") &&
      Number(document.querySelector(".bias-bar input[type=number]").value) === b,
    bias,
  );
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator(".bias-live").evaluate((live) => {
    const { falseShadow, missedShadow } = live.querySelector(".bias-counts").dataset,
      canvas = live.querySelector("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let orange = 0,
      blue = 0;
    for (let i = 0; i < data.length; i += 4) {
      orange += data[i] === 213 && data[i + 1] === 94 && data[i + 2] === 0;
      blue += data[i] === 86 && data[i + 1] === 180 && data[i + 2] === 233;
    }
    return { false_shadow: Number(falseShadow), missed_shadow: Number(missedShadow), orange, blue };
  });
}
