/** Feature vectors: their columns, the walker they make, and its position among those of the population. */

import { entry } from "../core/schema";
import type { Walker } from "../core/stimulus";
import type { Vector } from "../core/vector";
import type { Model, Trait } from "./model";

/** The lowest frequency of a walker: a caricature whose frequency would be lower gets this one. */
export const MIN_FREQUENCY_HZ = 0.05;

type HasLayout = Pick<Model, "layout">;

export const blockOf = ({ layout }: HasLayout, block: string) => entry(layout, block);

const cache = new WeakMap<Model["layout"], Map<string, readonly number[]>>();

/** Columns of a part of the features, in increasing order: a block, or several joined by "+". */
export function columnsOf({ layout }: HasLayout, part: string): readonly number[] {
  const known = cache.get(layout) ?? new Map<string, readonly number[]>();
  cache.set(layout, known);
  const columns = known.get(part) ?? findColumns({ layout }, part);
  known.set(part, columns);
  return columns;
}

function findColumns(model: HasLayout, part: string): number[] {
  const blocks = Object.keys(model.layout);
  const groups: Readonly<Record<string, readonly string[]>> = {
    all: blocks,
    structure: ["p0"],
    dynamics: blocks.filter((block) => block !== "p0"),
    postures: blocks.filter((block) => /^p\d+$/.test(block)),
    timing: blocks.filter((block) => !/^p\d+$/.test(block)),
  };
  const members = part.split("+").flatMap((name) => entry(groups, name) ?? [name]);
  const columns = members.flatMap((block) => {
    const span = blockOf(model, block);
    if (!span) throw new Error(`There is no part "${block}"; there are ${blocks.join(", ")}.`);
    return Array.from({ length: span[1] - span[0] }, (_, i) => span[0] + i);
  });
  return [...new Set(columns)].sort((a, b) => a - b);
}

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
    frequency_hz: Math.max(block("frequency")[0]!, MIN_FREQUENCY_HZ),
  };
}

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
