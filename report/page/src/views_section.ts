// A setting judged from several views: what it errs by from each, and where in the scene it fails, seen from above.
import { fixed } from "./log_chart";
import { general, grouped, percent, plainNumber } from "./number_text";
import { result, type Views } from "./report_document";
import { markup, scrollRegion, type Markup } from "./template";

type Places = NonNullable<Views["places"]>;
const longerSide = 640; // of the drawing

/** A fixed scale, so that two maps compare: 0.1 % is a quarter, 1 % half, 10 % three quarters, and all wrong whole. */
const strength = (error: number): number => Math.min(Math.max(1 + Math.log10(error) / 4, 0.08), 1);

/** The part of the world that is drawn: all squares that something shows, and the views that stand near them. */
function frameOf({ corner, side, cells }: Places, each: Views["each"]): { x: number; z: number; width: number; height: number } {
  const columns = cells.map(([column]) => column),
    rows = cells.map(([, row]) => row);
  let [left, right] = [corner[0] + side * Math.min(...columns), corner[0] + side * (Math.max(...columns) + 1)];
  let [top, bottom] = [corner[1] + side * Math.min(...rows), corner[1] + side * (Math.max(...rows) + 1)];
  const reach = 0.5 * Math.max(right - left, bottom - top),
    near = each.filter(({ eye: [x, , z] }) => x > left - reach && x < right + reach && z > top - reach && z < bottom + reach);
  [left, right] = [Math.min(left, ...near.map(({ eye }) => eye[0])) - side, Math.max(right, ...near.map(({ eye }) => eye[0])) + side];
  [top, bottom] = [Math.min(top, ...near.map(({ eye }) => eye[2])) - side, Math.max(bottom, ...near.map(({ eye }) => eye[2])) + side];
  return { x: left, z: top, width: right - left, height: bottom - top };
}

function placesMap(places: Places, { each, worst }: Views): Markup {
  const frame = frameOf(places, each),
    scale = longerSide / Math.max(frame.width, frame.height);
  const at = (x: number, z: number): [number, number] => [(x - frame.x) * scale, (z - frame.z) * scale],
    size = places.side * scale;
  const square = ([column, row, pixels, error]: Places["cells"][number]): Markup => {
    const [x, y] = at(places.corner[0] + column * places.side, places.corner[1] + row * places.side);
    return markup`<rect class="${
      error > 0 ? "place wrong" : "place"
    }" x="${fixed(x)}" y="${fixed(y)}" width="${fixed(size)}" height="${fixed(size)}"${
      error > 0 && markup` fill-opacity="${strength(error).toFixed(2)}"`
    }><title>${percent(error)} of ${grouped(pixels)} pixels</title></rect>`;
  };
  const worstSquare = (): Markup | null => {
    if (!places.worst) return null;
    const [x, y] = at(places.corner[0] + places.worst[0] * places.side, places.corner[1] + places.worst[1] * places.side);
    return markup`<rect class="worst-place" x="${fixed(x - 2)}" y="${fixed(y - 2)}" width="${fixed(size + 4)}" height="${fixed(size + 4)}"/>`;
  };
  const arrow = ({ view, eye, direction }: Views["each"][number]): Markup => {
    const [x, y] = at(eye[0], eye[2]),
      flat = Math.hypot(direction[0], direction[2]) || 1,
      length = 26 * Math.min(1, flat + 0.3);
    const [dx, dy] = [(direction[0] / flat) * length, (direction[2] / flat) * length];
    return markup`<g class="${
      view === worst ? "eye worst-eye" : "eye"
    }"><line x1="${fixed(x)}" y1="${fixed(y)}" x2="${fixed(x + dx)}" y2="${fixed(y + dy)}"/><circle
cx="${fixed(x)}" cy="${fixed(y)}" r="5"/><title>${view}</title></g>`;
  };
  return markup`<svg class="chart places" viewBox="0 0 ${fixed(frame.width * scale)} ${fixed(frame.height * scale)}" role="img" aria-label="Where it fails, seen from above">${places.cells.map(
    square,
  )}${worstSquare()}${each.map(arrow)}</svg>
`;
}

function placesFigure(places: Places, views: Views): Markup | null {
  if (places.cells.length === 0) return null;
  const { worst, worst_share: share, corner, side, pixels_beyond: beyond, mean_absolute_beyond: error } = places;
  const middle = (k: 0 | 1): string => general(corner[k] + ((worst?.[k] ?? 0) + 0.5) * side, 3);
  return markup`<h3>Where it fails</h3>
<figure>${placesMap(
    places,
    views,
  )}<figcaption>The scene from above, x to the right and z downwards; a square is ${general(side, 3)} world units wide. Grey: right in all
views; <b class="false-text">orange</b>: the stronger, the larger the mean error of the pixels that show it. ${
    worst
      ? `Framed: the square with most of the error (${percent(share!)} of it), around x ${middle(0)}, z ${middle(1)}.`
      : "Nothing is wrong anywhere."
  } Arrows: the views, the
worst one filled.${
    beyond > 0 && ` Not drawn: ${grouped(beyond)} pixels farther away, with a mean error of ${percent(error!)}.`
  }</figcaption></figure>
`;
}

export function viewsSection(views: Views): Markup {
  const several = result.lights.length > 1,
    isShare = ["wrong", "mean", "wrong and mean"].includes(views.measure);
  const amount = (error: number | null): string => (error === null ? "nothing compared" : isShare ? percent(error) : plainNumber(error));
  return markup`<section id="views" aria-labelledby="views-title"><h2 id="views-title">From ${views.each.length} views</h2>
<p>Worst: ${views.worst}, ${amount(views.worst_error)}; ${amount(views.mean_error)} in the mean. All else on this page is of the worst.</p>
${views.places && placesFigure(views.places, views)}${scrollRegion(
    "What the setting errs by from each view",
    markup`<table><thead><tr><th scope="col">view</th>${
      several && markup`<th scope="col">light that errs most</th>`
    }<th scope="col" class="n">${views.measure === "wrong and mean" ? "wrong pixels or mean error" : views.measure}</th></tr></thead><tbody>
${views.each.map(
  ({ view, light, error }) =>
    markup`<tr><th scope="row">${view}</th>${several && markup`<td>${light}</td>`}<td class="n">${amount(error)}</td></tr>\n`,
)}</tbody></table>`,
  )}</section>
`;
}
