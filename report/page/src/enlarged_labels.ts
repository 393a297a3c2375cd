// Errors on so few pixels that nobody sees them in a small picture: each is marked larger, over the labelled picture of the
// first screen.
import { page, wordsOf, type Light } from "./data";
import { html } from "./svg";

const fewest = 0.01; // of the picture; more can be seen
const markOfPicture = 130; // a mark's side is this part of the picture's width

export function enlargeLabels(light: Light, picture: HTMLImageElement): void {
  const { width, height } = page,
    wrong = [...light.label.keys()].filter((i) => light.label[i]! > 0);
  if (wrong.length === 0 || wrong.length >= fewest * light.label.length) return;
  const side = Math.max(3, Math.round(width / markOfPicture));
  const canvas = Object.assign(html("canvas", { class: "enlarged-labels", "aria-hidden": "true" }), { width, height });
  const context = canvas.getContext("2d")!;
  for (const i of wrong) {
    context.fillStyle = wordsOf(light.label[i]!).colour;
    context.fillRect((i % width) - (side >> 1), Math.floor(i / width) - (side >> 1), side, side);
  }
  const frame = html("div", { class: "map-frame" });
  picture.replaceWith(frame);
  frame.append(picture, canvas);
  frame.parentElement!.querySelector("figcaption")!.append(" Marks are enlarged: the errors are single pixels.");
}
