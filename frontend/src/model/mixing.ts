/** From what a visitor has chosen to the feature vector of the walker that is made of it. */

import { blockOf, columnsOf } from "./layout";
import type { Model, Numbers, Own, Trait } from "./model";
import type { State } from "./state";

/**
 * The walker now made, as features: eq. 13 of Troje (2002) from any walker (W7), with Moler's bias,
 * eigenwalkers added, and each component as strong as wished.
 */
export function vectorOf(model: Model, state: State, own: Own | null = null): Float64Array {
  const vector = Float64Array.from(startOf(model, state, own));
  for (const [name, steps] of Object.entries(state.traits)) {
    addTrait(vector, model, state, traitOf(model, name), steps);
  }
  if (state.bias) addBias(vector, traitOf(model, state.bias.trait), state.bias.steps);
  state.eigenwalkers.forEach((steps, i) => add(vector, model.eigenwalkers[i]?.vector, steps));
  state.strengths.forEach((strength, i) => strengthen(vector, model, i + 1, strength));
  return vector;
}

export const traitOf = (model: Model, name: string): Trait | undefined =>
  model.traits.find((trait) => trait.name === name);

/** Parts of the features that the classifiers of all traits are there for. */
export function partsOf(model: Model): string[] {
  const [first, ...others] = model.traits;
  const parts = Object.keys(first?.steps.discriminant ?? {});
  return parts.filter((part) => others.every(({ steps }) => Object.hasOwn(steps.discriminant, part)));
}

/** Who is changed. */
export function startOf(model: Model, state: State, own: Own | null): Numbers {
  if (state.from === "own" && own) return own.vector;
  if (typeof state.from === "number") return model.walkers[state.from]?.vector ?? model.average;
  return model.average;
}

function addTrait(
  vector: Float64Array,
  model: Model,
  { kind, part }: State,
  trait: Trait | undefined,
  steps: number,
): void {
  const parts = trait?.steps[kind];
  if (!parts || !Object.hasOwn(parts, part) || steps === 0) return;
  const step = parts[part]!;
  columnsOf(model, part).forEach((column, i) => (vector[column]! += steps * step[i]!));
}

function addBias(vector: Float64Array, trait: Trait | undefined, steps: number): void {
  if (!trait?.means) return;
  const { negative, positive } = trait.means;
  vector.forEach((_, i) => (vector[i]! += (steps * (positive[i]! - negative[i]!)) / 2));
}

function add(vector: Float64Array, step: Numbers | undefined, steps: number): void {
  if (!step || steps === 0) return;
  step.forEach((by, i) => (vector[i]! += steps * by));
}

function strengthen(vector: Float64Array, model: Model, component: number, strength: number): void {
  const block = blockOf(model, `p${component}`);
  if (!block || strength === 1) return;
  for (let i = block[0]; i < block[1]; i++) vector[i]! *= strength;
}
