// The lab's page in a browser, on the program that serves it: a setting that is changed is drawn and counted as its command counts
// it, the address brings a state back, pixels are explained, files are opened, the report is shown, nothing is asked of
// anybody else, and no page of another origin is answered. Usage: node serve_browser_test.mjs PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { browser, close, colours, openAt, pixelsOf, violations } from "../browser/open_page.mjs";
import { compared, folder, serve } from "./served_lab.mjs";

const lab = await serve("acne-floor", "--size", "192x108", "--map-size", "128");
const openLab = (options = {}, hash = "") => openAt(lab.url, lab.url, options, hash);
/** What was asked for last is compared in full. */
const done = (page) => page.waitForFunction(() => document.body.dataset.busy === "false", null, { timeout: 300000 });
const change = async (page, act) => {
  const before = page.url();
  await act();
  await page.waitForFunction((url) => location.href !== url, before);
  await done(page);
};
const setBias = (page, texels) =>
  change(page, () =>
    page
      .locator("[data-setting=bias] input[type=text]")
      .fill(texels)
      .then(() => page.keyboard.press("Enter")),
  );
const counts = (page) =>
  page
    .locator("#lab-results .labels tbody tr")
    .evaluateAll((rows) =>
      Object.fromEntries(
        rows.map((row) => [row.querySelector("summary").textContent, Number(row.querySelector(".n").textContent.replaceAll(",", ""))]),
      ),
    );
const command = (page) => page.locator("#lab-command").textContent();

async function countsWhatTheCommandCounts() {
  const page = await openLab();
  await done(page);
  for (const texels of ["2", "0"]) await setBias(page, texels);
  const { classes } = compared({ command: await command(page) }).lights[0];
  assert.ok(classes.acne > 100);
  assert.equal((await counts(page)).acne, classes.acne);
  assert.match(await page.locator("#lab-verdict").textContent(), /acne/);
  const chart = page.locator("#lab-results .chart");
  await change(page, () =>
    chart.evaluate((e) => {
      // three quarters of the way: the curve's end is at a multiple of a texel that the document knows
      const { left, right, from, to } = e.dataset,
        box = e.getBoundingClientRect(),
        width = Number(e.getAttribute("viewBox").split(" ")[2]);
      globalThis.biasAsked = Number(from) + 0.75 * (to - from);
      e.dispatchEvent(
        new MouseEvent("click", { bubbles: true, clientX: box.left + ((Number(left) + 0.75 * (right - left)) * box.width) / width }),
      );
    }),
  );
  const clicked = compared({ command: await command(page) }).lights[0].map.bias.constant_world,
    asked = await page.evaluate(() => globalThis.biasAsked);
  assert.ok(Math.abs(clicked - asked) <= 0.01 * asked, `a click at a bias of ${asked} takes ${clicked}`);
  await change(page, () => page.locator("[data-setting=technique] select").selectOption("pcf"));
  assert.ok(await page.locator("[data-setting=filter-radius]").isVisible(), "what pcf reads is there");
  assert.ok(!(await page.locator("[data-setting=esm-exponent]").isVisible()), "what it does not read is not");

  // The address is the state.
  const address = page.url(),
    words = await command(page),
    now = await counts(page);
  await change(page, () =>
    page
      .locator("[data-setting=map-size] input[type=text]")
      .fill("32")
      .then(() => page.keyboard.press("Enter")),
  );
  await change(page, () =>
    page.evaluate((hash) => {
      location.hash = hash;
    }, new URL(address).hash),
  );
  assert.equal(await command(page), words);
  assert.deepEqual(await counts(page), now);
  await close(page);
}

async function turnsAndExplains() {
  const page = await openLab();
  await done(page);
  const stage = page.locator(".stage"),
    before = await pixelsOf(page.locator(".pane canvas").first());
  const box = await stage.boundingBox();
  await change(page, async () => {
    await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.5 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.45 * box.height, { steps: 4 });
    await page.mouse.up();
  });
  assert.match(await command(page), /--camera-orbit/);
  await page.waitForFunction(() => document.body.dataset.revision !== "0");
  assert.ok(!before.equals(await pixelsOf(page.locator(".pane canvas").first())), "another view is another picture");
  await page.locator("button[data-tool=light]").click();
  await change(page, () => stage.focus().then(() => page.keyboard.press("ArrowRight")));
  assert.match(await command(page), /--light-azimuth/);
  await change(page, () => page.locator("#lab-reset").click());
  assert.match(await command(page), /^gnomon compare acne-floor --size 192x108 --map-size 128 --bias 0$/);
  await stage.click({ position: { x: 0.2 * box.width, y: 0.8 * box.height } });
  await page.locator("#lab-pixel h2").waitFor();
  assert.equal(await page.locator("#lab-pixel tbody tr").count(), 7);
  await page.locator("text=Show acne").click();
  await page.waitForFunction(() => document.getElementById("lab-note").textContent.startsWith("Show acne, on"), null, { timeout: 300000 });
  await close(page);
}

