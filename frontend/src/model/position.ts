/** Where a walker lies among those of the population: on every axis, and how far from all. */

import type { Model, Trait } from "./model";

export interface Place {
  /** Standard deviations along each eigenwalker. */
  readonly scores: readonly number[];
  /** Standard deviations along each trait, by its name. */
  readonly positions: Readonly<Record<string, number>>;
  /** From the average walker; 1 is usual, 3 is three times as unlike it as the walkers are. */
  readonly distance: number;
  /** Percentage of the walkers that are nearer to the average. */
  readonly percentile: number;
}

/** Scores, positions and plausibility, as `position_in_space` of Python has them. */
export function placeOf(model: Model, vector: ArrayLike<number>): Place {
  const { average, scale, spread } = model;
  const standardised = average.map((usual, i) => (vector[i]! - usual) / scale[i]!);
  const distance = Math.sqrt(standardised.reduce((sum, z) => sum + z * z, 0)) / spread.rms;
  const nearer = spread.distances.filter((each) => each < distance).length;
  return {
    scores: scoresOf(model, standardised),
    positions: Object.fromEntries(model.traits.map((trait) => [trait.name, positionOf(trait, vector)])),
    distance,
    percentile: (100 * nearer) / spread.distances.length,
  };
}

/** Scores of standardised features: an eigenwalker is one SD long, and of unit length if without. */
function scoresOf(model: Model, standardised: readonly number[]): number[] {
  return model.eigenwalkers.map(({ vector, sd }) => {
    const along = standardised.reduce((sum, z, i) => sum + (z * vector[i]!) / model.scale[i]!, 0);
    return along / (sd * sd);
  });
}

/** Where a walker lies along a trait, in standard deviations from the average. */
export function positionOf({ projection }: Trait, vector: ArrayLike<number>): number {
  return projection.gradient.reduce((sum, slope, i) => sum + slope * vector[i]!, projection.offset);
}

/** Where every point of the cloud lies along a trait, which its eigenwalkers tell. */
export function positionsInCloud({ average, eigenwalkers, cloud }: Model, trait: Trait): number[] {
  const middle = positionOf(trait, average);
  const slopes = eigenwalkers.map(({ vector }) => positionOf(trait, vector) - trait.projection.offset);
  return cloud.scores.map((scores) => scores.reduce((sum, z, i) => sum + z * slopes[i]!, middle));
}
