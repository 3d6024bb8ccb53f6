/** Moler's controls: how strong each component is, each alone, and the bias towards a class (M4-M6). */

import { RANGES } from "../model/state";
import { button } from "./choice";
import { make } from "../page/element";
import type { Now, Part, Session } from "./store";
import { signed, slider } from "./slider";
import { leftMeans } from "./traitSliders";
import { ends } from "./labels";

const NAMES = ["Stride", "Sway", "Hop", "Bounce"];

/** One slider a component, and a button that leaves it alone. */
export function strengths(session: Session): Part {
  const [min, max] = RANGES.strength;
  const change = (number: number, value: number): void =>
    session.change({ strengths: session.state.strengths.map((old, i) => (i === number ? value : old)) });
  const alone = (number: number): number[] => session.state.strengths.map((_, i) => Number(i === number));
  const rows = session.model.harmonics.map((_, number) => {
    const label = NAMES[number] ?? `Component ${number + 1}`;
    const one = slider({
      label, min, max, step: 0.05, usual: 1,
      said: (value) => `\u00d7 ${value.toFixed(2).replace("-", "\u2212")}`,
      onInput: (value) => change(number, value),
    });
    const only = button("alone", () => {
      const already = isAlone(session.state.strengths, number);
      session.change({ strengths: already ? session.state.strengths.map(() => 1) : alone(number) });
    }, "small");
    only.setAttribute("aria-label", `${label} alone`);
    one.element.classList.add("solo");
    one.element.querySelector("output")?.after(only);
    return { one, only };
  });
  return {
    element: make("div", { class: "sliders" }, ...rows.map(({ one }) => one.element)),
    show: ({ state }: Now) =>
      rows.forEach(({ one, only }, i) => {
        one.show(state.strengths[i] ?? 1);
        only.setAttribute("aria-pressed", String(isAlone(state.strengths, i)));
      }),
  };
}

const isAlone = (strengths: readonly number[], number: number): boolean =>
  strengths.every((strength, i) => strength === Number(i === number));

/** Half the way from mean to mean, for each trait of two classes; the end on the right is named. */
export function bias(session: Session): Part {
  const [min, max] = RANGES.bias;
  const traits = session.model.traits.filter(({ means }) => means !== null);
  const sliders = traits.map((trait) =>
    slider({
      label: `Bias of ${trait.label}`,
      ends: ends(trait),
      min, max, step: 0.05, usual: 0,
      real: [-1, 1],
      said: (value) => signed(value),
      onInput: (steps) =>
        session.change({ bias: steps === 0 ? null : { trait: trait.name, steps }, ...leftMeans(session) }),
    }),
  );
  const about = traits.map((trait) => {
    const means = `the mean ${ends(trait).join(" and the mean ")}`;
    return make("p", { class: "note" }, `Bias: 0 is as it is, \u00b11 half the way between ${means}.`);
  });
  return {
    element: make("div", { class: "sliders" }, ...sliders.flatMap(({ element }, i) => [about[i]!, element])),
    show: ({ state }) =>
      sliders.forEach((one, i) => one.show(state.bias?.trait === traits[i]!.name ? state.bias.steps : 0)),
  };
}
