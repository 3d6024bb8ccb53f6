/** Controls for a choice: radio buttons, a switch, a list. */

import { freshId, make } from "../page/elements";

export interface Option<Value> {
  readonly value: Value;
  readonly label: string;
  /** A tooltip. */
  readonly hint?: string;
}

export interface Control<Value, Kind extends HTMLElement = HTMLElement> {
  readonly element: Kind;
  show(value: Value): void;
}

/** A row of radio buttons with a name, which can be hidden from view. */
export function choice<Value>(
  name: string,
  options: readonly Option<Value>[],
  onChoose: (value: Value) => void,
  { named = true } = {},
): Control<Value> {
  const group = freshId();
  const inputs = options.map(({ value }) => {
    const input = make("input", { type: "radio", name: group });
    input.addEventListener("change", () => onChoose(value));
    return input;
  });
  const labels = options.map(({ label, hint }, i) =>
    make("label", { title: hint }, inputs[i]!, make("span", {}, label)),
  );
  const element = make("fieldset", { class: "choice" },
    make("legend", { class: named ? undefined : "unseen" }, name),
    make("div", { class: "row" }, ...labels),
  );
  const show = (value: Value): void =>
    inputs.forEach((input, i) => (input.checked = options[i]!.value === value));
  return { element, show };
}

/** A checkbox that looks like a switch. */
export function toggle(label: string, onChange: (on: boolean) => void, hint?: string): Control<boolean> {
  const input = make("input", { type: "checkbox", role: "switch" });
  input.addEventListener("change", () => onChange(input.checked));
  const element = make("label", { class: "switch", title: hint }, input, make("span", {}, label));
  return { element, show: (on) => void (input.checked = on) };
}

/** A list to select from. */
export function pick<Value>(
  name: string,
  options: readonly Option<Value>[],
  onChoose: (value: Value) => void,
): Control<Value, HTMLDivElement> {
  const id = freshId();
  const select = make("select", { id }, ...options.map(({ label }, i) => make("option", { value: i }, label)));
  select.addEventListener("change", () => onChoose(options[Number(select.value)]!.value));
  const element = make("div", { class: "pick" }, make("label", { for: id }, name), select);
  const show = (value: Value): void => {
    select.selectedIndex = options.findIndex((option) => option.value === value);
  };
  return { element, show };
}
