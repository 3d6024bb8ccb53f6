/** A slider with named ends, its number, a soft mark where real people lie, and a way back. */

import { freshId, icon, make } from "../page/element";

/** So near, as a share of the track, the usual place catches a thumb that is dragged. */
const CATCH = 0.008;

export interface SliderOptions {
  /** What is set, for the eye and for a screen reader. */
  readonly label: string;
  /** Names of the two ends; without them the label alone stands above the track. */
  readonly ends?: readonly [string, string];
  readonly min: number;
  readonly max: number;
  readonly step: number;
  /** Where a double click puts it. */
  readonly usual: number;
  /** Where real people lie. */
  readonly real?: readonly [number, number] | undefined;
  /** The number in words. */
  readonly said: (value: number) => string;
  readonly onInput: (value: number) => void;
}

export interface Slider {
  readonly element: HTMLDivElement;
  readonly input: HTMLInputElement;
  /** Let it stand at a value. */
  show(value: number): void;
}

/** The value with its sign, as print has it. */
export function signed(value: number, digits = 1): string {
  const size = Math.abs(value).toFixed(digits);
  if (Number(size) === 0) return "0";
  return (value < 0 ? "\u2212" : "+") + size;
}

export function slider(options: SliderOptions): Slider {
  const { label, ends, min, max, step, usual, real, said, onInput } = options;
  const id = freshId();
  const input = make("input", { type: "range", id, min, max, step, value: usual });
  const now = make("output", { for: id, class: "now" });
  const back = make("button", { type: "button", class: "quiet back", title: "Back to where it was" },
    icon("back"),
    make("span", { class: "unseen" }, `Reset ${label}`),
  );
  const share = (value: number): string =>
    String(Math.min(Math.max((value - min) / (max - min), 0), 1));
  const element = make("div", { class: ends ? "slider ended" : "slider" },
    make("label", { for: id }, label),
    now,
    back,
    ...(ends ? [end(ends[0], "low"), input, end(ends[1], "high")] : [input]),
  );
  element.style.setProperty("--usual", share(usual));
  element.style.setProperty("--from", share(real?.[0] ?? min));
  element.style.setProperty("--to", share(real?.[1] ?? min));
  let value = usual;
  const show = (wanted: number): void => {
    value = wanted;
    input.value = String(wanted);
    now.value = said(wanted);
    input.setAttribute("aria-valuetext", inWords(said(wanted), ends, wanted));
    element.style.setProperty("--now", share(wanted));
    element.classList.toggle("changed", wanted !== usual);
    element.classList.toggle("below", wanted < usual);
  };
  const set = (wanted: number): void => {
    if (wanted === value) return;
    show(wanted);
    onInput(wanted);
  };
  let held = false;
  let before = usual;
  input.addEventListener("pointerdown", () => {
    [held, before] = [true, value];
  });
  input.addEventListener("pointerup", () => (held = false));
  // A finger that scrolls the page, and only came down on the slider, moves nothing.
  input.addEventListener("pointercancel", () => {
    held = false;
    set(before);
  });
  input.addEventListener("input", () => {
    const wanted = Number(input.value);
    set(held && Math.abs(wanted - usual) < (max - min) * CATCH ? usual : wanted);
  });
  input.addEventListener("dblclick", () => set(usual));
  back.addEventListener("click", () => {
    set(usual);
    input.focus();
  });
  show(usual);
  return { element, input, show };
}

const end = (name: string, which: string): HTMLSpanElement =>
  make("span", { class: `end ${which}`, "aria-hidden": "true" }, name);

function inWords(said: string, ends: readonly [string, string] | undefined, value: number): string {
  if (!ends || value === 0) return said;
  return `${said} towards ${value < 0 ? ends[0] : ends[1]}`;
}
