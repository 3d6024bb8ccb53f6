/** Serves this folder, so that the plugin's example finds jsPsych. */

import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

export default defineConfig({ root: fileURLToPath(new URL(".", import.meta.url)) });
