// The two passes, one texel and one pixel after the other: the light's view becomes depths, then each pixel of the camera's
// view asks them whether something stands before it.
import { Light, page, type Pixel } from "../data";
import { examplePixel } from "../example_pixel";
import { exposed } from "../linear";
import { html } from "../svg";
import { texelDrawing } from "../texel_drawing";
import { story } from "../words";
import type { FigureJson } from "./figures";
import { whenPrinted } from "./printed";
import { PicturePointer } from "./picture_pointer";
import { say } from "./say";

const steps = 200; // of the slider, half of them for each pass

/** The map as the light sees it, near is bright; the first `rows` rows from the top. */
function mapPicture(light: Light, rows: number): ImageData {
  const { size } = light.json.view,
    image = new ImageData(size, size),
    depths: number[] = [];
  for (let row = 0; row < size; ++row)
    for (let column = 0; column < size; ++column) depths.push(light.map.depth(0, column, size - 1 - row));
  const seen = depths.filter(isFinite),
    low = Math.min(...seen),
    high = Math.max(...seen);
  depths.forEach((depth, i) => {
    const known = Math.floor(i / size) < rows,
      grey = isFinite(depth) ? 235 - 175 * ((depth - low) / (high - low || 1)) : 24;
    image.data.set(known ? [grey, grey, grey, 255] : [0, 0, 0, 0], 4 * i);
  });
  return image;
}

/** The rasterizer's picture of the pixels that have asked; the others pale. */
function cameraPicture(drawn: ImageData, done: number): ImageData {
  const image = new ImageData(new Uint8ClampedArray(drawn.data), page.width, page.height);
  for (let i = 4 * done; i < image.data.length; ++i) if (i % 4 !== 3) image.data[i] = 170 + 0.25 * drawn.data[i]!;
  return image;
}

/** In shadow, and rightly so: nearest to the picture's middle; where there is none, what there is to see. */
function shadowedPixel(light: Light): Pixel {
  let best = -1,
    least = Infinity;
  light.label.forEach((label, i) => {
    const away = Math.hypot((i % page.width) - page.width / 2, Math.floor(i / page.width) - page.height / 2);
    if (label === 0 && light.truth[i] === 0 && light.drawn[i] === 0 && away < least) [best, least] = [i, away];
  });
  return best < 0 ? examplePixel(light) : light.pixel(best % page.width, Math.floor(best / page.width));
}

export async function twoPassesFigure({ settings, data }: FigureJson, id: string): Promise<HTMLElement> {
  const { comparison } = data as { comparison: string },
    light = await Light.load(0, comparison),
    { size } = light.json.view;
  const drawn = exposed(light.pixels, "raster", 0);
  const range = html("input", {
    type: "range",
    min: "0",
    max: String(steps),
    step: "1",
    value: String(steps * Number(settings.passes ?? 1)),
  });
  const said = html("p", { class: "bias-counts", role: "status" }),
    words = html("p", { class: "story" }),
    drawing = html("div", { class: "live-drawing" });
  let shown: Pixel = shadowedPixel(light),
    frame = 0;
  const camera = new PicturePointer(page, say("The camera's view; choose a pixel"), (x, y) => {
    shown = light.pixel(x, y);
    later();
  });
  const map = html("canvas", { role: "img", width: String(size), height: String(size) }),
    texel = html("div", { class: "marker" });
  const show = () => {
    const at = Number(range.value),
      first = Math.min(at / (steps / 2), 1),
      second = Math.max(at / (steps / 2) - 1, 0);
    const rows = Math.round(first * size),
      done = Math.round(second * page.width * page.height),
      over = at === steps;
    map.getContext("2d")!.putImageData(mapPicture(light, rows), 0, 0);
    map.setAttribute("aria-label", say`The depth map as the light sees it, near is bright: ${rows} of ${size} rows`);
    camera.put(cameraPicture(drawn, done));
    camera.mark(shown.x, shown.y);
    const asks = over && shown.seen;
    texel.hidden = !asks;
    Object.assign(texel.style, {
      left: `${(100 * Math.floor(shown.at.u)) / size}%`,
      top: `${100 - (100 * (Math.floor(shown.at.v) + 1)) / size}%`,
      width: `${100 / size}%`,
      height: `${100 / size}%`,
    });
    Object.assign(said.dataset, { rows: String(rows), pixels: String(done) });
    said.textContent =
      second === 0
        ? say`Pass 1, from the light: each texel keeps the depth of what is nearest. ${rows} of ${size} rows.`
        : over
          ? say("Pass 2 is done: choose a pixel, by finger, mouse or arrow keys, to see the texel that it asked.")
          : say`Pass 2, from the camera: each pixel asks its texel whether something stood before it. ${Math.round(
              100 * second,
            )} % of the pixels.`;
    words.textContent = asks ? story(light, shown, light.json.bias.constant) : "";
    drawing.replaceChildren(...(asks ? [texelDrawing(light, shown, light.json.bias.constant, `${id}-texel`)] : []));
  };
  const later = () => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      show();
    });
  };
  const to = (name: string, step: number) => {
    const button = html("button", { type: "button" }, name);
    button.addEventListener("click", () => {
      range.value = String(step);
      later();
    });
    return button;
  };
  range.addEventListener("input", later);
  show();
  let before = range.value;
  const put = (value: string) => {
    range.value = value;
    show();
  };
  whenPrinted(
    () => {
      before = range.value;
      put(String(steps));
    },
    () => put(before),
  );
  return html(
    "div",
    { id },
    html(
      "div",
      { class: "bias-bar" },
      html("label", {}, say("Both passes "), range),
      to(say("pass 1"), steps / 4),
      to(say("pass 2"), (3 * steps) / 4),
      to(say("done"), steps),
    ),
    said,
    html("div", { class: "live-pair three" }, html("div", { class: "live-picture texels" }, map, texel), camera.frame, drawing),
    words,
  );
}
