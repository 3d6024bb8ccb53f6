/** The plugin as a module, and as a script that sets `jsPsychWalker`. */

import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

export default defineConfig({
  root: fileURLToPath(new URL(".", import.meta.url)),
  build: {
    target: "es2022",
    lib: {
      entry: "src/index.ts",
      name: "jsPsychWalker",
      formats: ["es", "iife"],
      fileName: (format) => (format === "es" ? "index.js" : "index.browser.js"),
    },
    rolldownOptions: {
      external: ["jspsych"],
      output: { globals: { jspsych: "jsPsychModule" } },
    },
  },
});
