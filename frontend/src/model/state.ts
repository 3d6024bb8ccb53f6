/**
 * What a visitor has chosen, all of it: the one thing that controls change and all else follows.
 *
 * A state is never changed in place: `{ ...state, tempo: 2 }` is the next one.
 */

import type { Model } from "./model";

/** Along the filter that tells a trait best, or the pattern that shows it best (A13). */
export type Kind = "discriminant" | "mean_difference";

/** One walker; women, men and both tripled (M5); four at one tempo (M1); up to a hundred. */
export type SceneName = "one" | "four" | "side" | "crowd";

/** Moler's gender bias, for any trait of two classes: steps of half the way between their means. */
export interface Bias {
  readonly trait: string;
  readonly steps: number;
}

export interface State {
  /** Standard deviations along each trait (A12); traits that are not named stay at 0. */
  readonly traits: Readonly<Record<string, number>>;
  readonly kind: Kind;
  /** What the classifier behind the traits knows: "all", "structure", "p1+p2+p3" (J31). */
  readonly part: string;
  /** Who is changed: the average walker, a walker of the population by its number, one's own. */
  readonly from: "average" | "own" | number;
  readonly bias: Bias | null;
  /** Of p1, p2 ...: stride, sway, hop, bounce; 1 is as it is (M4, M6). */
  readonly strengths: readonly number[];
  /** Standard deviations along each eigenwalker. */
  readonly eigenwalkers: readonly number[];
  /** How many times as fast it is played. */
  readonly tempo: number;
  readonly azimuth_deg: number;
  readonly elevation_deg: number;
  readonly perspective: boolean;
  /** How fast the figure turns by itself. */
  readonly turning_deg_s: number;
  readonly style: "dots" | "sticks" | "mannequin";
  readonly trails: boolean;
  readonly dark: boolean;
  readonly scene: SceneName;
  /** Numbers of the walkers who stand side by side. */
  readonly walkers: readonly number[];
  readonly transforms: Transforms;
  readonly playing: boolean;
  /** Where in the stride it stands while it does not play, from 0 to below 1. */
  readonly cycle: number;
}

/** Low and high end of what may be chosen. */
export const RANGES = {
  trait: [-6, 6],
  bias: [-3, 3],
  strength: [-2, 2],
  eigenwalker: [-6, 6],
  tempo: [0.1, 3],
  azimuth_deg: [-180, 180],
  elevation_deg: [-30, 90],
  turning_deg_s: [-180, 180],
  cycle: [0, 1],
} as const satisfies Record<string, readonly [number, number]>;

export const MOST_SIDE_BY_SIDE = 4;
export const MOST_IN_CROWD = 100;

/** A parameter of a transform as a visitor may set it. */
export type Field =
  | { readonly usual: number; readonly low: number; readonly high: number; readonly step: number }
  | { readonly usual: string; readonly choices: readonly string[] };

const SEED = { usual: 1, low: 0, high: 4294967295, step: 1 } as const;
const PARTS = ["upper_body", "lower_body", "arms", "legs", "trunk", "head"] as const;

const TIMES = { usual: 1, low: 0, high: 3, step: 0.1 } as const;
const RADIUS = { low: 0, high: 150, step: 1 } as const;

/** Transforms that the page offers, in the order in which they act, and their parameters. */
export const TRANSFORMS = {
  arm_swing: { factor: { usual: 2, low: 0, high: 4, step: 0.1 } },
  conflict: { shoulder_width: TIMES, hip_width: TIMES, shoulder_sway: TIMES, hip_sway: { ...TIMES, usual: 2 } },
  ellipses: {
    shoulder_forward_mm: { ...RADIUS, usual: 35 },
    shoulder_up_mm: { ...RADIUS, usual: 12 },
    hip_forward_mm: { ...RADIUS, usual: 15 },
    hip_up_mm: { ...RADIUS, usual: 20 },
  },
  reverse: {},
  delay: { part: { usual: "arms", choices: PARTS }, phase_deg: { usual: 90, low: -180, high: 180, step: 5 } },
  phase_scramble: { spread: { usual: 1, low: 0, high: 1, step: 0.05 }, seed: SEED },
  mirror: {},
  invert: {},
  occlude: { part: { usual: "lower_body", choices: PARTS } },
  scramble: {
    keep: { usual: "nothing", choices: ["nothing", "structure"] },
    directions: { usual: "both", choices: ["both", "horizontal", "vertical"] },
    seed: SEED,
  },
  limb_dots: {
    number: { usual: 8, low: 1, high: 60, step: 1 },
    lifetime_s: { usual: 0.1, low: 0.02, high: 2, step: 0.02 },
    places: { usual: "limbs", choices: ["limbs", "joints"] },
    seed: SEED,
  },
  blur: { sd_mm: { usual: 80, low: 10, high: 200, step: 5 } },
  mask: {
    kind: { usual: "scrambled", choices: ["scrambled", "linear", "random"] },
    number: { usual: 60, low: 1, high: 400, step: 1 },
    lifetime_s: { usual: 0.4, low: 0.05, high: 4, step: 0.05 },
    speed_mm_s: { usual: 500, low: 0, high: 3000, step: 50 },
    seed: SEED,
  },
} as const satisfies Record<string, Readonly<Record<string, Field>>>;

export type TransformName = keyof typeof TRANSFORMS;
export const TRANSFORM_NAMES = Object.keys(TRANSFORMS) as TransformName[];

type Setting<F> = F extends { readonly choices: readonly (infer Choice)[] } ? Choice : number;

/** The parameters of one transform. */
export type Settings<Name extends TransformName> = {
  readonly [F in keyof (typeof TRANSFORMS)[Name]]: Setting<(typeof TRANSFORMS)[Name][F]>;
};

/** Those that are on, with their parameters. */
export type Transforms = { readonly [Name in TransformName]?: Settings<Name> };

/** The parameters that a transform has when it is switched on. */
export function usualSettings<Name extends TransformName>(name: Name): Settings<Name> {
  const fields = Object.entries(TRANSFORMS[name] as Readonly<Record<string, Field>>);
  return Object.fromEntries(fields.map(([field, { usual }]) => [field, usual])) as Settings<Name>;
}

/** What is shown before anything was chosen. */
export function initialState(model: Model): State {
  return {
    traits: {},
    kind: "discriminant",
    part: "all",
    from: "average",
    bias: null,
    strengths: model.harmonics.map(() => 1),
    eigenwalkers: model.eigenwalkers.map(() => 0),
    tempo: 1,
    azimuth_deg: 30,
    elevation_deg: 0,
    perspective: false,
    turning_deg_s: 0,
    style: "dots",
    trails: false,
    dark: true,
    scene: "one",
    walkers: spread(model.walkers.length, MOST_SIDE_BY_SIDE),
    transforms: {},
    playing: true,
    cycle: 0,
  };
}

/** A few numbers from 0 to below `size`, evenly apart. */
function spread(size: number, most: number): number[] {
  const count = Math.min(size, most);
  return Array.from({ length: count }, (_, i) => Math.floor(((i + 0.5) * size) / count));
}

/** A number within a range. */
export const within = ([low, high]: readonly [number, number], value: number): number =>
  Math.min(Math.max(value, low), high);

/** An angle from -180 to below 180. */
export const wrappedDegrees = (angle: number): number => angle - 360 * Math.floor((angle + 180) / 360);
