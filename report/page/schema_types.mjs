// A JSON schema as TypeScript declarations, of the kind that the program's schemas are: of the report page's document
// (result_types.mjs) and of the npm package for the web.

export const comment = (text, indent) => (text ? `${indent}/** ${text.replaceAll("*/", "* /")} */\n` : "");

const interfaceName = (word, prefix) =>
  prefix +
  word
    .split("_")
    .map((part) => part[0].toUpperCase() + part.slice(1))
    .join("");

/** A tuple where the schema says how many there are. */
function arrayOf({ minItems: count = 0, maxItems }, item) {
  return count > 0 && count <= 4 && count === maxItems ? `[${Array(count).fill(item).join(", ")}]` : `(${item})[]`;
}

function typeOf(schema, prefix, indent) {
  if (schema.$ref) return interfaceName(schema.$ref.split("/").at(-1), prefix);
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.enum) return schema.enum.map((value) => JSON.stringify(value)).join(" | ");
  if (schema.oneOf ?? schema.anyOf) return (schema.oneOf ?? schema.anyOf).map((one) => typeOf(one, prefix, indent)).join(" | ");
  const types = [schema.type ?? "unknown"].flat().map((type) => {
    if (type === "integer") return "number";
    if (type === "array") return arrayOf(schema, typeOf(schema.items ?? {}, prefix, indent));
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
