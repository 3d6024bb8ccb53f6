/** Sliders of the traits: the first one large below the stage, the others beside it. */

import type { Model, Trait } from "../model/model";
import { positionsInCloud } from "../model/place";
import { RANGES } from "../model/state";
import { make } from "./element";
import { ridge } from "./ridge";
import type { Now, Part, Session } from "./session";
import { signed, slider, type Slider } from "./slider";
import { capital, ends, mainTrait } from "./words";

/** Places of the scale below the large slider, evenly apart. */
const SCALE = [-6, -4.5, -3, 0, 3, 4.5, 6];

/** The large slider, with the people there are as hills behind its track. */
export function mainSlider(session: Session): Part {
  const trait = mainTrait(session.model);
  const element = make("div", { class: "hero" });
  if (!trait) return { element, show: () => {} };
  const one = traitSlider(session, trait);
  one.element.classList.add("large", "fresh");
  one.input.addEventListener("input", () => one.element.classList.remove("fresh"));
  const far = (): HTMLElement => make("span", { class: "beyond" }, "beyond anyone");
  const scale = make("div", { class: "scale", "aria-hidden": "true" },
    ...SCALE.map((mark) => (Math.abs(mark) === 4.5 ? far() : make("span", {}, signed(mark, 0)))),
  );
  one.element.append(make("div", { class: "hill" }, ridge(session.model, trait)), scale);
  element.append(one.element);
  return { element, show: ({ state }) => one.show(state.traits[trait.name] ?? 0) };
}

/** Sliders of all traits but the first. */
export function otherTraits(session: Session): Part {
  const main = mainTrait(session.model);
  const others = session.model.traits.filter((trait) => trait !== main);
  const sliders = others.map((trait) => traitSlider(session, trait));
  return {
    element: make("div", { class: "sliders" }, ...sliders.map(({ element }) => element)),
    show: ({ state }: Now) =>
      sliders.forEach((one, i) => one.show(state.traits[others[i]!.name] ?? 0)),
  };
}

function traitSlider(session: Session, trait: Trait): Slider {
  const [min, max] = RANGES.trait;
  return slider({
    label: capital(trait.label),
    ends: ends(trait),
    min,
    max,
    step: 0.05,
    usual: 0,
    real: realRange(session.model, trait),
    said: (value) => (value === 0 ? "0" : `${signed(value)} SD`),
    onInput: (value) =>
      session.change({ traits: { ...session.state.traits, [trait.name]: value } }),
  });
}

/** From the least to the greatest of the population. */
export function realRange(model: Model, trait: Trait): readonly [number, number] | undefined {
  const positions = positionsInCloud(model, trait);
  if (positions.length === 0) return undefined;
  return [Math.min(...positions), Math.max(...positions)];
}
