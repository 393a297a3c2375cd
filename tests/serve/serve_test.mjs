// gnomon serve: a state that is asked for is the comparison that its command makes; and whoever does not know the address, comes
// from another page, names files that are not its own, sends too much or too slowly is not let in, while others are answered.
// Usage: node serve_test.mjs PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { readdirSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { join } from "node:path";
import { ask, compared, folder, post, program, serve } from "./served_lab.mjs";

const lab = await serve("acne-floor", "--size", "96x54", "--map-size", "64");
const { hostname, port, pathname } = new URL(lab.url),
  token = pathname.slice(1, -1);
assert.equal(hostname, "127.0.0.1");
assert.match(token, /^[0-9a-f]{32}$/);

/** What comes back for these bytes, until the server closes; "": nothing. */
const raw = (text) =>
  new Promise((done) => {
    let got = "";
    const socket = connect(Number(port), hostname, () => socket.write(text));
    socket.on("data", (part) => {
      got += part;
    });
    socket.on("error", () => done(got));
    socket.on("close", () => done(got));
  });
const status = (answer) => Number(/^HTTP\/1.1 (\d+)/.exec(answer)?.[1] ?? 0);
const request = (path, { method = "GET", host = `${hostname}:${port}`, headers = [], body = "" } = {}) =>
  raw(
    [
      `${method} ${path} HTTP/1.1`,
      ...(host === null ? [] : [`Host: ${host}`]),
      "Connection: close",
      ...headers,
      ...(body ? [`Content-Length: ${body.length}`] : []),
      "",
      body,
    ].join("\r\n"),
  );
const isAlive = async () => assert.equal((await fetch(lab.url)).status, 200);

async function answersWhatItsCommandMakes() {
  for (const words of [
    ["--size", "96x54", "--map-size", "64", "--bias", "0"],
    ["--size", "80x45", "--technique", "pcf", "--filter-radius", "2"],
    ["--size", "96x54", "--light-azimuth", "30", "--light-elevation", "40", "--bias=-0.5texel"],
    ["--size", "96x54", "--camera-orbit", "20,35"],
  ]) {
    const reading = await ask(lab, { scene: "acne-floor", words }),
      own = reading.result.lights[0],
      other = compared(reading).lights[0];
    for (const key of ["pixels", "classes", "class_errors", "budget", "ladder", "bias_curve", "best_bias"])
      assert.deepEqual(own[key], other[key], `${key}: ${reading.command}`);
    assert.equal(own.error.wrong, other.error.wrong);
    const again = await ask(lab, { scene: "acne-floor", words: reading.words });
    assert.deepEqual(again.words, reading.words, "the words bring the state back");
    assert.deepEqual(again.result.lights[0].classes, own.classes);
  }
  const picture = await fetch(`${lab.url}picture?name=labels`);
  assert.equal(picture.headers.get("content-type"), "image/png");
  const story = await (await fetch(`${lab.url}pixel?x=40&y=40`)).json();
  assert.deepEqual(story.pixel, [40, 40]);
  assert.equal(story.rungs.length, 7);
  assert.equal((await fetch(`${lab.url}pixel?x=96&y=0`)).status, 400);
  const { result, verdict, values } = await ask(lab, { scene: "acne", words: [] });
  assert.ok(result.lights[0].classes.acne > 0, "a lesson brings its own settings");
  assert.equal(values["map-size"], "64");
  assert.match(verdict.headline, /acne/);
  const shown = await ask(lab, { scene: "floating-box", words: ["--size", "96x54"], preset: 1 });
  assert.match(
    shown.note === "" ? (await ask(lab, { scene: "floating-box", words: shown.words })).verdict.headline : shown.note,
    /peter-panning/,
  );
}

async function refusesWhatIsNoState() {
  for (const words of [
    ["--technique", "none"],
    ["--bias", "much"],
    ["--shader-dir", "/"],
    ["-o", "/tmp/x"],
    ["--allow-outside"],
    ["--memory", "1"],
    ["--script", "x"],
    ["--size", "0x0"],
    ["--size", "99999x99999"],
    ["stray"],
    ["--technique", "hard", "--filter-radius", "2"],
    ["--camera", "none"],
    ["--light", "none"],
  ]) {
    const { error } = await ask(lab, { scene: "acne-floor", words });
    assert.ok(error, words.join(" "));
  }
  for (const scene of ["/etc/passwd", "../acne-floor", "none", "", folder, "file:///etc/passwd"])
    assert.equal((await ask(lab, { scene, words: [] })).status, 400, scene);
  for (const wish of [
    "",
    "{",
    "[]",
    "null",
    '{"client": 1}',
    '{"client": "a", "scene": "acne-floor", "words": [1]}',
    `{"client": "${"a".repeat(70000)}"}`,
  ])
    assert.ok([400, 413].includes((await post(`${lab.url}wish`, wish)).status), wish.slice(0, 40));
  await isAlive();
}

