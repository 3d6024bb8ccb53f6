/** What stands in a stimulus file, all defaults filled in; `docs/stimulus-format.md` tells of it. */

import type { Vector } from "./vector";

export type Link = readonly [string, string];

/** Coefficients of what is periodic: p0 + sum_i p_i sin(harmonic_i 2 pi f t + phase_i). */
export interface Walker {
  readonly markers: readonly string[];
  readonly p0: readonly Vector[];
  readonly p: readonly (readonly Vector[])[];
  readonly harmonics: readonly number[];
  readonly phases: readonly number[];
  readonly frequency_hz: number;
}

/** Samples of what is not periodic: frames of dots of x, y, z; null where missing. */
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

type Pair = readonly [number, number];

/** A transform: its name, its parameters, and the numbers of the figures it acts on. */
export type Step = { readonly figures: readonly number[] | null } & (
  | { readonly name: "invert" | "mirror" }
  | {
      readonly name: "rotate";
      readonly axis: Vector | "x" | "y" | "z" | "sight";
      readonly angle_deg: number;
      readonly speed_deg_s: number;
    }
  | { readonly name: "resize"; readonly factor: number }
  | { readonly name: "translate"; readonly offset_mm: Vector; readonly velocity_mm_s: Vector }
  | { readonly name: "speed"; readonly factor: number }
  | { readonly name: "reverse"; readonly end_s: number }
  | { readonly name: "start"; readonly phase_deg: number }
  | { readonly name: "freeze"; readonly time_s: number }
  | { readonly name: "phase_scramble"; readonly seed: number; readonly spread: number }
  | { readonly name: "delay"; readonly markers: readonly string[]; readonly phase_deg: number }
  | {
      readonly name: "morph";
      readonly walker: Walker;
      readonly start_s: number;
      readonly end_s: number;
    }
  | { readonly name: "occlude"; readonly markers: readonly string[] }
  | {
      readonly name: "gain";
      readonly markers: readonly string[];
      readonly factor: number;
      readonly axes: string;
    }
  | {
      readonly name: "conflict";
      readonly shoulder_width: number;
      readonly hip_width: number;
      readonly shoulder_sway: number;
      readonly hip_sway: number;
    }
  | {
      readonly name: "ellipses";
      readonly shoulder_mm: Pair;
      readonly hip_mm: Pair;
      readonly phase_deg: number;
    }
  | {
      readonly name: "perturb";
      readonly markers: readonly string[];
      readonly amount_mm: Vector;
      readonly frequency_hz: number;
      readonly phase_deg: number;
      readonly start_s: number;
      readonly end_s: number;
    }
  | {
      readonly name: "scramble";
      readonly seed: number;
      readonly keep: "nothing" | "structure";
      readonly box_mm: Pair;
      readonly directions: "both" | "horizontal" | "vertical";
    }
  | {
      readonly name: "limb_dots";
      readonly number: number;
      readonly lifetime_s: number | null;
      readonly asynchrony: number;
      readonly places: "limbs" | "joints";
      readonly seed: number;
    }
  | { readonly name: "blur"; readonly sd_mm: number }
  | {
      readonly name: "mask";
      readonly kind: "random" | "linear" | "scrambled";
      readonly number: number;
      readonly box_mm: Pair;
      readonly centre_mm: Vector;
      readonly lifetime_s: number | null;
      readonly speed_mm_s: number;
      readonly direction_deg: number | null;
      readonly phases: boolean;
      readonly seed: number;
    }
);

/** The parameters of one transform. */
export type Parameters<Name extends Step["name"]> = Extract<Step, { readonly name: Name }>;

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
