/** A slider with named ends, its number, a band where people are, and a reset button. */

import { button, freshId, icon, make } from "../page/elements";
import type { Control } from "./choice";

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
  /** The range of the population. */
  readonly people?: readonly [number, number] | undefined;
  /** The text of a value. */
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
