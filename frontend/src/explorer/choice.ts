/** One of a few: a row of radio buttons; and a switch for what is on or off. */

import { freshId, make } from "../page/element";

export interface Option<Value> {
  readonly value: Value;
  readonly label: string;
  /** A sentence that tells more, shown when the pointer rests. */
  readonly hint?: string;
}

export interface Choice<Value> {
  readonly element: HTMLFieldSetElement;
  show(value: Value): void;
}

/** A row of radio buttons under one name. */
export function choice<Value>(
  name: string,
  options: readonly Option<Value>[],
  onChoose: (value: Value) => void,
  { named = true } = {},
): Choice<Value> {
  const group = freshId();
  const inputs = options.map(() => make("input", { type: "radio", name: group }));
  const labels = options.map(({ label, hint }, i) =>
    make("label", { title: hint }, inputs[i]!, make("span", {}, label)),
  );
  inputs.forEach((input, i) => input.addEventListener("change", () => onChoose(options[i]!.value)));
  const element = make("fieldset", { class: "choice" },
    make("legend", { class: named ? undefined : "unseen" }, name),
    make("div", { class: "row" }, ...labels),
  );
  const show = (value: Value): void =>
    inputs.forEach((input, i) => (input.checked = options[i]!.value === value));
  return { element, show };
}

export interface Switch {
  readonly element: HTMLLabelElement;
  readonly input: HTMLInputElement;
  show(on: boolean): void;
}

/** A box to tick that looks like a switch. */
export function toggle(label: string, onChange: (on: boolean) => void, hint?: string): Switch {
  const input = make("input", { type: "checkbox", role: "switch" });
  input.addEventListener("change", () => onChange(input.checked));
  const element = make("label", { class: "switch", title: hint }, input, make("span", {}, label));
  return { element, input, show: (on) => void (input.checked = on) };
}

/** A button with words on it. */
export function button(label: string, onClick: () => unknown, kind = ""): HTMLButtonElement {
  const element = make("button", { type: "button", class: kind || undefined }, label);
  element.addEventListener("click", onClick);
  return element;
}

/** One of many, by name. */
export interface Pick<Value> {
  readonly element: HTMLDivElement;
  show(value: Value): void;
}

export function pick<Value>(
  name: string,
  options: readonly Option<Value>[],
  onChoose: (value: Value) => void,
): Pick<Value> {
  const id = freshId();
  const select = make("select", { id },
    ...options.map(({ label }, i) => make("option", { value: i }, label)),
  );
  select.addEventListener("change", () => onChoose(options[Number(select.value)]!.value));
  const element = make("div", { class: "pick" }, make("label", { for: id }, name), select);
  const show = (value: Value): void => {
    select.selectedIndex = options.findIndex((option) => option.value === value);
  };
  return { element, show };
}
