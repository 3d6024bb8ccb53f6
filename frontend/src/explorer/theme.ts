/** Dark or light, for the page and its address bar. */

import { paletteOf } from "../viewer/palette";
import { find, icon, make } from "../page/element";
import type { Part, Session } from "./store";

export function theme(session: Session): Part {
  const element = make("button", { type: "button", class: "quiet" });
  element.addEventListener("click", () => session.change({ dark: !session.state.dark }));
  let shown: boolean | undefined;
  return {
    element,
    show({ state: { dark } }) {
      if (dark === shown) return;
      shown = dark;
      const name = dark ? "dark" : "light";
      document.documentElement.dataset["theme"] = name;
      find('meta[name="theme-color"]', HTMLMetaElement).content = paletteOf(dark).background;
      element.replaceChildren(icon(dark ? "sun" : "moon"));
      element.title = dark ? "Light page" : "Dark page";
      element.setAttribute("aria-label", element.title);
    },
  };
}