async function letsNobodyInWhoDoesNotKnowTheAddress() {
  for (const path of [
    "/",
    "/favicon.ico",
    "/wish",
    "/news?after=0",
    `/${"0".repeat(32)}/`,
    `/${token.slice(0, -1)}/`,
    `/${token}`,
    `/${token}x/`,
    `//${token}/`,
    "/%00",
    `/x/../${token}/../`,
  ])
    assert.equal(status(await request(path)), 404, path);
  for (const path of [
    `/${token}/../../etc/passwd`,
    `/${token}/..%2f..%2fetc%2fpasswd`,
    `/${token}/%2e%2e/%2e%2e/etc/passwd`,
    `/${token}/report-data/../result.json`,
    `/${token}/picture/../../x`,
  ]) {
    const answer = await request(path);
    assert.equal(status(answer), 404, path);
    assert.ok(!answer.includes("root:"), path);
  }
  assert.equal((await fetch(`${lab.url}picture?name=../../../../etc/passwd`)).status, 400);
  for (const method of ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "POST"])
    assert.ok(status(await request(`/${token}/`, { method })) >= 400, method);
}

async function answersNoOtherPage() {
  for (const host of ["evil.example", "evil.example:80", `127.0.0.1.evil.example:${port}`, "", null, "169.254.169.254", "[::2]:80"])
    assert.ok([400, 421].includes(status(await request(`/${token}/`, { host }))), `Host: ${host}`);
  for (const host of [`localhost:${port}`, "localhost:9000", "127.0.0.1", `[::1]:${port}`])
    // by a tunnel's other port, too
    assert.equal(status(await request(`/${token}/`, { host })), 200, `Host: ${host}`);
  for (const header of [
    "Origin: http://evil.example",
    "Origin: null",
    `Origin: https://127.0.0.1:${port}`,
    "Origin: http://127.0.0.1:1",
    "Sec-Fetch-Site: cross-site",
    "Sec-Fetch-Site: same-site",
  ])
    assert.equal(status(await request(`/${token}/`, { headers: [header] })), 403, header);
  assert.equal(status(await request(`/${token}/`, { headers: [`Origin: http://127.0.0.1:${port}`, "Sec-Fetch-Site: same-origin"] })), 200);
  const { headers } = await fetch(lab.url);
  assert.equal(headers.get("x-content-type-options"), "nosniff");
  assert.equal(headers.get("cache-control"), "no-store");
  assert.equal(headers.get("referrer-policy"), "no-referrer");
  assert.equal(headers.get("content-security-policy"), "frame-ancestors 'self'");
  assert.equal(headers.get("access-control-allow-origin"), null);
}

async function takesFilesForWhatTheyAre() {
  const drop = (name, body) => post(`${lab.url}file?name=${encodeURIComponent(name)}`, body);
  for (const name of ["", ".", "..", ".hidden", "../x.obj", "a/b.obj", "a\\b.obj", "a\0.obj", "x".repeat(200), "a\nb"])
    assert.equal((await drop(name, "x")).status, 400, JSON.stringify(name));
  assert.equal((await drop("pyramid.obj", "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")).status, 200);
  assert.equal((await ask(lab, { scene: "pyramid.obj", words: ["--size", "96x54"] })).scene.name, "pyramid");
  assert.equal((await drop("broken.obj", "v 1 2\nf 1 1 1\n")).status, 200);
  assert.match((await ask(lab, { scene: "broken.obj", words: [] })).error, /broken\.obj/);
  // What a scene names lies beside it, or is not read.
  for (const uri of ["/etc/passwd", "../../../../etc/passwd", "..%2f..%2f..%2f..%2fetc%2fpasswd"]) {
    const scene = {
      asset: { version: "2.0" },
      buffers: [{ uri, byteLength: 36 }],
      bufferViews: [{ buffer: 0, byteLength: 36 }],
      scenes: [{ nodes: [0] }],
      nodes: [{ mesh: 0 }],
      accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3", min: [0, 0, 0], max: [1, 1, 1] }],
      meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    };
    assert.equal((await drop("outside.gltf", JSON.stringify(scene))).status, 200);
    const { error } = await ask(lab, { scene: "outside.gltf", words: [] });
    assert.match(error ?? "it was read", /outside|cannot|no such/i, uri);
  }
  await ask(lab, { scene: "acne-floor", words: ["--size", "96x54"] });
  await isAlive();
}

