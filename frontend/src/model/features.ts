/** A feature vector as a walker, as `FeatureLayout.walker` of Python makes it (J29). */

import type { Walker } from "../core/stimulus";
import type { Vector } from "../core/vector";
import { blockOf } from "./layout";
import type { Model } from "./model";

/** Nobody walks backwards in time: a caricature whose frequency would be less has this one. */
export const SLOWEST_HZ = 0.05;

export function walkerOf(model: Model, vector: ArrayLike<number>): Walker {
  const { markers, harmonics } = model;
  const block = (name: string): number[] => {
    const [start, end] = blockOf(model, name) ?? [0, 0];
    return Array.from({ length: end - start }, (_, i) => vector[start + i]!);
  };
  const posture = (name: string): Vector[] => {
    const values = block(name);
    return markers.map((_, i) => values.slice(3 * i, 3 * i + 3) as unknown as Vector);
  };
  const free = [0, ...block("phases")];
  return {
    markers,
    p0: posture("p0"),
    p: harmonics.map((_, i) => posture(`p${i + 1}`)),
    harmonics,
    phases: harmonics.map((_, i) => model.fixed_phases[i] ?? free[i]!),
    frequency_hz: Math.max(block("frequency")[0]!, SLOWEST_HZ),
  };
}
