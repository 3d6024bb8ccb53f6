/** Below the walker: sliders of the traits, a button that pauses it, and one that resets it. */

import { endLabels } from "../model/axisLabels";
import type { Model, Trait } from "../model/model";
import { RANGES, type State } from "../model/state";
import { button, make, signed } from "../page/elements";

export interface Controls {
  readonly element: HTMLElement;
  show(state: State): void;
}

type Change = (part: Record<string, unknown>) => void;

const MAX_SLIDERS = 8;

export function controlsOf(model: Model, change: Change): Controls {
  let shown: State | null = null;
  const sliders = model.traits.slice(0, MAX_SLIDERS).map((trait) =>
    traitSlider(trait, (alpha) => change({ alpha: { ...shown?.traits, [trait.name]: alpha } })),
  );
  const play = button("Pause", () => change({ playing: !shown?.playing }));
  const back = button("Back to average", () =>
    change({ alpha: {}, bias: null, strengths: [], eigenwalkers: [], start: "average" }),
  );
  const bar = make("div", { class: "bar" }, play, ...(model.traits.length > 0 ? [back] : []));
  return {
    element: make("div", { class: "controls" }, ...sliders.map(({ element }) => element), bar),
    show(state) {
      shown = state;
      play.textContent = state.playing ? "Pause" : "Play";
      for (const slider of sliders) slider.show(state);
    },
  };
}

/** From one end of a trait to the other; a double click sets it to 0. */
function traitSlider(trait: Trait, onInput: (alpha: number) => void): Controls {
  const { name } = trait;
  const [left, right] = endLabels(trait);
  const [min, max] = RANGES.trait;
  const label = `${name}: from ${left} to ${right}`;
  const input = make("input", { type: "range", min, max, step: 0.1, value: 0, "aria-label": label });
  const number = make("output");
  input.addEventListener("input", () => onInput(Number(input.value)));
  input.addEventListener("dblclick", () => onInput(0));
  return {
    element: make("label", {}, make("span", {}, left), input, make("span", {}, right), number),
    show({ traits }) {
      const alpha = traits[name] ?? 0;
      if (Number(input.value) !== alpha) input.value = String(alpha);
      input.style.setProperty("--now", String((Number(input.value) - min) / (max - min)));
      input.classList.toggle("below", alpha < 0);
      number.textContent = signed(alpha);
      input.setAttribute("aria-valuetext", `${number.textContent} standard deviations`);
    },
  };
}
