/** The figures of each scene. */

import type { Walker } from "../core/stimulus";
import { endLabels } from "./labels";
import { walkerOf } from "./features";
import { mixedVector, traitOf } from "./mixing";
import type { Model, Numbers, OwnWalker, Trait } from "./model";
import { MAX_IN_CROWD, MAX_SIDE_BY_SIDE, WALKER_PARTS, type SceneName, type State } from "./state";

export interface SceneFigure {
  readonly name: string;
  readonly vector: Float64Array;
  readonly walker: Walker;
  /** Its number among the model's walkers, if it is one of them. */
  readonly known: number | null;
}

/** A state of a model, with the figures that it shows. */
export interface Scene {
  readonly model: Model;
  readonly figures: readonly SceneFigure[];
  readonly state: State;
}

/** The last figures of each model: turning a crowd does not make it anew. */
const cache = new WeakMap<Model, { state: State; own: OwnWalker | null; figures: readonly SceneFigure[] }>();

/** All figures of the present scene, in order. */
export function figuresOf(model: Model, state: State, own: OwnWalker | null = null): readonly SceneFigure[] {
  const last = cache.get(model);
  if (last && last.own === own && WALKER_PARTS.every((part) => last.state[part] === state[part])) return last.figures;
  const some = SCENES[state.scene](model, state, own);
  const figures = some.length > 0 ? some : one(model, state, own);
  cache.set(model, { state, own, figures });
  return figures;
}

type MakeScene = (model: Model, state: State, own: OwnWalker | null) => SceneFigure[];

const SCENES: Readonly<Record<SceneName, MakeScene>> = { one, four, side, crowd };

function figure(model: Model, name: string, vector: Float64Array, known: number | null = null): SceneFigure {
  return { name, vector, walker: walkerOf(model, vector), known };
}

function one(model: Model, state: State, own: OwnWalker | null): SceneFigure[] {
  return [figure(model, nameOf(model, state, own), mixedVector(model, state, own))];
}

export const AVERAGE = "average walker";

export function nameOf(model: Model, { from }: State, own: OwnWalker | null): string {
  if (from === "own" && own) return own.name;
  return (typeof from === "number" ? model.walkers[from]?.name : undefined) ?? AVERAGE;
}

/** Moler's figure: the mean walkers of two classes, and both with their difference tripled. */
function four(model: Model, state: State): SceneFigure[] {
  const trait = comparedTrait(model, state);
  if (!trait?.means) return [];
  const { negative, positive } = trait.means;
  const plain = { ...state, traits: {}, bias: null, eigenwalkers: [], from: "own" as const };
  return [["", 1], ["tripled", 3]].flatMap(([word, times]) =>
    endLabels(trait).map((end, i) => {
      const vector = extrapolated(negative, positive, (i === 0 ? -1 : 1) * Number(times));
      return figure(model, `${end} ${word}`.trim(), mixedVector(model, plain, { name: "", vector }));
    }),
  );
}

/** The trait of two classes that the four panels show: that of the bias, or the first. */
export function comparedTrait(model: Model, { bias }: State): Trait | undefined {
  const chosen = bias ? traitOf(model, bias.trait) : undefined;
  return chosen?.means ? chosen : model.traits.find(({ means }) => means !== null);
}

/** The middle of two vectors plus some halves of their difference. */
const extrapolated = (negative: Numbers, positive: Numbers, times: number): number[] =>
  negative.map((low, i) => (low + positive[i]!) / 2 + (times * (positive[i]! - low)) / 2);

/** Some walkers at their mean frequency, each changed by the sliders. */
function side(model: Model, state: State): SceneFigure[] {
  const all = state.walkers.slice(0, MAX_SIDE_BY_SIDE).flatMap((number) => changed(model, state, number));
  const frequency_hz = all.reduce((sum, { walker }) => sum + walker.frequency_hz, 0) / all.length;
  return all.map((each) => ({ ...each, walker: { ...each.walker, frequency_hz } }));
}

function crowd(model: Model, state: State): SceneFigure[] {
  return model.walkers.slice(0, MAX_IN_CROWD).flatMap((_, number) => changed(model, state, number));
}

/** A walker of the population, changed by the sliders. */
function changed(model: Model, state: State, number: number): SceneFigure[] {
  const known = model.walkers[number];
  return known ? [figure(model, known.name, mixedVector(model, { ...state, from: number }), number)] : [];
}
