// Each live figure of the lessons, operated, says what the program says or what a closed form worked out here says: one function for
// each name of a figure. Each takes the page, the figure as the page has it, its selector, and the program's path.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";

/** What `compare` says of the figure's scene and settings: its first light. */
const result = (program, figure, extra = []) => {
  const { scene, sizes, ...options } = figure.settings;
  const words = Object.entries(options).flatMap(([key, value]) => [`--${key}`, value]);
  return JSON.parse(
    execFileSync(program, [
      "compare",
      scene,
      ...words,
      ...extra,
      "--size",
      "480x270",
      "--runs",
      "1",
      "--quiet",
      "--no-report",
      "--json",
      "-",
    ]),
  ).lights[0];
};
const counts = (said) =>
  said.evaluate(({ dataset }) => ({ false_shadow: Number(dataset.falseShadow), missed_shadow: Number(dataset.missedShadow) }));
const until = (page, id, key, value) =>
  page.waitForFunction(([i, k, v]) => document.querySelector(`${i} [role=status]`).dataset[k] === v, [id, key, value]);

/** Each live figure is operated, and says what the program says. */
export const operate = {
  async bias(page, figure, id, program) {
    const light = result(program, figure),
      said = page.locator(`${id} .bias-counts`);
    for (const { bias, bias_texels: _, wrong_fraction: __, ...wanted } of [3, 17, 60].map((i) => light.bias_curve[i])) {
      await page.locator(`${id} input[type=number]`).fill(String(bias));
      await page.keyboard.press("Enter");
      await page.waitForFunction(([i, b]) => document.querySelector(`${i} .bias-counts`).dataset.bias === b, [id, String(bias)]);
      assert.deepEqual(await counts(said), wanted, `bias ${bias}`);
    }
    const drawing = page.locator(`${id} .light-space`),
      before = await drawing.textContent();
    await page.locator(`${id} .bias-picture canvas`).click({ position: { x: 20, y: 60 } });
    await page.waitForFunction(([i, text]) => document.querySelector(`${i} .light-space`)?.textContent !== text, [id, before]);
  },
  async "map-size"(page, figure, id, program) {
    const sizes = figure.settings.sizes.split(",");
    for (const at of [0, sizes.length - 1]) {
      const size = sizes[at];
      await page.locator(`${id} input[type=range]`).fill(String(at));
      await until(page, id, "size", size);
      const { false_shadow, missed_shadow } = result(program, figure, ["--map-size", size]).error;
      assert.deepEqual(await counts(page.locator(`${id} [role=status]`)), { false_shadow, missed_shadow }, `size ${size}`);
    }
  },
  async "two-passes"(page, figure, id) {
    const range = page.locator(`${id} input[type=range]`);
    await range.fill("50");
    await until(page, id, "rows", String((figure.settings["map-size"] ?? 64) / 2));
    await range.fill("150");
    await until(page, id, "pixels", String((480 * 270) / 2));
    assert.equal(await page.locator(`${id} .light-space`).count(), 0);
    await range.fill("200");
    await page.locator(`${id} .light-space`).waitFor();
    const before = await page.locator(`${id} .story`).textContent();
    await page.locator(`${id} [role=application]`).click({ position: { x: 150, y: 120 } });
    await page.waitForFunction(([i, text]) => document.querySelector(`${i} .story`).textContent !== text, [id, before]);
  },
};
/** As if dragged there: a slider takes the nearest of its steps, and its end for what lies beyond, which not every version of
    fill() allows. One after the other, and then a drawing later: the figure has taken all of them. */
export const slide = (page, id, values) =>
  page.evaluate(
    ([figure, all]) => {
      for (const [slider, value] of Object.entries(all)) {
        const input = document.querySelector(`${figure} [data-slider=${slider}]`);
        input.value = value;
        input.dispatchEvent(new Event("input", { bubbles: true }));
        input.dispatchEvent(new Event("change", { bubbles: true }));
      }
      return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    },
    [id, values],
  );
export const said = (page, id) =>
  page
    .locator(`${id} [role=status]`)
    .evaluate(({ dataset }) => Object.fromEntries(Object.entries(dataset).map(([key, value]) => [key, Number(value)])));
