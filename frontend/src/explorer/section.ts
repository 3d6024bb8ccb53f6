/** A part of the page that can be folded; folded parts are not updated. */

import { make } from "../page/elements";
import type { Now, Part } from "./store";

export interface Section extends Part {
  readonly element: HTMLDetailsElement;
}

/** A title that opens and closes the parts below it. */
export function section(title: string, parts: readonly (Part | HTMLElement)[], open = false): Section {
  const views = parts.filter((part) => "show" in part);
  const elements = parts.map((part) => ("show" in part ? part.element : part));
  const element = make("details", { class: "section", open },
    make("summary", {}, make("h2", {}, title)),
    make("div", { class: "body" }, ...elements),
  );
  let last: Now | undefined;
  const update = (): void => {
    if (element.open && last) for (const view of views) view.show(last);
  };
  element.addEventListener("toggle", update);
  return {
    element,
    show(now) {
      last = now;
      update();
    },
  };
}

/** A text that never changes. */
export const note = (text: string): HTMLElement => make("p", { class: "note" }, text);
