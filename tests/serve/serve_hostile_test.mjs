// gnomon serve, met by whoever means it no good: a connection has one request, and what stands behind it is never taken for another;
// what can be read in two ways is refused; clients that are slow, with or without the key, keep nobody waiting and do not grow in
// number; many ranges are one page; and a wish that takes minutes, or a file
// that is read for ever, is left when another one comes.
// Usage: node serve_hostile_test.mjs PROGRAM WORK_FOLDER
import assert from "node:assert/strict";
import { mkdirSync, readdirSync, readFileSync, readlinkSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { join } from "node:path";
import { ask, folder, post, serve } from "./served_lab.mjs";

const ordinary = ["--size", "96x54", "--map-size", "64"];
const lab = await serve("acne-floor", ...ordinary);
const { hostname, port, pathname: base } = new URL(lab.url),
  host = `${hostname}:${port}`;
const patience = 30000; // milliseconds, for what takes one or two

const pause = (ms) =>
  new Promise((done) => {
    setTimeout(done, ms);
  });
const statuses = (text) => [...text.matchAll(/HTTP\/1\.1 (\d+)/g)].map(([, code]) => Number(code));
const wish = (client) => JSON.stringify({ client, scene: "acne-floor", words: ["--size", "64x36", "--map-size", "64", "--bias", "0.7"] });
const head = (line, ...headers) => [line, `Host: ${host}`, ...headers, "", ""].join("\r\n");
const smuggled = head(`POST ${base}wish HTTP/1.1`, `Content-Length: ${wish("evil").length}`) + wish("evil");
const news = async () => (await fetch(`${lab.url}news?after=0`, { signal: AbortSignal.timeout(patience) })).json();

/** What comes back for these parts, sent one after the other, until the server closes. */
const answerTo = (...parts) =>
  new Promise((done) => {
    let got = "";
    const socket = connect(Number(port), hostname, async () => {
      for (const [i, part] of parts.entries()) {
        if (i > 0) await pause(300);
        if (socket.destroyed) return;
        socket.write(Buffer.from(part, "latin1"));
      }
    });
    socket.on("data", (data) => {
      got += data.toString("latin1");
    });
    socket.on("error", () => undefined);
    socket.on("close", () => done(got));
  });

async function takesNoBodyForARequest() {
  const foreign = ["Origin: http://evil.example", "Sec-Fetch-Site: cross-site", "Content-Type: text/plain"];
  const refused = [
    ["POST /x HTTP/1.1", ...foreign],
    ["POST /x HTTP/1.1"],
    [`POST ${base}wish HTTP/1.1`, ...foreign],
    [`POST ${base} HTTP/1.1`],
    [`POST ${base}nothing HTTP/1.1`],
    [`PUT ${base}wish HTTP/1.1`],
    [`POST ${base}wish HTTP/1.1`, "Content-Encoding: gzip"],
    [`POST ${base}wish HTTP/1.1`, "Expect: 100-continue"],
    [`GET ${base}wish HTTP/1.1`],
  ];
  for (const [line, ...headers] of refused) {
    const told = (body) => head(line, ...headers, `Content-Length: ${body.length}`);
    for (const parts of [
      [told(smuggled), smuggled],
      [told(smuggled) + smuggled],
      ...[-1, 0, 1].map((off) => {
        const body = "p".repeat(4096 - told(smuggled + "p".repeat(3000)).length + off) + smuggled;
        return [told(body) + body];
      }),
    ]) {
      const codes = statuses(await answerTo(...parts));
      assert.ok(codes.length === 1 && codes[0] >= 400, `${line}: ${codes}`);
    }
  }
  // Nor what stands behind a request that is answered.
  assert.deepEqual(statuses(await answerTo(head(`GET ${base} HTTP/1.1`) + smuggled)), [200]);
  assert.notEqual((await news()).client, "evil");
}

async function refusesWhatCanBeReadInTwoWays() {
  const get = `GET ${base} HTTP/1.1`,
    give = `POST ${base}wish HTTP/1.1`,
    own = wish("evil"),
    length = `Content-Length: ${own.length}`;
  const heads = {
    "two hosts": head(get, "Host: evil.example"),
    "two hosts alike": head(get, `Host: ${host}`),
    "no host": `${get}\r\n\r\n`,
    "a host in two lines": `${get}\r\nHost: ${host}\r\n evil\r\n\r\n`,
    "a host with a user": `${get}\r\nHost: localhost:1@evil.example\r\n\r\n`,
    "two hosts in one": `${get}\r\nHost: localhost, evil.example\r\n\r\n`,
    "two origins": head(get, `Origin: http://${host}`, "Origin: http://evil.example"),
    "two sites": head(get, "Sec-Fetch-Site: none", "Sec-Fetch-Site: cross-site"),
    "a list of sites": head(get, "Sec-Fetch-Site: none, cross-site"),
    "two lengths": head(give, length, "Content-Length: 3") + own,
    "two lengths alike": head(give, length, length) + own,
    "lengths in a list": head(give, `${length}, ${own.length}`) + own,
    "a length and chunks": head(give, length, "Transfer-Encoding: chunked") + own,
    "chunks and a length": head(give, "Transfer-Encoding: chunked", length) + own,
    chunks: head(give, "Transfer-Encoding: chunked") + `${own.length.toString(16)}\r\n${own}\r\n0\r\n\r\n`,
    "unknown coding": head(give, length, "Transfer-Encoding: xchunked") + own,
    "a hex length": head(give, `Content-Length: 0x${own.length.toString(16)}`) + own,
    "a signed length": head(give, `Content-Length: +${own.length}`) + own,
    "a negative length": head(give, "Content-Length: -1") + own,
    "a huge length": head(give, "Content-Length: 99999999999999999999999") + own,
    "an empty length": head(give, "Content-Length:") + own,
    "a length of words": head(give, "Content-Length: ten") + own,
    "lines that end in LF": `${get}\nHost: ${host}\n\n`,
    "one line that ends in LF": `${get}\r\nHost: ${host}\nX: y\r\n\r\n`,
    "a NUL in the path": head(`GET ${base}\0 HTTP/1.1`),
    "a NUL in a header": head(get, "X: a\0b"),
    "a blank before the colon": head(get, "X : y"),
    "a header without a name": head(get, ": y"),
    "a header without a colon": head(get, "Xy"),
    packed: head(give, length, "Content-Encoding: gzip") + own,
    expecting: head(give, length, "Expect: 100-continue") + own,
    "a body to read by": head(get, length) + own,
    "lower case": head(`get ${base} HTTP/1.1`),
    "HTTP/0.9": `GET ${base}\r\n\r\n`,
    "HTTP/2": "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    "HTTP/1.2": head(`GET ${base} HTTP/1.2`),
    blanks: head(`GET  ${base} HTTP/1.1`),
    "another server": head(`GET http://evil.example${base} HTTP/1.1`),
    CONNECT: head(`CONNECT ${host} HTTP/1.1`),
    "a key in other signs": head(`GET /%${base.charCodeAt(1).toString(16)}${base.slice(2)} HTTP/1.1`),
    "more than fits": head(get, `X: ${"a".repeat(40000)}`),
  };
  for (const [what, text] of Object.entries(heads)) {
    const codes = statuses(await answerTo(text + smuggled));
    assert.ok(codes.length <= 1 && codes.every((code) => code >= 400 && code < 500), `${what}: ${codes}`);
  }
  for (const header of ["Upgrade: websocket\r\nConnection: Upgrade", "Connection: keep-alive", "Connection: keep-alive, close"])
    assert.deepEqual(statuses(await answerTo(head(get, header) + smuggled)), [200], header);
  assert.ok(!(await answerTo(head(`GET ${base}picture?name=labels%0d%0aX-Evil:1 HTTP/1.1`))).includes("\r\nX-Evil"));
  assert.equal(
    (await post(`${lab.url}file?name=..%2fx&name=a.obj`, "name=a.obj", { "Content-Type": "application/x-www-form-urlencoded" })).status,
    400,
    "a name stands in the address alone",
  );
  assert.notEqual((await news()).client, "evil");
}

/** Clients that begin with `first` and go on with `more` until they are left; `reads`: what is sent to them. */
function slowOnes(count, first, more, { reads = true, every = 200 } = {}) {
  const sockets = Array.from({ length: count }, () => {
    const socket = connect(Number(port), hostname, () => socket.write(first));
    if (reads) socket.resume();
    const going = more === "" ? undefined : setInterval(() => socket.writable && socket.write(more), every);
    socket.on("error", () => undefined);
    socket.closed_ = new Promise((done) => {
      socket.on("close", () => {
        clearInterval(going);
        done();
      });
    });
    return socket;
  });
  return {
    left: () => Promise.all(sockets.map((socket) => socket.closed_)),
    end: () => {
      for (const socket of sockets) socket.destroy();
    },
  };
}
const sockets = () =>
  readdirSync(`/proc/${lab.child.pid}/fd`).filter((file) => {
    try {
      return readlinkSync(`/proc/${lab.child.pid}/fd/${file}`).startsWith("socket:");
    } catch {
      return false;
    }
  }).length;

async function isAlive(what) {
  for (const asked of ["", "news?after=0", "picture?name=raster"])
    assert.equal((await fetch(lab.url + asked, { signal: AbortSignal.timeout(patience) })).status, 200, `${asked}, while ${what}`);
  assert.equal((await post(`${lab.url}wish`, wish("test"))).status, 200, what);
}

async function isNotHeldBySlowClients() {
  const get = head(`GET ${base} HTTP/1.1`);
  const kinds = {
    "a line comes by letters": ["G", "a"],
    "a header comes by letters": ["GET / HTTP/1.1\r\nX: ", "a"],
    "headers come one by one": [`GET ${base} HTTP/1.1\r\n`, "X: a\r\n"],
    "nothing comes": ["", ""],
    "a body of a stranger comes by letters": [head("POST /x HTTP/1.1", "Content-Length: 100000000"), "a"],
    "chunks of a stranger come": [head("POST /x HTTP/1.1", "Transfer-Encoding: chunked"), "1\r\na\r\n"],
    "a body with the key comes by letters": [head(`POST ${base}file?name=a.obj HTTP/1.1`, "Content-Length: 200000"), "a"],
    "a wish comes by letters": [head(`POST ${base}wish HTTP/1.1`, "Content-Length: 60000"), "a"],
    "one connection asks again and again": [get, get],
    "a stranger asks again and again": [head("GET / HTTP/1.1"), head("GET / HTTP/1.1")],
  };
  const slow = Object.values(kinds).map(([first, more]) => slowOnes(20, first, more));
  for (let i = 0; i < 3; ++i) {
    await pause(700);
    await isAlive("200 slow clients are there");
  }
  for (const [i, what] of Object.keys(kinds).entries()) {
    // though a byte comes five times in a second
    const late = pause(patience * 2).then(() => "late");
    assert.notEqual(await Promise.race([slow[i].left(), late]), "late", `nobody is left: ${what}`);
  }
  const deaf = slowOnes(60, get, "", { reads: false });
  const gone = slowOnes(60, head(`GET ${base}picture?name=raster HTTP/1.1`), "", { reads: false });
  await pause(300);
  await isAlive("nobody reads the answers");
  (deaf.end(), gone.end());
}

async function hasAtMostSoManyConnections() {
  const crowd = [slowOnes(400, "G", ""), slowOnes(200, head(`POST ${base}file?name=a.obj HTTP/1.1`, "Content-Length: 90000000"), "")];
  await pause(1000);
  await isAlive("hundreds wait");
  assert.ok(sockets() <= 400, `${sockets()} of 600 connections are held`);
  for (const part of crowd) part.end();
  await isAlive("they have left");
}

async function sendsAPageOnce() {
  const whole = await (await fetch(lab.url)).text();
  for (const ranges of [
    Array.from({ length: 1300 }, () => "0-").join(","),
    "0-10,5-6,0-0,1-99999999999",
    "-99999999999999999999",
    "99999999999999999999-",
    "10-5",
  ]) {
    const answer = await fetch(lab.url, { headers: { Range: `bytes=${ranges}` } });
    assert.equal(answer.status, 200);
    assert.equal(await answer.text(), whole, ranges.slice(0, 30));
  }
}

async function leavesWhatTakesMinutes() {
  const heavy = [
    "--size",
    "3840x2160",
    "--map-size",
    "4096",
    "--technique",
    "pcss",
    "--blocker-samples",
    "1024",
    "--filter-samples",
    "1024",
    "--light-size",
    "20",
  ];
  const before = await ask(lab, { scene: "acne-floor", words: [...ordinary, "--bias", "0"] });
  for (const ms of [0, 4000]) {
    // before it is begun and while it is drawn
    assert.equal((await post(`${lab.url}wish`, { client: "test", scene: "acne-floor", words: heavy })).status, 200);
    await pause(ms);
    const late = pause(120000).then(() => ({ result: undefined }));
    const after = await Promise.race([ask(lab, { scene: "acne-floor", words: [...ordinary, "--bias", "0"] }), late]);
    assert.deepEqual(after.result?.lights[0].classes, before.result.lights[0].classes, "an ordinary wish after a heavy one");
  }
  for (const words of [
    ["--size", "16384x16384"],
    ["--size", "3840x2161"],
    ["--map-size", "16384"],
    ["--technique", "csm", "--cascades", "4", "--map-size", "8192"],
  ])
    assert.match((await ask(lab, { scene: "acne-floor", words })).error, /the lab draws at most/, words.join(" "));
}

/** A program that reads a dropped file and never ends: what is asked for next ends it. */
async function leavesAFileThatIsReadForEver() {
  const bin = join(folder, "bin"),
    assimp = join(bin, "assimp");
  mkdirSync(bin);
  writeFileSync(assimp, "#!/bin/sh\nsleep 1000\n", { mode: 0o755 });
  const path = process.env.PATH;
  process.env.PATH = `${bin}:${path}`;
  const other = await serve("acne-floor", ...ordinary);
  process.env.PATH = path;
  const isRead = () =>
    readdirSync("/proc").some((pid) => {
      try {
        return /^\d+$/.test(pid) && readFileSync(`/proc/${pid}/cmdline`, "utf8").includes(assimp);
      } catch {
        return false;
      }
    });
  assert.equal((await post(`${other.url}file?name=model.x3d`, "<X3D><Scene/></X3D>")).status, 200);
  assert.equal((await post(`${other.url}wish`, { client: "test", scene: "model.x3d", words: [] })).status, 200);
  while (!isRead()) await pause(50);
  const late = pause(120000).then(() => ({ scene: undefined }));
  const after = await Promise.race([ask(other, { scene: "floating-box", words: ordinary }), late]);
  assert.equal(after.scene?.name, "floating-box");
  assert.ok(!isRead(), "the program has ended");
  assert.equal(await other.stop(), 130);
}

await takesNoBodyForARequest();
await refusesWhatCanBeReadInTwoWays();
await isNotHeldBySlowClients();
await hasAtMostSoManyConnections();
await sendsAPageOnce();
await leavesWhatTakesMinutes();
await leavesAFileThatIsReadForEver();
assert.equal(await lab.stop(), 130);
console.log("nobody gets in, and nobody waits");
process.exit(0);
