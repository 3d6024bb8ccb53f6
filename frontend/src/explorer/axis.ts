/** Directions that sliders lead along, and plots lie along: traits, then eigenwalkers. */

import type { Model, Numbers, Trait } from "../model/model";
import { positionsInCloud, type Place } from "../model/position";
import type { State } from "../model/state";
import { capital, ends, mainTrait } from "./labels";

export interface Axis {
  readonly label: string;
  readonly ends: readonly [string, string];
  readonly trait: Trait | null;
  /** Standard deviations at which each point of the cloud lies. */
  readonly points: Numbers;
  /** Standard deviations at which a walker lies. */
  at(place: Place): number;
  /** Where its slider stands. */
  value(state: State): number;
  /** What changes where its slider is moved. */
  moved(state: State, value: number): Partial<State>;
}

/** All of them; the first is the one whose slider is large. */
export function axesOf(model: Model): Axis[] {
  const main = mainTrait(model);
  const traits = [...model.traits].sort((a, b) => Number(b === main) - Number(a === main));
  return [
    ...traits.map((trait) => alongTrait(model, trait)),
    ...model.eigenwalkers.map((_, number) => alongEigenwalker(model, number)),
  ];
}

function alongTrait(model: Model, trait: Trait): Axis {
  const { name, label } = trait;
  return {
    label: capital(label),
    ends: ends(trait),
    trait,
    points: positionsInCloud(model, trait),
    at: ({ positions }) => positions[name] ?? 0,
    value: ({ traits }) => traits[name] ?? 0,
    moved: ({ traits }, value) => ({ traits: { ...traits, [name]: value } }),
  };
}

function alongEigenwalker({ cloud }: Model, number: number): Axis {
  const label = `Eigenwalker ${number + 1}`;
  return {
    label,
    ends: [`\u2212 ${label.toLowerCase()}`, `${label.toLowerCase()} +`],
    trait: null,
    points: cloud.scores.map((scores) => scores[number]!),
    at: ({ scores }) => scores[number]!,
    value: ({ eigenwalkers }) => eigenwalkers[number]!,
    moved: ({ eigenwalkers }, value) => ({
      eigenwalkers: eigenwalkers.map((old, i) => (i === number ? value : old)),
    }),
  };
}

/** From the least to the greatest of the population. */
export function realRange({ points }: Axis): readonly [number, number] | undefined {
  return points.length > 0 ? [Math.min(...points), Math.max(...points)] : undefined;
}