const words = (page, id) => page.locator(`${id} [role=status]`).textContent();
export const near = (value, wanted, tolerance, what) =>
  assert.ok(Math.abs(value - wanted) <= tolerance, `${what}: ${value}, wanted ${wanted} within ${tolerance}`);
const radians = (degrees) => (degrees * Math.PI) / 180;

/** The flatlands against closed forms worked out here, from the scenes' own numbers. */
const flatlands = {
  // The floor is measured in 640 pieces; each edge of a texel's dark half falls into one of them.
  async acne(page, id) {
    near((await said(page, id)).angle, 90 - 42, 0.5, "the sun of acne-floor");
    for (const [angle, texels, bias] of [
      [48, 14, 0],
      [48, 20, 0.06],
      [-30, 10, 0.03],
      [60, 30, 0.3],
    ]) {
      await slide(page, id, { angle, texels, bias });
      const { texel, falseShare, missedShare, bias: used } = await said(page, id);
      const a = 0.5 * texel * Math.tan(radians(Math.abs(angle)));
      near(falseShare, a > used ? 0.5 * (1 - used / a) : 0, texels / 640, `acne at ${angle} degrees, ${texels} texels, bias ${bias}`);
      near(texel, (6 * Math.cos(radians(angle))) / texels, 1e-9, "width of a texel");
      assert.equal(missedShare, 0);
    }
  },
  // A texel's width on the floor, and a piece's.
  async wall(page, id) {
    near((await said(page, id)).angle, 60, 0.5, "the sun of thin-wall");
    for (const [angle, texels, bias] of [
      [60, 128, 0.2],
      [-45, 128, 0.3],
      [60, 100, 0.03],
    ]) {
      await slide(page, id, { angle, texels, bias });
      const { texel, measured, bias: used } = await said(page, id);
      near(
        measured,
        Math.max(0, used * Math.sin(radians(Math.abs(angle))) - 0.05),
        texel / Math.cos(radians(angle)) + 0.006,
        `wall at ${angle} degrees, bias ${bias}`,
      );
    }
    // Square to the floor there is nothing for a bias to cure, and no shadow.
    await slide(page, id, { angle: 0, bias: 0 });
    assert.match(await words(page, id), /no shadow is drawn/);
    assert.equal((await said(page, id)).falseShare, 0);
    await slide(page, id, { angle: 60 });
  },
  async penumbra(page, id) {
    for (const [radius, height] of [
      [0.4, 4],
      [0.2, 3],
      [0, 4],
      [0.9, 4],
    ]) {
      await slide(page, id, { radius, height, x: 0 });
      const { umbra, penumbra } = await said(page, id),
        h = 1.6,
        a = 0.6;
      near(umbra, Math.max(0, (a * height - radius * h) / (height - h)), 1e-6, "umbra");
      near(penumbra, (a * height + radius * h) / (height - h), 1e-6, "penumbra");
    }
    // So wide a lamp leaves no umbra, and of one so far aside the umbra lies beyond the drawing.
    await slide(page, id, { radius: 1, height: 2, x: 0 });
    assert.match(await words(page, id), /there is no umbra/);
    assert.ok(!(await page.locator(`${id} svg text`).allTextContents()).includes("umbra"));
    await slide(page, id, { radius: 0.1, height: 2, x: 1.5 });
    assert.deepEqual(await page.locator(`${id} svg text`).allTextContents(), ["penumbra"]);
  },
  async terminator(page, id) {
    for (const [angle, sides] of [
      [35, 14],
      [-100, 9],
      [0, 60],
    ]) {
      await slide(page, id, { angle, sides });
      const { lostLeft, lostRight, formulaLeft, formulaRight } = await said(page, id),
        piece = 360 / sides / 60;
      near(lostLeft, formulaLeft, piece, "left");
      near(lostRight, formulaRight, piece, "right");
      assert.ok(Math.max(lostLeft, lostRight) <= 180 / sides + 1e-9);
    }
    // Below the floor: the sun is drawn there, and what the floor shadows is no fault of the ball's faces.
    await slide(page, id, { angle: 180, sides: 14 });
    const { lostLeft, lostRight } = await said(page, id),
      round = 2 * Math.PI * 0.7 * (960 / 5);
    const [low, orange] = await page
      .locator(`${id} svg`)
      .evaluate((svg) => [Number(svg.querySelector(".sun").getAttribute("cy")), svg.querySelector(".surface.false").getTotalLength()]);
    assert.ok(low > (960 / 5) * 2.3, `the sun is drawn at ${low}`);
    near(orange, ((lostLeft + lostRight) / 360) * round, 0.02 * round, "orange");
  },
  // Bias cures false shadow, and takes true shadow with it.
  async shadow(page, id) {
    await slide(page, id, (await page.locator(`${id} [data-slider=offset]`).count()) > 0 ? { bias: 0, offset: 0 } : { bias: 0 });
    const without = await said(page, id);
    assert.ok(without.falseShare > 0.1, `false shadow ${without.falseShare}`);
    await slide(page, id, { bias: 9 });
    const most = await said(page, id);
    assert.ok(most.falseShare < 0.02 && most.missedShare > without.missedShare, `${most.falseShare} false, ${most.missedShare} missed`);
  },
};
/** The first figure of the course: half of the floor is dark, by no word that comes later. */
flatlands.stripes = async (page, id) => {
  await slide(page, id, { angle: 48, texels: 10 });
  near((await said(page, id)).falseShare, 0.5, 0.02, "half of each texel");
  assert.doesNotMatch(await page.locator(id).innerText(), /bias|missed|false shadow|offset/i);
};
// Without a bias nothing is wrong, with one the shadow starts δ·sin θ away, whatever the wall's thickness; the program says the same.
flatlands["back-faces"] = async (page, id, program) => {
  await slide(page, id, { angle: 60, texels: 128, bias: 0 });
  assert.ok((await said(page, id)).falseShare < 0.01, "no acne: but for the texel at the shadow's end");
  for (const [angle, bias] of [
    [60, 0.2],
    [-45, 0.3],
    [60, 0.03],
  ]) {
    await slide(page, id, { angle, texels: 128, bias });
    const { texel, measured, bias: used } = await said(page, id);
    near(
      measured,
      used * Math.sin(radians(Math.abs(angle))),
      texel / Math.cos(radians(angle)) + 0.006,
      `back faces at ${angle} degrees, bias ${bias}`,
    );
  }
  near(
    result(program, { settings: { scene: "thin-wall", bias: "0.2", cull: "front" } }).detachment.max_world,
    0.2 * Math.sin(radians(60)),
    0.005,
    "the program's",
  );
};
operate.flatland = async (page, { settings: { show, scene } }, id, program) => {
  if (show !== "shadow") return flatlands[show](page, id, program);
  if (scene === "wall") await flatlands.wall(page, id);
  await flatlands.shadow(page, id);
};
// The page's walks count what the program counted for the same rays: cells or nodes, and primitives; and hit where it hit.
operate.structure = async (page, figure, id) => {
  const at = Number(/\d+/.exec(id)[0]),
    walks = await page.evaluate(
      (i) =>
        globalThis
          .gnomonWalks(i)
          .map(({ wanted, walk: { boxes, primitives, t } }) => ({ wanted, boxes, primitives, t: isFinite(t) ? t : null })),
      at,
    );
  assert.ok(walks.length >= 8 && walks.some(({ t }) => t !== null));
  for (const { wanted, boxes, primitives, t } of walks) {
    assert.deepEqual(
      { boxes, primitives },
      { boxes: wanted.boxes, primitives: wanted.primitives },
      JSON.stringify([figure.settings, wanted]),
    );
    // Both meet the same segment in doubles; in the page its ends were cut out of a triangle first.
    if (wanted.t === null) assert.equal(t, null);
    else near(t, wanted.t, 1e-6 * wanted.t, "hit");
  }
  await slide(page, id, { step: 1 });
  const whole = await said(page, id);
  await slide(page, id, { step: 0 });
  const none = await said(page, id);
  assert.ok(none.cells === 0 && none.primitives === 0 && whole.cells >= 1 && whole.boxes > 1, JSON.stringify([none, whole]));
  await slide(page, id, { step: 1, toY: 0.02, zoom: 2 });
  assert.notDeepEqual(await said(page, id), whole);
};
/** Through the edge, from its one side to the other, some triangle is always hit; in floats Möller and Trumbore lose rays, signs none. */
async function checkSharedEdge(page, id) {
  let formula = 0;
  for (let i = -4; i <= 4; ++i) {
    const x = 0.07 * i;
    await slide(page, id, { Ax: -1.7, Ay: 0.1, Bx: x + 0.31, By: -1.1, Cx: x - 0.31, Cy: 1.1, Dx: 1.9, Dy: -0.2 });
    const found = await page.locator(`${id} [role=status]`).evaluate(({ dataset }) => ({ ...dataset }));
    assert.deepEqual([found.hit, found.other], [String(i >= 0), String(i <= 0)], `the edge at ${x}`);
    assert.equal(found.signs, "0");
    formula += Number(found.formula);
  }
  assert.ok(formula > 0, "Möller and Trumbore in floats lose none of 9000 rays");
}
// Against what the ray tracer finds for the same rays.
operate.intersection = async (page, { settings: { kind, show }, data: { checks } }, id) => {
  assert.ok(checks.some(({ t }) => t === null) && checks.some(({ t }) => t !== null));
  if (kind === "triangle") {
    if (show === "edge") await slide(page, id, { Dx: 2.9, Dy: 1.4 });
    for (const { corners, t } of checks) {
      await slide(
        page,
        id,
        Object.fromEntries(
          corners.flatMap(([x, y], i) => [
            [`${"ABC"[i]}x`, x],
            [`${"ABC"[i]}y`, y],
          ]),
        ),
      );
      const { hit, z, u, u2 } = await page.locator(`${id} [role=status]`).evaluate(({ dataset }) => ({ ...dataset }));
      assert.equal(hit === "true", t !== null, JSON.stringify(corners));
      if (show === "edge") {
        assert.equal(Number(u) + Number(u2), 0, "the edge's number has two signs");
        continue;
      }
      if (t !== null) near(Number(z), t, 1e-9, "z");
      if (show === "both") await checkBothWays(page, id);
    }
    if (show === "edge") return checkSharedEdge(page, id);
    await slide(page, id, { Ax: 1, Ay: 1, Bx: 1, By: 1, Cx: 1, Cy: 1 });
    assert.match(await words(page, id), /the triangle has no area/);
    return;
  }
  for (const { from, to, t } of checks) {
    await slide(page, id, { ox: from[0], oy: from[1], ax: to[0], ay: to[1] });
    const found = await page.locator(`${id} [role=status]`).evaluate(({ dataset }) => ({ ...dataset }));
    if (kind === "parity") {
      const { crossings } = checks.find((check) => check.from === from);
      assert.deepEqual(
        [found.roots.split(" ").filter((r) => r !== "").length, found.inside],
        [crossings, String(crossings % 2 === 1)],
        `${kind} from ${from} to ${to}`,
      );
    }
    const roots =
      kind === "box"
        ? found.hit === "true"
          ? [Number(found.entry)]
          : []
        : found.roots
            .split(" ")
            .filter((r) => r !== "")
            .map(Number)
            .filter((r) => r > 0);
    if (t === null) assert.deepEqual(roots, [], `${kind} from ${from} to ${to}`);
    else near(roots[0], t, 1e-6, `${kind} from ${from} to ${to}`);
  }
  // The rays that a test must bear.
  const cases = {
    box: [
      ["starts inside", /the last entry −1\.142 is not after the first exit, 0\.7265: the ray hits/],
      ["points away", /not after the first exit, which lies before the start, −\S+: the ray misses/],
      ["runs in a face", /hits/],
      ["is parallel, outside", /misses/],
    ],
    plane: [
      ["points away", /behind the start/],
      ["is parallel", /never comes/],
    ],
    parity: [
      ["starts inside", /inside/],
      ["starts in a notch", /outside/],
      ["passes a corner", /outside/],
    ],
  };
  for (const [name, answer] of cases[kind] ?? []) {
    await page.locator(`${id} .steps button`, { hasText: name }).click();
    await slide(page, id, {});
    assert.match(await words(page, id), answer, `${kind}: a ray that ${name}`);
  }
  // A ray that begins where it touches the ball, and one of a single stretch.
  await slide(page, id, kind === "sphere" ? { ox: 0.2, oy: 0.9, ax: 2, ay: 0.9 } : { ox: 2.5, oy: 1, ax: 3, ay: 1.5 });
  if (kind === "sphere") assert.match(await words(page, id), /t = 0, 0\.$/);
  if (kind === "implicit") assert.match(await words(page, id), /^1 stretch after 0 halvings: /);
};
/** The two-step way and Möller's and Trumbore's give the same numbers. */
async function checkBothWays(page, id) {
  const { twoSteps, z, sides, u, v } = await page.locator(`${id} [role=status]`).evaluate(({ dataset }) => ({ ...dataset }));
  const [ofC, ofA, ofB] = sides.split(" ").map(Number);
  near(Number(twoSteps), Number(z), 1e-9 * Math.abs(Number(z)), "t in two steps");
  near(ofA + ofB + ofC, 1, 1e-9, "barycentric coordinates");
  near(ofB, Number(u), 1e-9 * (1 + Math.abs(ofB)), "u");
  near(ofC, Number(v), 1e-9 * (1 + Math.abs(ofC)), "v");
}
// The camera of the program, for pictures of several shapes and angles.
operate["eye-ray"] = async (page, { data: { checks } }, id) => {
  assert.equal(checks.length, 27);
  const directions = await page.evaluate(
    (all) => all.map(({ columns, rows, fov, x, y }) => globalThis.gnomonEyeRay(columns, rows, fov, x, y).direction),
    checks,
  );
  checks.forEach(({ direction }, i) => direction.forEach((c, k) => near(directions[i][k], c, 1e-12, `direction ${i}`)));
  await slide(page, id, { columns: 1, rows: 1, fov: 90, x: 0, y: 0 });
  assert.deepEqual(
    await said(page, id).then(({ u, v, dx, dy, dz }) => [u, v, dx, dy, dz].map((c) => c + 0)),
    [0, 0, 0, 0, -1],
    "one pixel looks straight on",
  );
};
// The curve of grids goes through what the program counts for its two, but for the endless floor; and cells follow the cube root.
operate["grid-curve"] = async (page, { data: { points, program } }, id) => {
  for (const { density, cells, triangles } of program) {
    const own = points.find((p) => p.density === density);
    near(own.cells, cells, 1e-9, `cells of ${density} a primitive`);
    near(own.triangles, triangles, 1e-9, `triangles of ${density} a primitive, with the floor`);
    // The lesson's table, of more rays, has the same numbers.
    const [row] = await page.locator("tr", { has: page.locator(`td:first-child:text-is("${density}")`) }).allInnerTexts(),
      [ofTable, testsOfTable] = row.split(/\s+/).slice(1, 3).map(parseFloat);
    near(cells, ofTable, 0.03 * ofTable, `cells of the table's row ${row}`);
    near(triangles, testsOfTable, 0.03 * testsOfTable, `triangles of the table's row ${row}`);
  }
  await page.locator(`${id} input[type=range]`).fill("5");
  await until(page, id, "density", "27");
  const { formula, cells } = await said(page, id);
  near(cells, formula, 0.1 * formula, "cells by the cube root");
};
/** Rays across the discs from all around, and where the first of them is met: a disc that lies on both sides of a split is found from either. */
const fan = (discs) =>
  Array.from({ length: 300 }, (_, i) => {
    const from = [3 * Math.cos(i), 1.6 * Math.sin(i)],
      to = [2.4 * Math.cos(1.7 * i), 0.9 * Math.sin(2.3 * i)],
      size = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const way = [(to[0] - from[0]) / size, (to[1] - from[1]) / size];
    const ends = discs
      .flatMap(([x, y, radius]) => {
        const along = (x - from[0]) * way[0] + (y - from[1]) * way[1],
          half = radius ** 2 - ((x - from[0]) ** 2 + (y - from[1]) ** 2 - along ** 2);
        return half < 0 ? [] : [along - Math.sqrt(half), along + Math.sqrt(half)];
      })
      .filter((t) => t > 0);
    return { from, to, t: ends.length > 0 ? Math.min(...ends) : null };
  });
