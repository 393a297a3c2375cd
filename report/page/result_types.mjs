// Writes generated/result.d.ts, the types of result.json, from its schema, which the program prints. GNOMON names the program
// (build/release/app/gnomon).
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { schemaTypes } from "./schema_types.mjs";

const program = process.env.GNOMON ?? fileURLToPath(new URL("../../build/release/app/gnomon", import.meta.url));
const folder = new URL("generated/", import.meta.url),
  file = new URL("result.d.ts", folder);
const schema = JSON.parse(execFileSync(program, ["--manual", "schema"], { encoding: "utf8", maxBuffer: 1 << 24 }));
const types = `// Made by result_types.mjs.\n${schemaTypes(schema, "Result")}`;
mkdirSync(folder, { recursive: true });
if (!existsSync(file) || readFileSync(file, "utf8") !== types) writeFileSync(file, types);
