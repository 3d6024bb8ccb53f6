/** The model that a page holds: a population, what varies in it, and what tells its traits. */

import type { Link } from "../core/stimulus";
import type { Kind } from "./state";

export type Numbers = readonly number[];

/** Columns of the features: from one to before the other. */
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
  /** As Python's `trait_axis` takes it. */
  readonly name: string;
  /** Its column in the traits of the walkers. */
  readonly column: string;
  /** What to call it. */
  readonly label: string;
  readonly unit: string;
  readonly negative: string;
  readonly positive: string;
  readonly two_classes: boolean;
  /** One standard deviation of the walkers along the trait, of the columns of each part (A12). */
  readonly steps: Readonly<Record<Kind, Readonly<Record<string, Numbers>>>>;
  /** Where a walker lies along it: offset + gradient . vector. */
  readonly projection: { readonly gradient: Numbers; readonly offset: number };
  /** Mean walkers of two classes (M5). */
  readonly means: { readonly negative: Numbers; readonly positive: Numbers } | null;
}

/** Every walker of the population as a point, of those the page has room for. */
export interface Cloud {
  readonly n: number;
  /** Of each, its scores on the eigenwalkers in standard deviations. */
  readonly scores: readonly Numbers[];
  /** Its number among the model's walkers, -1 where it is not among them. */
  readonly walker: Numbers;
}

export interface Model {
  readonly format: "eigenwalker model";
  readonly version: 1;
  readonly program: string;
  readonly title: string;
  /** File of the population; empty for the one that comes with the program. */
  readonly source: string;
  /** Captures that it was made of just now, of which there is no file of a population. */
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
  /** Of each posture; null for a phase that is a feature. */
  readonly fixed_phases: readonly (number | null)[];
  readonly layout: Readonly<Record<string, Span>>;
  readonly average: Numbers;
  readonly scale: Numbers;
  readonly eigenwalkers: readonly Eigenwalker[];
  /** Root mean square distance from the average; the distance of each walker in units of it. */
  readonly spread: { readonly rms: number; readonly distances: Numbers };
  readonly walkers: readonly KnownWalker[];
  readonly cloud: Cloud;
  readonly traits: readonly Trait[];
}

/** A walker that is not the population's: someone's own capture, fitted. */
export interface Own {
  readonly name: string;
  readonly vector: Numbers;
}