// Small structures hit what the program's tracer hits; boxes are met as often as their perimeters foretell; steps, splits and stack.
operate.build = async (page, { settings: { kind }, data }, id) => {
  assert.ok(data.checks.filter(({ t }) => t !== null).length >= 5);
  const rules = { kd: ["middle", "area"], bvh: ["middle", "area"], bsp: ["area"] }[kind] ?? ["middle"];
  const wide = data.discs.map(([x, y, radius]) => [x, y, 2 * radius]); // they overlap, and each split goes through some
  for (const rule of rules) {
    for (const json of [data, { discs: wide, checks: fan(wide) }]) {
      const hits = await page.evaluate(
        (words) => globalThis.gnomonSmallHits(...words).map((t) => (isFinite(t) ? t : null)),
        [json, kind, rule],
      );
      json.checks.forEach(({ t }, i) =>
        t === null ? assert.equal(hits[i], null) : near(hits[i] ?? NaN, t, 1e-9, `${kind}, ${rule}, ray ${i}`),
      );
    }
  }
  // It begins with nothing built, and no answer.
  const begun = await said(page, id);
  assert.deepEqual([begun.splits, begun.boxes, begun.discs, begun.expected], [0, 0, 0, undefined], `${kind} begins`);
  await slide(page, id, { walk: 1, built: 1, ...(kind === "grid" ? { cells: 4 } : {}) });
  const whole = await said(page, id);
  assert.ok(whole.boxes >= 3 && whole.discs >= 1 && whole.discs < data.discs.length, JSON.stringify(whole));
  // What is said to be tested is outlined; what lies in several cells of a tree is tested in each. A grid has mailboxes, and boxes own.
  assert.equal(await page.locator(`${id} .disc.tested`).count(), whole.discs);
  assert.ok(kind === "kd" ? whole.tests > whole.discs : whole.tests >= whole.discs, JSON.stringify(whole));
  if (kind === "grid" || kind === "bvh") assert.equal(whole.tests, whole.discs);
  if (kind === "grid") {
    await slide(page, id, { cells: 16 });
    assert.ok((await said(page, id)).boxes > 1.5 * whole.boxes, "twice the cells along each axis are about twice the steps");
    // A disc's box touches as many cells as it is entered into; one cell in all gains nothing.
    assert.ok(whole.held >= data.discs.length && whole.held < whole.cells, JSON.stringify(whole));
    await slide(page, id, { cells: 0 });
    const { cells, held, boxes, discs } = await said(page, id);
    assert.deepEqual([cells, held, boxes, discs], [1, 1, 1, data.discs.length]);
    return;
  }
  near(whole.counted, whole.expected, 0.02 * whole.expected, "boxes that a line meets");
  await slide(page, id, { walk: 0, built: 0 });
  assert.equal((await said(page, id)).splits, 0);
  await page.locator(`${id} .steps button`, { hasText: "Next split" }).click();
  for (let i = 0; i < 2; ++i)
    await page
      .locator(`${id} .steps button`, { hasText: "Next step" })
      .click()
      .then(() => slide(page, id, {}));
  assert.match(await words(page, id), /^1 split of \d+.*\. .*On the stack: 1/);
  if (kind === "octree") return;
  if (rules.length > 1) await slide(page, id, { rule: 1 });
  // Of n discs: both ends of each along two axes but for the outermost; a line between each two; each place between two in order.
  const n = data.discs.length,
    first = { kd: 4 * n - 4, bsp: (n * (n - 1)) / 2, bvh: 2 * (n - 1) }[kind],
    splits = Number(/of (\d+)/.exec(await words(page, id))[1]);
  await slide(page, id, { built: 1 / splits });
  assert.equal((await said(page, id)).tried, first, "ways to make the first split");
  await slide(page, id, { built: 1 });
  const { expected } = await said(page, id);
  if (kind === "bvh") assert.ok(expected < whole.expected, "a split by area costs less than one in the middle");
};
// The lookup of a cube map, worked out here; and what the texel in the middle below the lamp stores.
operate["cube-faces"] = async (page, figure, id) => {
  for (const [lampX, lampY, x, texels] of [
    [-0.9, 2, 1.6, 8],
    [1.5, 1, 1.5, 9],
    [-1.5, 0.5, 2.5, 16],
  ]) {
    await slide(page, id, { lampX, lampY, x, texels });
    const { z, u, wide, texel, stored } = await said(page, id),
      d = [x - lampX, -lampY],
      along = Math.max(Math.abs(d[0]), Math.abs(d[1]));
    near(z, along, 1e-9, "z");
    near(wide, (2 * along) / texels, 1e-9, "width of a texel");
    assert.ok(u > 0 && u < 1 && texel === Math.floor(u * texels));
    if (lampX === x) near(stored, lampY, 1e-9, "depth below the lamp");
  }
  await slide(page, id, { lampX: 0, lampY: 0.85, x: 0, texels: 9 }); // the middle of the ball: it stores the ball's far side
  near((await said(page, id)).stored, 0.7, 1e-9, "depth within the ball");
};
// Followed backwards light has the same way, and the same share of it arrives: by the page's paths, and by the program's Fresnel.
operate["two-ways"] = async (page, { data: { fresnel } }, id) => {
  for (const { cosine, ratio, reflected } of fresnel) {
    const behind = Math.sqrt(1 - ratio ** 2 * (1 - cosine ** 2));
    if (reflected < 1)
      near(
        await page.evaluate(([c, r]) => globalThis.gnomonFresnel(c, r), [behind, 1 / ratio]),
        reflected,
        1e-12,
        "the program's share, the other way",
      );
  }
  for (const [aimX, aimY, surfaces] of [
    [0.36, 0.3, 5],
    [0.4, 0.25, 5],
    [0.76, 0.31, 3],
  ]) {
    await slide(page, id, { aimX, aimY });
    const found = await said(page, id);
    assert.equal(found.surfaces, surfaces, `aimed at ${aimX}, ${aimY}`);
    assert.ok(found.there > 0.4 && found.there < 1);
    near(found.back, found.there, 1e-12, "share");
    near(found.apart, 0, 1e-9, "places");
  }
};
// A rod that leans by 45 degrees and has no width: 1/(|cos| + |sin|). Turned with it the box is the rod.
operate["box-fit"] = async (page, figure, id) => {
  for (const [rod, box, cost] of [
    [45, 0, 6],
    [20, 0, 6],
    [45, 30, 24],
    [10, 90, 6],
  ]) {
    await slide(page, id, { rod, box, width: 0.02 });
    const { formula, measured, cost: paid } = await said(page, id),
      between = radians(rod - box);
    near(formula, 1 / (Math.abs(Math.cos(between)) + Math.abs(Math.sin(between))), 0.01, `a rod at ${rod}, a box at ${box} degrees`);
    near(measured, formula, 0.02, "counted");
    assert.equal(paid, cost);
  }
  await slide(page, id, { rod: 35, box: 35, width: 0.4 });
  assert.equal((await said(page, id)).measured, 1);
};
operate.whitted = async (page, { data: { fresnel } }, id) => {
  const shares = await page.evaluate((all) => all.map(({ cosine, ratio }) => globalThis.gnomonFresnel(cosine, ratio)), fresnel);
  fresnel.forEach(({ reflected }, i) => near(shares[i], reflected, 1e-12, "Fresnel"));
  await slide(page, id, { step: 1 });
  const { total } = await said(page, id);
  assert.ok(total >= 6, `${total} rays`);
  await slide(page, id, { step: 0 });
  for (let ray = 1; ray <= 3; ++ray) {
    await page.locator(`${id} .next-ray`).click();
    await page.waitForFunction(([i, n]) => document.querySelector(`${i} [role=status]`).dataset.rays === n, [id, String(ray)]);
  }
  // The floor below the glass ball, and the lamp above it: two surfaces with 4 % reflected at each, and a shadow ray more behind each.
  await slide(page, id, {
    eyeX: 0.6 / 8.2,
    eyeY: 1.4 / 4.6,
    aimX: 3.6 / 8.2,
    aimY: 0.4 / 4.6,
    lampX: 3.6 / 8.2,
    lampY: 4.4 / 4.6,
    step: 1,
  });
  assert.equal((await said(page, id)).total, 4);
  assert.match(await words(page, id), /the surfaces of the glass let 92\.2 % of the light through/);
};
