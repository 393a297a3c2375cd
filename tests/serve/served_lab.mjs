// A program that serves the lab, for as long as a test looks at it.
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, rmSync } from "node:fs";
import { resolve } from "node:path";

export const [program, work] = process.argv.slice(2);
export const folder = resolve(work);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

/** Starts `gnomon serve WORDS`; its temporary files lie in the test's folder. */
export async function serve(...words) {
  const child = spawn(program, ["serve", ...words], { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, TMPDIR: folder } });
  let said = "";
  child.stderr.on("data", (part) => {
    said += part;
  });
  const ended = new Promise((done) => child.on("exit", (code) => done(code)));
  let out = "";
  const url = await new Promise((done, fail) => {
    child.stdout.on("data", (part) => {
      out += part;
      if (out.endsWith("\n")) done(out.trim());
    });
    void ended.then((code) => fail(new Error(`it ended with ${code}: ${said}`)));
  });
  return {
    url,
    child,
    ended,
    stop: () => {
      child.kill("SIGINT");
      return ended;
    },
  };
}

export const post = (url, body, headers = {}) =>
  fetch(url, { method: "POST", body: typeof body === "string" ? body : JSON.stringify(body), headers });

/** Asks for a state, and waits until its comparison is there, or why there is none. */
export async function ask(lab, wish) {
  const response = await post(`${lab.url}wish`, { client: "test", ...wish });
  if (!response.ok) return { status: response.status, error: (await response.json()).error };
  const { number } = await response.json();
  for (let after = number - 1; ;) {
    const reading = await (await fetch(`${lab.url}news?after=${after}`)).json();
    if (reading.number < number) continue;
    after = reading.number;
    if (reading.error !== "") return { error: reading.error };
    if (!reading.opening && reading.compared === reading.revision && !reading.preview) return reading;
  }
}

/** result.json of the command that a reading says. */
export const compared = (reading) =>
  JSON.parse(
    execFileSync("sh", ["-c", `${reading.command.replace(/^gnomon/, `'${program}'`)} --json - --quiet --runs 1`], { maxBuffer: 1 << 28 }),
  );
