/** A part of the page that can be folded away; what is folded costs nothing. */

import { make } from "../page/element";
import type { Now, Part } from "./store";

export interface Fold extends Part {
  readonly element: HTMLDetailsElement;
}

/** A title that opens and closes what is below it. */
export function section(title: string, parts: readonly Part[], open = false): Fold {
  const element = make("details", { class: "section", open },
    make("summary", {}, make("h2", {}, title)),
    make("div", { class: "body" }, ...parts.map((part) => part.element)),
  );
  let last: Now | undefined;
  const tell = (): void => {
    if (element.open && last) for (const part of parts) part.show(last);
  };
  element.addEventListener("toggle", tell);
  return {
    element,
    show(now) {
      last = now;
      tell();
    },
  };
}

/** Words that never change. */
export const words = (text: string, kind = "note"): Part => ({
  element: make("p", { class: kind }, text),
  show: () => {},
});
