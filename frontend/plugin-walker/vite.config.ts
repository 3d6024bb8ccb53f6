/**
 * The plugin as a module, and as a script that sets `jsPsychWalker`; and, with `--mode mannequin`,
 * the module with three.js that both load from beside them for the first mannequin.
 */

import { fileURLToPath } from "node:url";
import { defineConfig, type LibraryOptions } from "vite";

const MANNEQUIN = "mannequin.js";

const plugin: LibraryOptions = {
  entry: "src/index.ts",
  name: "jsPsychWalker",
  formats: ["es", "iife"],
  fileName: (format) => (format === "es" ? "index.js" : "index.browser.js"),
};
const mannequin: LibraryOptions = {
  entry: "../src/mannequin/mannequin.ts",
  formats: ["es"],
  fileName: () => MANNEQUIN,
};

export default defineConfig(({ mode }) => ({
  root: fileURLToPath(new URL(".", import.meta.url)),
  build: {
    target: "es2022",
    emptyOutDir: mode !== "mannequin",
    lib: mode === "mannequin" ? mannequin : plugin,
    rolldownOptions: {
      external: mode === "mannequin" ? [] : ["jspsych", /mannequin\/mannequin$/],
      output: {
        minify: mode === "mannequin",
        globals: { jspsych: "jsPsychModule" },
        paths: (name) => (name === "jspsych" ? name : `./${MANNEQUIN}`),
      },
    },
  },
}));
