/** The buttons of the page itself: open, undo, all as it was, dark or light. */

import { find, icon, make, type Icon } from "../page/element";
import type { Session, Shown } from "./store";
import { theme } from "./theme";

/** `open` lets the visitor choose files. */
export function corner(session: Session, open: () => void): Shown {
  const undo = act("undo", "Undo", () => session.undo());
  const switchTheme = theme(session);
  const buttons = [
    act("open", "Open a file", open),
    undo,
    act("back", "Reset all", () => session.reset()),
    switchTheme.element,
  ];
  find("#corner", HTMLDivElement).replaceChildren(make("div", { class: "row" }, ...buttons));
  return {
    show(now) {
      undo.disabled = !session.canUndo;
      switchTheme.show(now);
    },
  };
}

function act(name: Icon, words: string, does: () => void): HTMLButtonElement {
  const button = make("button", { type: "button", class: "quiet", "aria-label": words, title: words }, icon(name));
  button.addEventListener("click", does);
  return button;
}
