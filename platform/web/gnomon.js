#!/usr/bin/env node
// The program in Node: gnomon.js WORDS runs the command line that the native program takes, over the files of this machine.
import { readdirSync } from "node:fs";
import gnomon from "./gnomon.mjs";

const module = await gnomon({ thisProgram: "gnomon" });
// What the module has of its own, and what is no folder of files, stays its own.
for (const name of readdirSync("/")) {
  if (["dev", "proc", "sys"].includes(name)) continue;
  try {
    module.FS.mkdirTree(`/${name}`);
    module.FS.mount(module.NODEFS, { root: `/${name}` }, `/${name}`);
  } catch {
    /* a file, or not to be read */
  }
}
module.FS.chdir(process.cwd());
process.exitCode = module.callMain(process.argv.slice(2));
