/** The buttons of the page: open, undo, reset, the whole screen, dark or light. */

import { button, find, icon, make, type Icon } from "../page/elements";
import { paletteOf } from "../viewer/drawing";
import type { Part, Store, View } from "./store";

/** `open` lets the visitor choose files. */
export function toolbar(store: Store, open: () => void): View {
  const undo = iconButton("undo", "Undo", () => store.undo());
  const theme = themeButton(store);
  const reset = iconButton("back", "Reset all", () => store.reset());
  const row = make("div", { class: "row" }, iconButton("open", "Open a file", open), undo, reset, wholeScreen(), theme.element);
  find("#toolbar", HTMLDivElement).replaceChildren(row);
  return {
    show(now) {
      undo.disabled = !store.canUndo;
      theme.show(now);
    },
  };
}

const iconButton = (name: Icon, label: string, onClick: () => void): HTMLButtonElement =>
  button(icon(name), onClick, { class: "quiet", "aria-label": label, title: label });

/** Shows the viewer on the whole screen, until Escape; hidden where the browser cannot (an iPhone's). */
function wholeScreen(): HTMLButtonElement {
  const element = iconButton("whole", "Whole screen", () => void find("#viewer", HTMLDivElement).requestFullscreen());
  element.hidden = !document.fullscreenEnabled;
  return element;
}

/** Switches between dark and light, for the page and the address bar of a phone. */
function themeButton(store: Store): Part {
  const element = iconButton("sun", "Light page", () => store.change({ dark: !store.state.dark }));
  let shown: boolean | undefined;
  return {
    element,
    show({ state: { dark } }) {
      if (dark === shown) return;
      shown = dark;
      document.documentElement.dataset["theme"] = dark ? "dark" : "light";
      find('meta[name="theme-color"]', HTMLMetaElement).content = paletteOf(dark).background;
      element.replaceChildren(icon(dark ? "sun" : "moon"));
      element.title = dark ? "Light page" : "Dark page";
      element.setAttribute("aria-label", element.title);
    },
  };
}