async function opensFilesAndTheReport() {
  const page = await openLab();
  await done(page);
  const file = join(folder, "pyramid.obj");
  writeFileSync(file, "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  await change(page, () => page.locator("#lab-file").setInputFiles(file));
  await page.waitForFunction(() => document.title.startsWith("pyramid"), null, { timeout: 300000 });
  writeFileSync(join(folder, "broken.obj"), "f 1 2 3\n");
  await page.locator("#lab-file").setInputFiles(join(folder, "broken.obj"));
  await page.waitForFunction(() => !document.getElementById("lab-error").hidden, null, { timeout: 300000 });
  assert.match(await page.locator("#lab-error").textContent(), /broken\.obj/);
  // The state that drew stays: the page's address and its menu are of that, controls work, and a reload is done.
  await done(page);
  assert.equal(await page.locator("#lab-scene").inputValue(), "pyramid.obj");
  assert.match(await page.evaluate(() => location.hash), /^#scene=pyramid\.obj&/);
  assert.match(await page.locator("#lab-error").textContent(), /broken\.obj/, "why is still said");
  await setBias(page, "3");
  assert.ok(await page.locator("#lab-error").isHidden());
  await page.reload();
  await done(page);
  assert.match(await page.title(), /^pyramid/);
  // So it is for whoever comes by an address of what cannot be opened.
  for (const [scene, texels] of [
    ["broken.obj", "4"],
    ["no-such-scene", "5"],
  ]) {
    await page.goto("about:blank");
    await page.goto(`${lab.url}#scene=${scene}`);
    await page.waitForFunction(() => !document.getElementById("lab-error").hidden, null, { timeout: 300000 });
    await done(page);
    assert.match(await page.locator("#lab-error").textContent(), new RegExp(scene));
    assert.equal(await page.locator("#lab-scene").inputValue(), "pyramid.obj");
    await setBias(page, texels);
    assert.ok(await page.locator("#lab-error").isHidden());
  }
  page.offences = page.offences.filter((offence) => !offence.includes("the server responded with a status of 400")); // no-such-scene
  await change(page, () => page.locator("#lab-scene").selectOption("floating-box"));
  assert.ok(await page.locator("#lab-error").isHidden());
  await page.locator("#lab-report").click();
  await page.waitForFunction(() => document.querySelector("iframe")?.contentDocument?.documentElement?.dataset.ready === "true", null, {
    timeout: 300000,
  });
  assert.match(await page.frameLocator("iframe").locator("h1").first().textContent(), /floating-box|Shadow|Floating/i);
  await close(page);
}

async function canBeReadByAll() {
  for (const [width, height] of [
    [1440, 900],
    [1024, 768],
    [390, 844],
  ]) {
    const page = await openLab({ viewport: { width, height } });
    await done(page);
    assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= width, `wider than ${width} pixels`);
    assert.deepEqual(await violations(page), [], `axe, ${width}`);
    if (width === 390)
      assert.ok((await page.locator(".stage").boundingBox()).y < height - 150, "the pictures begin on a phone's first screen");
    await close(page);
  }
  const dark = await openLab({ colorScheme: "dark" });
  await done(dark);
  assert.deepEqual(await violations(dark, colours), [], "axe, dark");
  await close(dark);
}

/** A page of another origin that knows the key sends what it can: nothing of it is a wish, whatever its body looks like. */
async function answersNoPageOfAnotherOrigin() {
  const { host } = new URL(lab.url),
    wish = JSON.stringify({ client: "evil", scene: "fence", words: [] });
  const inner = `POST ${new URL(lab.url).pathname}wish HTTP/1.1\r\nHost: ${host}\r\nContent-Length: ${wish.length}\r\n\r\n${wish}`;
  const other = createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end("<title>other</title>");
  });
  await new Promise((done) => {
    other.listen(0, "127.0.0.1", done);
  });
  const context = await browser.newContext(),
    page = await context.newPage();
  await page.goto(`http://127.0.0.1:${other.address().port}/`);
  const read = await page.evaluate(
    async ({ url, bodies }) => {
      const got = [];
      for (const path of ["x", "wish", ""])
        // one connection after the other, and its next request
        for (const body of bodies) {
          await fetch(url + path, { method: "POST", mode: "no-cors", body }).catch(() => undefined);
          await fetch(url + path, { method: "POST", body })
            .then((answer) => answer.text())
            .then(
              (text) => got.push(text),
              () => undefined,
            );
        }
      await fetch(url)
        .then((answer) => answer.text())
        .then(
          (text) => got.push(text),
          () => undefined,
        );
      return got;
    },
    {
      url: lab.url,
      bodies: [wish, inner, `${inner}${"p".repeat(5000)}`, ...Array.from({ length: 5 }, (_, i) => `${inner}${" ".repeat(1400 + i)}`)],
    },
  );
  assert.deepEqual(read, [], "it reads nothing");
  const { client, words } = await (await fetch(`${lab.url}news?after=0`)).json();
  assert.notEqual(client, "evil", words.join(" "));
  await context.close();
  await new Promise((done) => {
    other.close(done);
  });
}

async function saysThatItsProgramIsGone() {
  const page = await openLab();
  await done(page);
  await lab.stop();
  await page.locator("#lab-gone").waitFor();
  await page.context().close();
}

await countsWhatTheCommandCounts();
await turnsAndExplains();
await opensFilesAndTheReport();
await canBeReadByAll();
await answersNoPageOfAnotherOrigin();
await saysThatItsProgramIsGone();
await browser.close();
console.log("the lab in a browser");
