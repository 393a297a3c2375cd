// Builds page.html with its style and script inline: the one file that the C++ writer fills in (../page.cpp).
import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const folder = fileURLToPath(new URL(".", import.meta.url));

export default defineConfig({
  root: folder,
  logLevel: "warn",
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: { target: "es2022", emptyOutDir: true, rollupOptions: { input: `${folder}page.html` }, modulePreload: false },
});
