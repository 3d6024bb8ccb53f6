/** Who is on the stage in each scene. */

import type { Walker } from "../core/stimulus";
import { traitOf, vectorOf } from "./mixing";
import type { Model, Numbers, Own, Trait } from "./model";
import { ends } from "./axisLabels";
import { MOST_IN_CROWD, MOST_SIDE_BY_SIDE, type SceneName, type State } from "./state";
import { walkerOf } from "./features";

/** One of them. */
export interface Cast {
  readonly name: string;
  readonly vector: Float64Array;
  readonly walker: Walker;
  /** Its number among the model's walkers, where it is one of them. */
  readonly known: number | null;
}

/** Parts of the state that make a cast; all else leaves it as it is. */
const CASTING = [
  "traits", "kind", "part", "from", "bias", "strengths", "eigenwalkers", "scene", "walkers",
] as const satisfies readonly (keyof State)[];

/** The cast that was made last of each model: turning a crowd does not make it anew. */
const last = new WeakMap<Model, { state: State; own: Own | null; cast: readonly Cast[] }>();

/** All who are seen, in order. */
export function castOf(model: Model, state: State, own: Own | null = null): readonly Cast[] {
  const known = last.get(model);
  if (known && known.own === own && CASTING.every((part) => known.state[part] === state[part])) return known.cast;
  const all = SCENES[state.scene](model, state, own);
  const cast = all.length > 0 ? all : one(model, state, own);
  last.set(model, { state, own, cast });
  return cast;
}

type Casting = (model: Model, state: State, own: Own | null) => Cast[];

const SCENES: Readonly<Record<SceneName, Casting>> = { one, four, side, crowd };

function member(model: Model, name: string, vector: Float64Array, known: number | null = null): Cast {
  return { name, vector, walker: walkerOf(model, vector), known };
}

function one(model: Model, state: State, own: Own | null): Cast[] {
  return [member(model, nameOf(model, state, own), vectorOf(model, state, own))];
}

/** What the walker is called whom nobody was chosen for. */
export const AVERAGE = "average walker";

/** Who the walker is made from. */
export function nameOf(model: Model, { from }: State, own: Own | null): string {
  if (from === "own" && own) return own.name;
  return (typeof from === "number" ? model.walkers[from]?.name : undefined) ?? AVERAGE;
}

/** Moler's figure: the mean walkers of two classes, and both with their difference tripled (M5). */
function four(model: Model, state: State): Cast[] {
  const trait = comparedIn(model, state);
  if (!trait?.means) return [];
  const { negative, positive } = trait.means;
  const [low, high] = ends(trait);
  const panels = ([["", 1], ["tripled", 3]] as const).flatMap(([word, times]) => [
    [`${low} ${word}`, mean(negative, positive, -times)] as const,
    [`${high} ${word}`, mean(negative, positive, times)] as const,
  ]);
  return panels.map(([name, vector]) => member(model, name.trim(), alone(model, state, vector)));
}

/** The trait of two classes that the four panels show: that of the bias, or the first there is. */
export function comparedIn(model: Model, { bias }: State): Trait | undefined {
  const chosen = bias ? traitOf(model, bias.trait) : undefined;
  return chosen?.means ? chosen : model.traits.find(({ means }) => means !== null);
}

/** Half the difference times so much from the middle of both. */
const mean = (negative: Numbers, positive: Numbers, times: number): number[] =>
  negative.map((low, i) => (low + positive[i]!) / 2 + (times * (positive[i]! - low)) / 2);

/** A vector with the components as strong as wished, and nothing else changed. */
function alone(model: Model, state: State, vector: Numbers): Float64Array {
  const plain = { ...state, traits: {}, bias: null, eigenwalkers: [], from: "own" as const };
  return vectorOf(model, plain, { name: "", vector });
}

/** Some walkers at one tempo (M1), each changed as the sliders say. */
function side(model: Model, state: State): Cast[] {
  const all = state.walkers.slice(0, MOST_SIDE_BY_SIDE).flatMap((number) => changed(model, state, number));
  const tempo = all.reduce((sum, { walker }) => sum + walker.frequency_hz, 0) / all.length;
  return all.map((each) => ({ ...each, walker: { ...each.walker, frequency_hz: tempo } }));
}

function crowd(model: Model, state: State): Cast[] {
  return model.walkers.slice(0, MOST_IN_CROWD).flatMap((_, number) => changed(model, state, number));
}

/** A walker of the population, changed as the sliders say (W7). */
function changed(model: Model, state: State, number: number): Cast[] {
  const known = model.walkers[number];
  if (!known) return [];
  return [member(model, known.name, vectorOf(model, { ...state, from: number }), number)];
}
