// What the package's functions take, as TypeScript declarations, from the manual's chapter "options". What they give:
// report/page/schema_types.mjs.
import { comment } from "../../../report/page/schema_types.mjs";

const own = new Set(["output", "json", "aov", "quiet", "verbose", "trace", "help", "suite", "list"]); // what index.mjs asks for itself
const key = (name) => name.replaceAll("-", "_");

/** The entries of a Markdown list of options: {name, value, text}. `- \`-o, --output DIR\`: folder ...` */
function entriesOf(section) {
  const items = section.replace(/\n {2,}/g, " ").matchAll(/^- `([^`]+)`: (.*)$/gm);
  return [...items]
    .map(([, spelt, text]) => {
      const [, name, value = ""] = /^(?:-\w, ?)?--([\w-]+) ?(.*)$/.exec(spelt) ?? [];
      return { name, value, text };
    })
    .filter(({ name }) => name);
}

/** An option's type, from what stands for its value and from its brackets: `NAME`, "[hard or pcf; default hard]". */
function optionType({ value, text }) {
  if (value === "") return "boolean";
  const choices = /\[([a-z0-9-]+(?: or [a-z0-9-]+)+)[;\]]/
    .exec(text)?.[1]
    .split(" or ")
    .map((word) => JSON.stringify(word))
    .join(" | ");
  if (choices) return choices;
  if (value === "on|off") return '"on" | "off"';
  return /^(N|NUMBER)$/.test(value) ? "number" : "number | string | readonly (number | string)[]";
}

/** `manual`: the chapter; returns an interface of one command's options. */
export function optionTypes(manual, command, name) {
  const sections = Object.fromEntries(
    manual
      .split(/^## /m)
      .slice(1)
      .map((part) => [part.slice(0, part.indexOf("\n")), part]),
  );
  const section = sections[`gnomon ${command}`],
    shared = entriesOf(sections["Shared options"]);
  const named = new Set(
    [...(/\[Shared\]\(#shared-options\):([^]*?)\n\n/.exec(`${section}\n\n`)?.[1] ?? "").matchAll(/--([\w-]+)/g)].map(([, word]) => word),
  );
  const options = [...entriesOf(section), ...shared.filter((entry) => named.has(entry.name))].filter((entry) => !own.has(entry.name));
  if (options.length === 0) throw new Error(`the manual says no options of gnomon ${command}`);
  const lines = options.map((entry) => `${comment(entry.text, "  ")}  ${key(entry.name)}?: ${optionType(entry)};\n`);
  return `/** Options of \`gnomon ${command}\`, with _ for -. */\nexport interface ${name} {\n${lines.join("")}}\n`;
}
