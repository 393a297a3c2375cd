// The site that `gnomon site` writes with the built program for the web, once for all tests that look at it.
// Usage: web_site.mjs GNOMON FOLDER. Exit code 77 where the program for the web has not been built.
import { execFileSync } from "node:child_process";
import { rmSync } from "node:fs";
import { app, isBuilt, skip } from "./program_in_browser.mjs";

const [native, folder] = process.argv.slice(2);
if (!isBuilt) skip("the program for the web is not here (./gnomon web builds it)");
rmSync(folder, { recursive: true, force: true });
execFileSync(native, ["site", "-o", folder, "--web", app, "--quiet"], { stdio: "inherit" });
process.exit(0); // the browser that comes along