async function isNotHeldUp() {
  assert.equal(status(await request(`/${token}/file?name=a.obj`, { method: "POST", headers: [`Content-Length: ${1 << 30}`] })), 413);
  assert.ok([400, 413, 414, 431, 0].includes(status(await request(`/${"a".repeat(100000)}`))));
  assert.ok([400, 404, 413, 431, 0].includes(status(await request(`/${token}/`, { headers: [`X: ${"a".repeat(100000)}`] }))));
  for (const text of [
    "\r\n\r\n",
    "GET\r\n\r\n",
    "\0\0\0\0",
    "GET / HTTP/9.9\r\n\r\n",
    "\x16\x03\x01\x02\x00\x01\x00",
    `GET /${token}/ HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n`,
  ])
    await raw(text);
  // Clients that say no more are left after a while, and others are answered before.
  let closed = 0;
  const slow = Array.from(
    { length: 20 },
    () =>
      new Promise((done) => {
        const socket = connect(Number(port), hostname, () => socket.write(`GET /${token}/ HT`));
        socket.on("error", () => undefined);
        socket.on("close", () => {
          ++closed;
          done();
        });
      }),
  );
  await isAlive();
  assert.ok(closed < slow.length, "the page came before the slow ones were left");
  await Promise.all(slow);
  // Many pages at once: all are answered, if only with words.
  const many = await Promise.all(Array.from({ length: 12 }, () => fetch(`${lab.url}news?after=${Number.MAX_SAFE_INTEGER}`)));
  assert.ok(many.every(({ status: code }) => code === 200 || code === 503) && many.some(({ status: code }) => code === 503));
  await isAlive();
}

function saysWhyItCannotListen() {
  const taken = spawnSync(program, ["serve", "acne-floor", "--port", port], { encoding: "utf8", timeout: 60000 });
  assert.equal(taken.status, 5, taken.stderr);
  assert.match(taken.stderr, /--port: nothing can listen at 127\.0\.0\.1:\d+/);
  assert.equal(spawnSync(program, ["serve", "acne-floor", "--port", "70000"]).status, 2);
  assert.equal(spawnSync(program, ["serve", "nowhere.json"]).status, 3);
}

// As in a container, whose page is looked at from outside, by whatever name leads there.
async function listensWhereItIsTold() {
  const open = await serve("acne-floor", "--size", "8x8", "--listen", "0.0.0.0");
  const { hostname: name, port: at, pathname: path } = new URL(open.url);
  assert.equal(name, "localhost");
  assert.equal((await fetch(open.url)).status, 200);
  const named = await new Promise((done) => {
    const socket = connect(Number(at), "127.0.0.1", () =>
      socket.write(`GET ${path} HTTP/1.1\r\nHost: lab.example:80\r\nConnection: close\r\n\r\n`),
    );
    socket.once("data", (part) => {
      done(status(String(part)));
      socket.destroy();
    });
  });
  assert.equal(named, 200);
  assert.equal((await fetch(`http://127.0.0.1:${at}/`)).status, 404, "the key is needed there, too");
  assert.equal(await open.stop(), 130);
}

async function leavesNothingBehind() {
  writeFileSync(join(folder, "kept"), "");
  assert.equal(await lab.stop(), 130);
  assert.deepEqual(readdirSync(folder), ["kept"]);
}

await answersWhatItsCommandMakes();
await refusesWhatIsNoState();
await letsNobodyInWhoDoesNotKnowTheAddress();
await answersNoOtherPage();
await takesFilesForWhatTheyAre();
await isNotHeldUp();
saysWhyItCannotListen();
await listensWhereItIsTold();
await leavesNothingBehind();
execFileSync(program, ["serve", "--help"]);
console.log("served");
