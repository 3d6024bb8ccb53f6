/** Parts of the page: sections that fold, groups of parts, controls that follow the state, texts. */

import type { State } from "../model/state";
import { make } from "../page/elements";
import type { Control } from "./controls";
import type { Now, Part } from "./store";

type Member = Part | HTMLElement;

/** An element around parts; showing it shows all of them. */
export function group(attributes: Readonly<Record<string, string>>, ...members: readonly Member[]): Part {
  const parts = members.filter((member) => "show" in member);
  const elements = members.map((member) => ("show" in member ? member.element : member));
  return {
    element: make("div", attributes, ...elements),
    show: (now) => parts.forEach((part) => part.show(now)),
  };
}

/** A control with a value from the state. */
export const bound = <Value>({ element, show }: Control<Value>, value: (state: State) => Value): Part => ({
  element,
  show: ({ state }) => show(value(state)),
});

/** A title that opens and closes the parts below it; closed parts are not updated. */
export function section(title: string, members: readonly Member[], open = false): Part {
  const body = group({ class: "body" }, ...members);
  const element = make("details", { class: "section", open }, make("summary", {}, make("h2", {}, title)), body.element);
  let last: Now | undefined;
  const update = (): void => {
    if (element.open && last) body.show(last);
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

export const note = (text: string): HTMLElement => make("p", { class: "note" }, text);
