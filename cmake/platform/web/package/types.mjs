// What the package's functions take and give, as TypeScript declarations, from where the program itself says it: options from the
// manual's chapter "options", results from their JSON schemas.

const own = new Set(["output", "json", "aov", "quiet", "verbose", "trace", "help", "suite", "list"]); // what index.mjs asks for itself
const key = (name) => name.replaceAll("-", "_");
const comment = (text, indent) => (text ? `${indent}/** ${text.replaceAll("*/", "* /")} */\n` : "");

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

const interfaceName = (word, prefix) =>
  prefix +
  word
    .split("_")
    .map((part) => part[0].toUpperCase() + part.slice(1))
    .join("");

function typeOf(schema, prefix, indent) {
  if (schema.$ref) return interfaceName(schema.$ref.split("/").at(-1), prefix);
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.enum) return schema.enum.map((value) => JSON.stringify(value)).join(" | ");
  if (schema.oneOf ?? schema.anyOf) return (schema.oneOf ?? schema.anyOf).map((one) => typeOf(one, prefix, indent)).join(" | ");
  const types = [schema.type ?? "unknown"].flat().map((type) => {
    if (type === "integer") return "number";
    if (type === "array") return `(${typeOf(schema.items ?? {}, prefix, indent)})[]`;
    if (type !== "object") return type;
    const value = typeof schema.additionalProperties === "object" ? schema.additionalProperties : {};
    return schema.properties ? members(schema, prefix, indent) : `Record<string, ${typeOf(value, prefix, indent)}>`;
  });
  return [...new Set(types)].join(" | ");
}

function members(schema, prefix, indent = "") {
  const inner = `${indent}  `,
    required = new Set(schema.required);
  const lines = Object.entries(schema.properties).map(
    ([name, property]) =>
      `${comment(property.description, inner)}${inner}${JSON.stringify(name)}${required.has(name) ? "" : "?"}: ${typeOf(property, prefix, inner)};\n`,
  );
  return `{\n${lines.join("")}${indent}}`;
}

/** An interface of the document, and one or a type of each of its definitions. */
export function schemaTypes(schema, name) {
  const definitions = Object.entries(schema.$defs ?? {}).map(
    ([word, definition]) =>
      `${comment(definition.description, "")}export type ${interfaceName(word, name)} = ${typeOf(definition, name, "")};\n`,
  );
  return `${definitions.join("")}${comment(schema.description, "")}export interface ${name} ${members(schema, name)}\n`;
}
