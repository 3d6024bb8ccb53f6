/** Sliders of the traits below the walker, a button that stops it, and one that puts all back. */

import type { Model, Trait } from "../model/model";
import { ends } from "../model/axisLabels";
import { RANGES, type State } from "../model/state";

export interface Controls {
  readonly element: HTMLElement;
  show(state: State): void;
}

interface TraitSlider {
  readonly name: string;
  readonly element: HTMLElement;
  show(alpha: number): void;
}

type Change = (part: Record<string, unknown>) => void;

const MOST_SLIDERS = 8;

export function controlsOf(model: Model, change: Change): Controls {
  let shown: State | null = null;
  const sliders = model.traits.slice(0, MOST_SLIDERS).map((trait) =>
    slider(trait, (alpha) => change({ alpha: { ...shown?.traits, [trait.name]: alpha } })),
  );
  const play = button("Pause", () => change({ playing: !shown?.playing }));
  const back = button("Back to average", () =>
    change({ alpha: {}, bias: null, strengths: [], eigenwalkers: [], start: "average" }),
  );
  const bar = document.createElement("div");
  bar.className = "bar";
  bar.append(play, ...(model.traits.length > 0 ? [back] : []));
  const element = document.createElement("div");
  element.className = "controls";
  element.append(...sliders.map((each) => each.element), bar);
  return {
    element,
    show(state) {
      shown = state;
      play.textContent = state.playing ? "Pause" : "Play";
      for (const each of sliders) each.show(state.traits[each.name] ?? 0);
    },
  };
}

function button(words: string, pressed: () => void): HTMLButtonElement {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = words;
  made.addEventListener("click", pressed);
  return made;
}

/** From one pole of a trait to the other; a double click puts it in the middle. */
function slider(
  trait: Trait,
  moved: (alpha: number) => void,
): TraitSlider {
  const { name } = trait;
  const [left, right] = ends(trait);
  const input = document.createElement("input");
  const [low, high] = RANGES.trait;
  Object.assign(input, { type: "range", min: String(low), max: String(high), step: "0.1", value: "0" });
  input.setAttribute("aria-label", `${name}: from ${left} to ${right}`);
  const number = document.createElement("output");
  const [from, to] = [left, right].map((words) => {
    const end = document.createElement("span");
    end.textContent = words;
    return end;
  });
  const element = document.createElement("label");
  element.append(from!, input, to!, number);
  input.addEventListener("input", () => moved(Number(input.value)));
  input.addEventListener("dblclick", () => moved(0));
  return {
    name,
    element,
    show(alpha) {
      if (Number(input.value) !== alpha) input.value = String(alpha);
      input.style.setProperty("--now", String((Number(input.value) - low) / (high - low)));
      input.classList.toggle("below", alpha < 0);
      const said = Math.abs(alpha).toFixed(1);
      number.textContent = said === "0.0" ? "0" : `${alpha < 0 ? "\u2212" : "+"}${said}`;
      input.setAttribute("aria-valuetext", `${number.textContent} standard deviations`);
    },
  };
}
