/** The content of a stimulus file, all defaults filled in; `docs/stimulus-format.md` describes it. */

import type { Vector } from "./vector";

export type Link = readonly [string, string];
type Pair = readonly [number, number];

/** Coefficients of a periodic figure: p0 + sum_i p_i sin(harmonic_i 2 pi f t + phase_i). */
export interface Walker {
  readonly markers: readonly string[];
  readonly p0: readonly Vector[];
  readonly p: readonly (readonly Vector[])[];
  readonly harmonics: readonly number[];
  readonly phases: readonly number[];
  readonly frequency_hz: number;
}

/** Samples of a figure that is not periodic: frames of dots of x, y, z; null where missing. */
export interface Trajectories {
  readonly markers: readonly string[];
  readonly rate_hz: number;
  readonly repeat: boolean;
  readonly samples: readonly (readonly (readonly (number | null)[])[])[];
}

export interface Figure {
  readonly walker: Walker | null;
  readonly trajectories: Trajectories | null;
  readonly segments: readonly Link[];
  readonly pairs: readonly Link[];
  readonly position_mm: Vector;
  readonly heading_deg: number;
}

export interface View {
  readonly view_deg: number;
  readonly elevation_deg: number;
  readonly eye_distance_mm: number | null;
  readonly centre_mm: Vector;
}

export interface Display {
  readonly width_px: number;
  readonly height_px: number;
  readonly px_per_mm: number;
  readonly dot_px: number;
  readonly style: "dots" | "sticks" | "mannequin";
  readonly colour: string;
  readonly background: string;
  readonly viewing_distance_mm: number | null;
  readonly px_per_cm: number | null;
}

interface TransformParameters {
  invert: object;
  mirror: object;
  rotate: { axis: Vector | "x" | "y" | "z" | "sight"; angle_deg: number; speed_deg_s: number };
  resize: { factor: number };
  translate: { offset_mm: Vector; velocity_mm_s: Vector };
  speed: { factor: number };
  reverse: { end_s: number };
  start: { phase_deg: number };
  freeze: { time_s: number };
  phase_scramble: { seed: number; spread: number };
  delay: { markers: readonly string[]; phase_deg: number };
  morph: { walker: Walker; start_s: number; end_s: number };
  occlude: { markers: readonly string[] };
  gain: { markers: readonly string[]; factor: number; axes: string };
  conflict: { shoulder_width: number; hip_width: number; shoulder_sway: number; hip_sway: number };
  ellipses: { shoulder_mm: Pair; hip_mm: Pair; phase_deg: number };
  perturb: {
    markers: readonly string[];
    amount_mm: Vector;
    frequency_hz: number;
    phase_deg: number;
    start_s: number;
    end_s: number;
  };
  scramble: {
    seed: number;
    keep: "nothing" | "structure";
    box_mm: Pair;
    directions: "both" | "horizontal" | "vertical";
  };
  limb_dots: {
    number: number;
    lifetime_s: number | null;
    asynchrony: number;
    places: "limbs" | "joints";
    seed: number;
  };
  blur: { sd_mm: number | null; sd_px: number | null };
  mask: {
    kind: "random" | "linear" | "scrambled";
    number: number;
    box_mm: Pair;
    centre_mm: Vector;
    lifetime_s: number | null;
    speed_mm_s: number;
    direction_deg: number | null;
    phases: boolean;
    seed: number;
  };
}

export type TransformName = keyof TransformParameters;

/** One transform: its name, its parameters, and the numbers of the figures it acts on. */
export type Parameters<Name extends TransformName> = Readonly<
  { name: Name; figures: readonly number[] | null } & TransformParameters[Name]
>;

export type Step = { [Name in TransformName]: Parameters<Name> }[TransformName];

export interface Stimulus {
  readonly format: "eigenwalker stimulus";
  readonly version: 1;
  readonly figures: readonly Figure[];
  readonly transforms: readonly Step[];
  readonly view: View;
  readonly timing: { readonly duration_s: number; readonly rate_hz: number };
  readonly display: Display;
  readonly provenance: Readonly<Record<string, string>>;
}
