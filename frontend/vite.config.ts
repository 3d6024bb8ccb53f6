/** The stand-alone page: one file with script and style inside, for the Python package. */

import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";

const inFolder = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** Puts scripts and styles of a page into the page. */
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
        page.source = String(page.source)
          .replace(/<script type="module"[^>]*src="([^"]+)"[^>]*><\/script>/g, (_, link: string) =>
            `<script type="module">${content(link).replaceAll("</script", "<\\/script")}</script>`)
          .replace(/<link rel="stylesheet"[^>]*href="([^"]+)"[^>]*>/g, (_, link: string) =>
            `<style>${content(link)}</style>`);
      }
      for (const name of used) delete bundle[name];
    },
  };
}

export default defineConfig({
  root: inFolder("src/page"),
  base: "./",
  build: {
    outDir: inFolder("../src/eigenwalker/page"),
    emptyOutDir: false,
    target: "es2022",
    modulePreload: false,
    rolldownOptions: { input: inFolder("src/page/player.html") },
  },
  plugins: [insidePage()],
});
