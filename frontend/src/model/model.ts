/** The model of a page: a population, the variation in it, and the directions of its traits. */

import type { Link } from "../core/stimulus";

/** The direction that tells a trait best, or the difference between the means of its two ends. */
export type Kind = "discriminant" | "mean_difference";

export type Numbers = readonly number[];

/** Columns of the features: from the first to before the second. */
export type Span = readonly [number, number];

export interface Eigenwalker {
  /** One standard deviation of the walkers along it. */
  readonly vector: Numbers;
  readonly sd: number;
  /** Share of the variance of standardised features. */
  readonly share: number;
}

export interface KnownWalker {
  readonly name: string;
  /** Its number in the population. */
  readonly row: number;
  readonly vector: Numbers;
  readonly traits: Readonly<Record<string, string | number | boolean | null>>;
}

export interface Trait {
  /** As an argument of Python's `trait_axis`. */
  readonly name: string;
  /** Its column in the traits of the walkers. */
  readonly column: string;
  readonly label: string;
  readonly unit: string;
  readonly negative: string;
  readonly positive: string;
  readonly two_classes: boolean;
  /** One standard deviation of the walkers along the trait, for the columns of each part. */
  readonly steps: Readonly<Record<Kind, Readonly<Record<string, Numbers>>>>;
  /** The position of a walker along the trait: offset + gradient . vector. */
  readonly projection: { readonly gradient: Numbers; readonly offset: number };
  /** Mean walkers of two classes. */
  readonly means: { readonly negative: Numbers; readonly positive: Numbers } | null;
}

/** The walkers of the population as points; at most as many as the page has room for. */
export interface Cloud {
  readonly n: number;
  /** For each point, its scores on the eigenwalkers in standard deviations. */
  readonly scores: readonly Numbers[];
  /** For each point, its number among the model's walkers; -1 if it is not one of them. */
  readonly walker: Numbers;
}

export interface Model {
  readonly format: "eigenwalker model";
  readonly version: 1;
  readonly program: string;
  readonly title: string;
  /** File of the population; empty for the built-in population. */
  readonly source: string;
  /** Name of the captures that the server has just made into this population. */
  readonly captures?: string;
  readonly simulated: boolean;
  readonly provenance: Readonly<Record<string, string>>;
  readonly n_walkers: number;
  /** Walkers of doubtful captures, which are left out. */
  readonly n_flagged: number;
  readonly markers: readonly string[];
  readonly segments: readonly Link[];
  readonly pairs: readonly Link[];
  readonly groups: Readonly<Record<string, readonly string[]>>;
  readonly form: "eigenposture" | "fourier";
  readonly harmonics: Numbers;
  /** For each posture its phase; null if the phase is a feature. */
  readonly fixed_phases: readonly (number | null)[];
  readonly layout: Readonly<Record<string, Span>>;
  readonly average: Numbers;
  readonly scale: Numbers;
  readonly eigenwalkers: readonly Eigenwalker[];
  /** Root mean square distance from the average; the distances of the walkers in units of it. */
  readonly spread: { readonly rms: number; readonly distances: Numbers };
  readonly walkers: readonly KnownWalker[];
  readonly cloud: Cloud;
  readonly traits: readonly Trait[];
}

/** A walker that is not in the population: a visitor's own capture or stimulus. */
export interface OwnWalker {
  readonly name: string;
  readonly vector: Numbers;
}
