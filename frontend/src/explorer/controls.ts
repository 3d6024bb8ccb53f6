/** Controls: radio buttons, a switch, a list, and a slider with named ends. */

import { button, freshId, icon, make } from "../page/elements";

export interface Option<Value> {
  readonly value: Value;
  readonly label: string;
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

/** While dragged, the thumb snaps to the initial value within this share of the track. */
const SNAP = 0.008;

export interface SliderOptions {
  /** The name of the value, visible and for screen readers. */
  readonly label: string;
  /** Names of the two ends; without them the label stands above the track. */
  readonly ends?: readonly [string, string];
  readonly min: number;
  readonly max: number;
  readonly step: number;
  /** The value after a double click. */
  readonly initial: number;
  readonly people?: readonly [number, number] | undefined;
  readonly format: (value: number) => string;
  readonly onInput: (value: number) => void;
}

export interface Slider extends Control<number, HTMLDivElement> {
  readonly input: HTMLInputElement;
}

export function slider(options: SliderOptions): Slider {
  const { label, ends, min, max, step, initial, people, format, onInput } = options;
  const id = freshId();
  const input = make("input", { type: "range", id, min, max, step, value: initial });
  const number = make("output", { for: id, class: "now" });
  const reset = button(icon("back"), () => {
    set(initial);
    input.focus();
  }, { class: "quiet back", title: "Back to where it was" });
  reset.append(make("span", { class: "unseen" }, `Reset ${label}`));
  const share = (value: number): string => String(Math.min(Math.max((value - min) / (max - min), 0), 1));
  const end = (name: string, which: string) => make("span", { class: `end ${which}`, "aria-hidden": "true" }, name);
  const element = make("div", { class: ends ? "slider ended" : "slider" },
    make("label", { for: id }, label),
    number,
    reset,
    ...(ends ? [end(ends[0], "low"), input, end(ends[1], "high")] : [input]),
  );
  element.style.setProperty("--usual", share(initial));
  element.style.setProperty("--from", share(people?.[0] ?? min));
  element.style.setProperty("--to", share(people?.[1] ?? min));
  let value = initial;
  const show = (next: number): void => {
    value = next;
    input.value = String(next);
    number.value = format(next);
    const towards = ends && next !== 0 ? ` towards ${next < 0 ? ends[0] : ends[1]}` : "";
    input.setAttribute("aria-valuetext", format(next) + towards);
    element.style.setProperty("--now", share(next));
    element.classList.toggle("changed", next !== initial);
    element.classList.toggle("below", next < initial);
  };
  const set = (next: number): void => {
    if (next === value) return;
    show(next);
    onInput(next);
  };
  let held = false;
  let before = initial;
  input.addEventListener("pointerdown", () => {
    [held, before] = [true, value];
  });
  input.addEventListener("pointerup", () => (held = false));
  // A finger that scrolls the page, beginning on the slider, changes nothing.
  input.addEventListener("pointercancel", () => {
    held = false;
    set(before);
  });
  input.addEventListener("input", () => {
    const next = Number(input.value);
    set(held && Math.abs(next - initial) < (max - min) * SNAP ? initial : next);
  });
  input.addEventListener("dblclick", () => set(initial));
  show(initial);
  return { element, input, show };
}
