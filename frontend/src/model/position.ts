/** The position of a walker among those of the population: on every axis, and its distance from the average. */

import type { Model, Trait } from "./model";

export interface Position {
  /** Standard deviations along each eigenwalker. */
  readonly scores: readonly number[];
  /** Standard deviations along each trait, by its name. */
  readonly traits: Readonly<Record<string, number>>;
  /** Distance from the average walker, in units of the walkers' root mean square distance. */
  readonly distance: number;
  /** Percentage of the walkers that are nearer to the average. */
  readonly percentile: number;
}

/** Scores, trait positions and plausibility, as Python's `position_in_space`. */
export function positionOf(model: Model, vector: ArrayLike<number>): Position {
  const { average, scale, spread, traits, eigenwalkers } = model;
  const standardised = average.map((usual, i) => (vector[i]! - usual) / scale[i]!);
  const distance = Math.sqrt(standardised.reduce((sum, z) => sum + z * z, 0)) / spread.rms;
  const nearer = spread.distances.filter((each) => each < distance).length;
  return {
    // An eigenwalker's vector is one SD long; its direction in standardised features has unit length.
    scores: eigenwalkers.map(({ vector, sd }) => {
      const along = standardised.reduce((sum, z, i) => sum + (z * vector[i]!) / scale[i]!, 0);
      return along / (sd * sd);
    }),
    traits: Object.fromEntries(traits.map((trait) => [trait.name, traitPosition(trait, vector)])),
    distance,
    percentile: (100 * nearer) / spread.distances.length,
  };
}

/** The position of a walker along a trait, in standard deviations from the average. */
export function traitPosition({ projection }: Trait, vector: ArrayLike<number>): number {
  return projection.gradient.reduce((sum, slope, i) => sum + slope * vector[i]!, projection.offset);
}

/** The positions of all points of the cloud along a trait, from their scores. */
export function cloudPositions({ average, eigenwalkers, cloud }: Model, trait: Trait): number[] {
  const middle = traitPosition(trait, average);
  const slopes = eigenwalkers.map(({ vector }) => traitPosition(trait, vector) - trait.projection.offset);
  return cloud.scores.map((scores) => scores.reduce((sum, z, i) => sum + z * slopes[i]!, middle));
}
