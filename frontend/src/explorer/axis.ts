/** Directions of sliders and axes of plots: traits, then eigenwalkers. */

import { entry } from "../core/schema";
import { capitalised, endLabels, mainTrait } from "../model/labels";
import type { Model, Numbers, Trait } from "../model/model";
import { cloudPositions, type Position } from "../model/features";
import type { State } from "../model/state";

export interface Axis {
  readonly label: string;
  readonly ends: readonly [string, string];
  readonly trait: Trait | null;
  /** The position of each point of the cloud, in standard deviations. */
  readonly points: Numbers;
  /** The position of a walker, in standard deviations. */
  at(position: Position): number;
  /** The value of its slider. */
  value(state: State): number;
  /** The change of the state when its slider is moved. */
  moved(state: State, value: number): Partial<State>;
}

/** All axes; the first is that of the large slider. */
export function axesOf(model: Model): Axis[] {
  const main = mainTrait(model);
  const traits = model.traits.toSorted((a, b) => Number(b === main) - Number(a === main));
  return [
    ...traits.map((trait) => traitAxis(model, trait)),
    ...model.eigenwalkers.map((_, number) => eigenwalkerAxis(model, number)),
  ];
}

function traitAxis(model: Model, trait: Trait): Axis {
  const { name, label } = trait;
  return {
    label: capitalised(label),
    ends: endLabels(trait),
    trait,
    points: cloudPositions(model, trait),
    at: ({ traits }) => entry(traits, name) ?? 0,
    value: ({ traits }) => entry(traits, name) ?? 0,
    moved: ({ traits }, value) => ({ traits: { ...traits, [name]: value } }),
  };
}

function eigenwalkerAxis({ cloud }: Model, number: number): Axis {
  const label = `Eigenwalker ${number + 1}`;
  return {
    label,
    ends: [`\u2212 ${label.toLowerCase()}`, `${label.toLowerCase()} +`],
    trait: null,
    points: cloud.scores.map((scores) => scores[number]!),
    at: ({ scores }) => scores[number]!,
    value: ({ eigenwalkers }) => eigenwalkers[number]!,
    moved: ({ eigenwalkers }, value) => ({ eigenwalkers: eigenwalkers.with(number, value) }),
  };
}

export function rangeOf({ points }: Axis): readonly [number, number] | undefined {
  return points.length > 0 ? [Math.min(...points), Math.max(...points)] : undefined;
}
