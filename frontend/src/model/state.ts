/**
 * The state of a page: everything a visitor can choose, from which all else follows.
 *
 * A state is never changed in place: `{ ...state, tempo: 2 }` is the next one.
 */

import { MAX_WALKERS, type Kind, type Model } from "./model";
import table from "./transforms.json";

/** One walker; the means of two classes and both tripled; four at one tempo; up to a hundred. */
export type SceneName = "one" | "four" | "side" | "crowd";

/** Moler's gender bias, for any trait of two classes: in steps of half the difference between their means. */
export interface Bias {
  readonly trait: string;
  readonly steps: number;
}

export interface State {
  /** Standard deviations along each trait; 0 for traits that are left out. */
  readonly traits: Readonly<Record<string, number>>;
  readonly kind: Kind;
  /** The part of the features that traits change: "all", "structure", "p1+p2+p3". */
  readonly part: string;
  /** The walker that the changes start from: the average, the visitor's own, or a number among the model's. */
  readonly from: "average" | "own" | number;
  readonly bias: Bias | null;
  /** Whether walkers have their own size. */
  readonly keepSize: boolean;
  /** Factors of p1, p2 ...: stride, sway, hop, bounce. */
  readonly strengths: readonly number[];
  /** Standard deviations along each eigenwalker. */
  readonly eigenwalkers: readonly number[];
  /** Factor of the playback speed. */
  readonly tempo: number;
  readonly azimuth_deg: number;
  readonly elevation_deg: number;
  /** Factor of the size that fills the picture. */
  readonly zoom: number;
  readonly perspective: boolean;
  /** Speed at which the figure turns by itself. */
  readonly turning_deg_s: number;
  readonly style: "dots" | "sticks" | "mannequin";
  readonly trails: boolean;
  readonly dark: boolean;
  readonly scene: SceneName;
  /** Numbers of the walkers side by side. */
  readonly walkers: readonly number[];
  readonly transforms: Transforms;
  readonly playing: boolean;
  /** Phase of the stride while paused, from 0 to below 1. */
  readonly cycle: number;
}

/** Parts of the state that make the walkers; all else is about how they are shown. */
export const WALKER_PARTS = [
  "traits", "kind", "part", "from", "bias", "strengths", "eigenwalkers", "scene", "walkers",
] as const satisfies readonly (keyof State)[];

export const RANGES = {
  trait: [-6, 6],
  bias: [-3, 3],
  strength: [-2, 2],
  eigenwalker: [-6, 6],
  tempo: [0.1, 3],
  azimuth_deg: [-180, 180],
  elevation_deg: [-30, 90],
  zoom: [0.25, 8],
  turning_deg_s: [-180, 180],
  cycle: [0, 1],
} as const satisfies Record<string, readonly [number, number]>;

export const MAX_SIDE_BY_SIDE = 4;
export const MAX_IN_CROWD = MAX_WALKERS;

/** A parameter of a transform that a visitor can set. */
export type Field = { readonly label: string } & (
  | { readonly initial: number; readonly low: number; readonly high: number; readonly step: number }
  | { readonly initial: string; readonly choices: readonly string[] }
);

/** The transforms of the page in the order of the chain: their names, words about them, and parameters. */
export const TRANSFORMS = table;
export type TransformName = keyof typeof TRANSFORMS;
export const TRANSFORM_NAMES = Object.keys(TRANSFORMS) as TransformName[];

type Fields<Name extends TransformName> = (typeof TRANSFORMS)[Name]["fields"];
type Initial<F> = F extends { readonly initial: infer Value } ? Value : never;

export type Settings<Name extends TransformName> = { readonly [F in keyof Fields<Name>]: Initial<Fields<Name>[F]> };

export type Transforms = { readonly [Name in TransformName]?: Settings<Name> };

export const fieldsOf = (name: TransformName): Readonly<Record<string, Field>> => TRANSFORMS[name].fields;

/** The parameters of a transform when it is switched on. */
export function initialSettings<Name extends TransformName>(name: Name): Settings<Name> {
  const fields = Object.entries(fieldsOf(name));
  return Object.fromEntries(fields.map(([field, { initial }]) => [field, initial])) as Settings<Name>;
}

export function initialState(model: Model): State {
  return {
    traits: {},
    kind: "discriminant",
    part: "all",
    from: "average",
    bias: null,
    keepSize: model.keepSize ?? model.size_kept,
    strengths: model.harmonics.map(() => 1),
    eigenwalkers: model.eigenwalkers.map(() => 0),
    tempo: 1,
    azimuth_deg: 30,
    elevation_deg: 0,
    zoom: 1,
    perspective: false,
    turning_deg_s: 0,
    style: "dots",
    trails: false,
    dark: true,
    scene: "one",
    walkers: evenlySpaced(model.walkers.length, MAX_SIDE_BY_SIDE),
    transforms: {},
    playing: true,
    cycle: 0,
  };
}

/** Some numbers from 0 to below `size`, evenly spaced. */
function evenlySpaced(size: number, max: number): number[] {
  const count = Math.min(size, max);
  return Array.from({ length: count }, (_, i) => Math.floor(((i + 0.5) * size) / count));
}

/** The number of a range that is nearest to a value. */
export const clamped = ([low, high]: readonly [number, number], value: number): number =>
  Math.min(Math.max(value, low), high);

/** An angle from -180 to below 180. */
export const wrappedDegrees = (angle: number): number => angle - 360 * Math.floor((angle + 180) / 360);
