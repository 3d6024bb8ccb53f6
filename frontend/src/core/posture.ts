/** The posture of a walker at any phase of its stride: eq. 3 of Troje (2002), in one place. */

import type { Walker } from "./stimulus";

/** The coefficients of a walker as flat arrays: x, y, z of one marker after the other. */
export interface Coefficients {
  readonly mean: Float64Array;
  /** All eigenpostures, one after the other. */
  readonly postures: Float64Array;
  readonly harmonics: Float64Array;
  readonly phases: Float64Array;
}

export const coefficientsOf = ({ p0, p, harmonics, phases }: Walker): Coefficients => ({
  mean: Float64Array.from(p0.flat()),
  postures: Float64Array.from(p.flat(2)),
  harmonics: Float64Array.from(harmonics),
  phases: Float64Array.from(phases),
});

/**
 * Write the posture `p0 + sum_i p_i sin(h_i angle + phi_i)` into an array, and return it.
 *
 * `angle` is 2 pi times the number of strides.
 */
export function posture(
  { mean, postures, harmonics, phases }: Coefficients,
  angle: number,
  into: Float64Array = new Float64Array(mean.length),
): Float64Array {
  const size = mean.length;
  into.set(mean);
  for (let i = 0; i < harmonics.length; i++) {
    const sine = Math.sin(harmonics[i]! * angle + phases[i]!);
    const start = i * size;
    for (let j = 0; j < size; j++) into[j]! += sine * postures[start + j]!;
  }
  return into;
}
