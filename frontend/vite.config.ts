/** What the Python package carries: pages that are one file each, and modules loaded on demand. */

import { readFileSync } from "node:fs";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { type BuildEnvironmentOptions, defineConfig, type Plugin } from "vite";

const inFolder = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** Puts styles and scripts of a page into the page: scripts last, so that it is painted before they are read. */
function insidePage(): Plugin {
  return {
    name: "inside-page",
    enforce: "post",
    generateBundle(_, bundle) {
      const used = new Set<string>();
      const content = (link: string): string => {
        const name = link.replace(/^[./]+/, "");
        const file = bundle[name];
        if (!file) throw new Error(`The page links ${link}, which was not built.`);
        used.add(name);
        return file.type === "chunk" ? file.code : String(file.source);
      };
      for (const page of Object.values(bundle)) {
        if (page.type !== "asset" || !page.fileName.endsWith(".html")) continue;
        let scripts = "";
        const read = String(page.source)
          .replace(/\s*<script type="module"[^>]*src="([^"]+)"[^>]*><\/script>/g, (_, link: string) => {
            scripts += `<script type="module">${content(link).replaceAll("</script", "<\\/script")}</script>\n  `;
            return "";
          })
          .replace(/<link rel="stylesheet"[^>]*href="([^"]+)"[^>]*>/g, (_, link: string) =>
            `<style>${content(link)}</style>`);
        const end = read.lastIndexOf("</body>");
        page.source = `${read.slice(0, end)}  ${scripts}${read.slice(end)}`;
      }
      for (const name of used) delete bundle[name];
    },
  };
}

/** In no page: those that show mannequins hold it as text, built by itself. */
const MANNEQUIN = /mannequin\/mannequin$/;

/** What `vite build --mode NAME` makes: a page, or a module of its own. */
const PAGES: Record<string, string> = {
  player: "src/player/player.html",
  interactive: "src/explorer/interactive.html",
  experiment: "src/experiment/experiment.html",
};
const MODULES: Record<string, string> = {
  mannequin: "src/mannequin/mannequin.ts",
  widget: "src/widget/widget.ts",
};

const PLUGIN = "plugin-walker";

/** Puts jsPsych beside the plugin: its script, its style without fonts, and the licences of all. */
function withJsPsych(): Plugin {
  const read = (path: string): string => readFileSync(inFolder(`node_modules/${path}`), "utf8");
  return {
    name: "with-jspsych",
    generateBundle() {
      const { version } = JSON.parse(read("jspsych/package.json")) as { version: string };
      const about = `/*! jsPsych ${version}, MIT licence: see licences.txt */\n`;
      const emit = (fileName: string, source: string): unknown => this.emitFile({ type: "asset", fileName, source });
      emit("jspsych.js", about + read("jspsych/dist/index.browser.min.js").replace(/\/\/# sourceMappingURL=.*\s*$/, ""));
      emit("jspsych.css", about + read("jspsych/css/jspsych.css").replace(/@font-face\s*{[^}]*}/g, ""));
      const seedrandom = read("seedrandom/README.md");
      const licences = {
        "plugin-walker": readFileSync(inFolder("plugin-walker/LICENSE"), "utf8"),
        jsPsych: readFileSync(inFolder("jspsych-licence.txt"), "utf8"),
        "auto-bind": read("auto-bind/license"),
        "random-words": read("random-words/LICENSE"),
        seedrandom: seedrandom.slice(seedrandom.indexOf("LICENSE (MIT)")),
        "three.js, in mannequin.js": read("three/LICENSE"),
      };
      const texts = Object.entries(licences).map(([name, text]) => `${name}\n\n${text.trim()}\n`);
      emit("licences.txt", `jspsych.js and jspsych.css are jsPsych ${version} with what it includes.\n\n${texts.join("\n\n")}`);
    },
  };
}

const shared: BuildEnvironmentOptions = {
  outDir: inFolder("../src/eigenwalker/stimulus/built"),
  emptyOutDir: false,
  target: "es2022",
  modulePreload: false,
};

export default defineConfig(({ mode }) => {
  const page = PAGES[mode];
  if (page !== undefined) {
    return {
      root: inFolder(dirname(page)),
      base: "./",
      build: { ...shared, rolldownOptions: { input: inFolder(page), external: MANNEQUIN } },
      plugins: [insidePage()],
    };
  }
  if (mode === PLUGIN) {
    const lib = {
      entry: inFolder(`${PLUGIN}/src/index.ts`),
      name: "jsPsychWalker",
      formats: ["iife" as const],
      fileName: () => `${PLUGIN}.js`,
    };
    const output = { minify: true, globals: { jspsych: "jsPsychModule" }, paths: (name: string) => (name === "jspsych" ? name : "./mannequin.js") };
    const external = ["jspsych", /mannequin\/mannequin$/];
    return { publicDir: false, build: { ...shared, lib, rolldownOptions: { external, output } }, plugins: [withJsPsych()] };
  }
  const entry = MODULES[mode];
  if (entry === undefined) throw new Error(`There is nothing called ${mode} to build.`);
  const lib = { entry: inFolder(entry), formats: ["es" as const], fileName: () => `${mode}.js` };
  return { publicDir: false, build: { ...shared, lib, rolldownOptions: { output: { codeSplitting: false, minify: true } } } };
});
