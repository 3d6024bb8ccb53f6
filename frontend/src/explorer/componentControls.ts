/** Moler's controls: the strength of each component, each component alone, and the bias towards a class. */

import { capitalised, endLabels } from "../model/labels";
import { componentName } from "../model/captions";
import { RANGES } from "../model/state";
import { button, signed } from "../page/elements";
import { bound, group, note } from "./parts";
import { slider } from "./controls";
import type { Part, Store } from "./store";
import { leaveMeans } from "./traitSliders";

export function strengthControls(store: Store): Part {
  const [min, max] = RANGES.strength;
  const strengths = (): readonly number[] => store.state.strengths;
  const rows = store.model.harmonics.map((_, number) => {
    const label = capitalised(componentName(number));
    const one = slider({
      label, min, max, step: 0.05, initial: 1,
      format: (value) => `\u00d7 ${value.toFixed(2).replace("-", "\u2212")}`,
      onInput: (value) => store.change({ strengths: strengths().with(number, value) }),
    });
    const alone = button("alone", () => {
      const already = isAlone(strengths(), number);
      store.change({ strengths: strengths().map((_, i) => Number(already || i === number)) });
    }, { class: "small", "aria-label": `${label} alone` });
    one.element.classList.add("solo");
    one.element.querySelector("output")?.after(alone);
    const show = (strengths: readonly number[]): void => {
      one.show(strengths[number] ?? 1);
      alone.setAttribute("aria-pressed", String(isAlone(strengths, number)));
    };
    return bound({ element: one.element, show }, (state) => state.strengths);
  });
  return group({ class: "sliders" }, ...rows);
}

const isAlone = (strengths: readonly number[], number: number): boolean =>
  strengths.every((strength, i) => strength === Number(i === number));

/** A slider of the bias for each trait of two classes. */
export function biasControls(store: Store): Part {
  const [min, max] = RANGES.bias;
  const rows = store.model.traits.filter(({ means }) => means !== null).flatMap((trait) => {
    const means = `the mean ${endLabels(trait).join(" and the mean ")}`;
    const one = slider({
      label: `Bias of ${trait.label}`,
      ends: endLabels(trait),
      min, max, step: 0.05, initial: 0,
      people: [-1, 1],
      format: (value) => signed(value),
      onInput: (steps) =>
        store.change({ bias: steps === 0 ? null : { trait: trait.name, steps }, ...leaveMeans(store) }),
    });
    return [
      note(`Bias: 0 is as it is, \u00b11 half the way between ${means}.`),
      bound(one, ({ bias }) => (bias?.trait === trait.name ? bias.steps : 0)),
    ];
  });
  return group({ class: "sliders" }, ...rows);
}
