/** The present picture in one sentence, for screen readers. */

import { endLabels } from "./labels";
import { AVERAGE, comparedTrait, nameOf } from "./figures";
import { traitOf } from "./mixing";
import type { Model, OwnWalker } from "./model";
import { MAX_IN_CROWD, MAX_SIDE_BY_SIDE, TRANSFORM_NAMES, TRANSFORMS, type State } from "./state";

/** Moler's names of the components. */
const COMPONENTS = ["stride", "sway", "hop", "bounce"];

export const componentName = (number: number): string => COMPONENTS[number] ?? `component ${number + 1}`;

export function captionOf(model: Model, state: State, own: OwnWalker | null = null): string {
  const transformed = TRANSFORM_NAMES.filter((name) => name in state.transforms).map((name) => TRANSFORMS[name].caption);
  const parts = [figuresCaption(model, state, own), ...changes(model, state), viewpoint(state), ...transformed];
  return `${parts.join(", ")}.`;
}

function figuresCaption(model: Model, state: State, own: OwnWalker | null): string {
  const trait = comparedTrait(model, state);
  if (state.scene === "four" && trait) {
    return `The mean ${endLabels(trait).join(" and the mean ")}, and both with their difference tripled`;
  }
  if (state.scene === "side") return `${Math.min(state.walkers.length, MAX_SIDE_BY_SIDE)} walkers at one tempo`;
  if (state.scene === "crowd") return `${Math.min(model.walkers.length, MAX_IN_CROWD)} walkers`;
  const name = nameOf(model, state, own);
  return name === AVERAGE ? `The ${name}` : name;
}

function changes(model: Model, { scene, traits, bias, strengths }: State): string[] {
  const towards = (name: string, steps: number, unit: string): string[] => {
    const trait = traitOf(model, name);
    return trait && steps !== 0 ? [`${unit} towards ${endLabels(trait)[Number(steps > 0)]}`] : [];
  };
  const moved = [
    ...Object.entries(traits).flatMap(([name, steps]) => towards(name, steps, `${short(Math.abs(steps))} SD`)),
    ...(bias ? towards(bias.trait, bias.steps, `bias ${short(Math.abs(bias.steps))}`) : []),
  ];
  const components = strengths.flatMap((strength, i) =>
    strength === 1 ? [] : [`${componentName(i)} times ${short(strength)}`],
  );
  return [...(scene === "four" ? [] : moved), ...components];
}

function viewpoint({ azimuth_deg, elevation_deg }: State): string {
  const around = Math.round(azimuth_deg);
  const from = around === 0 ? "the front" : Math.abs(around) === 90 ? "the side" : `${around} degrees`;
  const above = Math.round(elevation_deg);
  return above === 0 ? `from ${from}` : `from ${from}, ${Math.abs(above)} degrees ${above > 0 ? "above" : "below"}`;
}

const short = (value: number): string => String(Math.round(value * 100) / 100);
