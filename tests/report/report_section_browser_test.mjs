// The cross-section cuts every shape: for a pixel on each, the drawn profile passes through the pixel's own receiver.
// Needs what report_browser_test needs, OpenGL in software, and oiiotool. Usage: node report_section_browser_test.mjs
// GNOMON_PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { browser, close, open } from "../browser/open_page.mjs";

const [program, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const shapes = {
  floor: { plane: { point: [0, 0, 0], normal: [0, 1, 0] } },
  ball: { sphere: { center: [-1.6, 0.5, 0], radius: 0.5 } },
  ring: { torus: { center: [0, 0.3, 0.4], axis: [0, 1, 0], major_radius: 0.5, minor_radius: 0.25 } },
  egg: { ellipsoid: { center: [1.5, 0.4, 0], radii: [0.6, 0.4, 0.4] } },
  tin: { cylinder: { base: [-0.8, 0, -1.2], radius: 0.4, height: 1.1 } },
  pillow: {
    implicit: {
      function: "x^4 + y^4 + z^4 - 0.1",
      box: [
        [-0.6, -0.6, -0.6],
        [0.6, 0.6, 0.6],
      ],
      center: [0.9, 0.6, -1.3],
    },
  },
};
const names = Object.keys(shapes);
writeFileSync(
  join(folder, "solids.json"),
  JSON.stringify({
    schema: "gnomon/scene/1",
    camera: { eye: [0, 3, 5], target: [0, 0.4, 0], vertical_fov_degrees: 40 },
    lights: [{ name: "sun", type: "directional", elevation_degrees: 50, azimuth_degrees: 60 }],
    materials: [{ name: "grey" }],
    shapes: names.map((name) => ({ name, ...shapes[name], material: "grey" })),
  }),
);
const width = 160,
  height = 90;
execFileSync(
  program,
  [
    "compare",
    join(folder, "solids.json"),
    "--size",
    `${width}x${height}`,
    "--map-size",
    "256",
    "--runs",
    "1",
    "--quiet",
    "-o",
    folder,
    "--aov",
    join(folder, "all.exr"),
  ],
  { stdio: "inherit" },
);

// Of each object its compared pixels, rows from the top, by another program.
function pixelsOfObjects() {
  execFileSync("oiiotool", [join(folder, "all.exr"), "--ch", "class.V,object.V", "-o", join(folder, "few.exr")]);
  const text = execFileSync("oiiotool", ["--dumpdata", join(folder, "few.exr")], { encoding: "utf8", maxBuffer: 1 << 28 });
  const objects = new Map();
  for (const [, x, y, values] of text.matchAll(/Pixel \((\d+), (\d+)\): (.*)/g)) {
    const [label, object] = values.trim().split(/\s+/).map(Number);
    if (label >= 0) objects.set(object, [...(objects.get(object) ?? []), [Number(x), Number(y)]]);
  }
  return objects;
}

/** How far the profile passes from the ring around the pixel's receiver, in units of the drawing. */
const distanceToProfile = (page) =>
  page.locator("svg.section").evaluate((drawing) => {
    const ring = drawing.querySelector(".ring"),
      x = Number(ring.getAttribute("cx")),
      y = Number(ring.getAttribute("cy"));
    const curves = drawing.querySelector(".profile").getAttribute("d").split("M").slice(1);
    let nearest = Infinity;
    for (const curve of curves) {
      const points = curve.split("L").map((p) => p.split(",").map(Number));
      for (let i = 0; i + 1 < points.length; ++i) {
        const [ax, ay] = points[i],
          dx = points[i + 1][0] - ax,
          dy = points[i + 1][1] - ay,
          length = dx * dx + dy * dy;
        const t = length > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / length)) : 0;
        nearest = Math.min(nearest, Math.hypot(ax + t * dx - x, ay + t * dy - y));
      }
    }
    return nearest;
  });

// A chord of 128 sectors strays 0.03 % of the radius, one across a cell of the implicit surface 0.1 %: 0.0006 in the scene.
// A texel is 0.03 wide and drawn 33 units wide, depth stretched at most threefold: 2 units, and half a one for rounding.
const tolerance = 2.5;
const objects = pixelsOfObjects();
assert.equal(objects.size, names.length, "not every shape is seen");
let checked = 0;
for (const pixels of objects.values())
  for (const share of [0.25, 0.5, 0.75]) {
    const [x, y] = pixels[Math.floor(share * pixels.length)];
    const page = await open(folder, {}, `#light-0?pixel=${x},${y}`);
    await page.locator("svg.section .profile").waitFor();
    assert.ok(
      await page.locator("svg.section .ring").evaluate((ring) => Number(ring.getAttribute("cx")) > 0),
      "the pixel is beside the drawing",
    );
    const distance = await distanceToProfile(page);
    assert.ok(distance <= tolerance, `the cut passes ${distance.toFixed(1)} units from pixel ${x}, ${y}`);
    assert.match(await page.locator("figure:has(svg.section) figcaption").textContent(), /meshes of 128 sectors/);
    await close(page);
    ++checked;
  }
await browser.close();
console.log(`the cut passes through the receivers of ${checked} pixels on ${objects.size} shapes`);
