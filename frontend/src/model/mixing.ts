/** From the state of a page to the feature vector of its walker, as in Python's `explorer/mixing.py`. */

import { entry } from "../core/schema";
import { blockOf, columnsOf } from "./features";
import type { Model, Numbers, OwnWalker, Trait } from "./model";
import type { State } from "./state";

/**
 * The feature vector of the present walker: eq. 13 of Troje (2002) from any walker, with Moler's bias,
 * eigenwalkers added, and each component at its strength.
 */
export function mixedVector(model: Model, state: State, own: OwnWalker | null = null): Float64Array {
  const vector = Float64Array.from(startVector(model, state, own));
  for (const [name, steps] of Object.entries(state.traits)) addTrait(vector, model, state, traitOf(model, name), steps);
  if (state.bias) addBias(vector, traitOf(model, state.bias.trait), state.bias.steps);
  state.eigenwalkers.forEach((steps, i) => {
    if (steps !== 0) model.eigenwalkers[i]?.vector.forEach((by, column) => (vector[column]! += steps * by));
  });
  state.strengths.forEach((strength, i) => {
    const [start, end] = (strength !== 1 && blockOf(model, `p${i + 1}`)) || [0, 0];
    for (let column = start; column < end; column++) vector[column]! *= strength;
  });
  return vector;
}

export const traitOf = (model: Model, name: string): Trait | undefined =>
  model.traits.find((trait) => trait.name === name);

/** Parts of the features for which all traits have a direction. */
export function partsOf(model: Model): string[] {
  const [first, ...others] = model.traits;
  const parts = Object.keys(first?.steps.discriminant ?? {});
  return parts.filter((part) => others.every(({ steps }) => Object.hasOwn(steps.discriminant, part)));
}

export function startVector(model: Model, { from }: State, own: OwnWalker | null): Numbers {
  if (from === "own" && own) return model.size_kept ? own.vector : sizeDivided(model, own.vector);
  return (typeof from === "number" ? model.walkers[from]?.vector : undefined) ?? model.average;
}

/** A walker with the size of the average walker: Troje (2002), eq. 12. */
function sizeDivided(model: Model, vector: Numbers): Numbers {
  const product = (a: Numbers): number => columnsOf(model, "p0").reduce((sum, i) => sum + a[i]! * model.average[i]!, 0);
  const size = product(vector) / product(model.average);
  return columnsOf(model, "postures").reduce((all, i) => all.with(i, all[i]! / size), [...vector]);
}

function addTrait(
  vector: Float64Array,
  model: Model,
  { kind, part }: State,
  trait: Trait | undefined,
  steps: number,
): void {
  const step = trait && entry(trait.steps[kind], part);
  if (step && steps !== 0) columnsOf(model, part).forEach((column, i) => (vector[column]! += steps * step[i]!));
}

function addBias(vector: Float64Array, trait: Trait | undefined, steps: number): void {
  if (!trait?.means) return;
  const { negative, positive } = trait.means;
  vector.forEach((_, i) => (vector[i]! += (steps * (positive[i]! - negative[i]!)) / 2));
}
