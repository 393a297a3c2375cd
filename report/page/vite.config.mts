// Builds page.html, or with --mode lesson or lab lesson.html or lab.html, with its style and script inline: the files that the C++ writer fills
// in (../shell.cpp).
import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const folder = fileURLToPath(new URL(".", import.meta.url));

export default defineConfig(({ mode }) => ({
  root: folder,
  logLevel: "warn",
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: {
    target: "es2022",
    emptyOutDir: mode === "production",
    modulePreload: false,
    rollupOptions: { input: `${folder}${mode === "production" ? "page" : mode}.html` },
  },
}));
