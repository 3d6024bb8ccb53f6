/** Eigenwalkers as sliders: what varies most among walkers, whatever it means. */

import { RANGES } from "../model/state";
import { make } from "./element";
import type { Part, Session } from "./session";
import { signed, slider } from "./slider";

export function eigenwalkerSliders(session: Session): Part {
  const [min, max] = RANGES.eigenwalker;
  const { eigenwalkers, cloud } = session.model;
  const sliders = eigenwalkers.map(({ share }, number) => {
    const scores = cloud.scores.map((of) => of[number]!).filter(Number.isFinite);
    return slider({
      label: `Eigenwalker ${number + 1} \u00b7 ${Math.round(100 * share)} % of the variance`,
      min, max, step: 0.05, usual: 0,
      real: scores.length > 0 ? [Math.min(...scores), Math.max(...scores)] : undefined,
      said: (value) => (value === 0 ? "0" : `${signed(value)} SD`),
      onInput: (value) =>
        session.change({
          eigenwalkers: session.state.eigenwalkers.map((old, i) => (i === number ? value : old)),
        }),
    });
  });
  return {
    element: make("div", { class: "sliders" }, ...sliders.map(({ element }) => element)),
    show: ({ state }) => sliders.forEach((one, i) => one.show(state.eigenwalkers[i] ?? 0)),
  };
}
