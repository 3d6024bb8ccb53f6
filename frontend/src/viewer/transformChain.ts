/** The chain of transforms that a visitor has switched on, as it stands in a stimulus file. */

import type { Moving } from "../core/movingDots";
import { scene } from "../core/scene";
import type { Step, Stimulus } from "../core/stimulus";
import { dot, observerAxes, type Vector } from "../core/vector";
import type { Settings, State, TransformName, Transforms } from "../model/state";

/** How much wider and higher than the figure the box of a mask is. */
const MASK_ROOM = [2, 1.15] as const;
const N_SAMPLES = 64;
const ARM_SWING = ["left_elbow", "left_wrist", "right_elbow", "right_wrist"];

/** What a step may be made from: the figure as the chain so far leaves it, and who it is. */
interface Before {
  readonly stimulus: Stimulus;
  readonly figure: number;
  /** The figure, worked out when it is asked for. */
  readonly moving: () => Moving;
  readonly groups: Readonly<Record<string, readonly string[]>>;
}

type Made = Step | null;
type Making<Name extends TransformName> = (settings: Settings<Name>, before: Before) => Made;

/** Steps in the order in which they act; each is made for one figure. */
const MAKING: { readonly [Name in TransformName]: Making<Name> } = {
  arm_swing: ({ factor }, { stimulus, figure }) => {
    const markers = ARM_SWING.filter((name) => markersOf(stimulus, figure).includes(name));
    return markers.length > 0 ? { name: "gain", markers, factor, axes: "xyz", figures: [figure] } : null;
  },
  conflict: (settings, before) =>
    hasTrunk(before) ? { name: "conflict", ...settings, figures: [before.figure] } : null,
  ellipses: (settings, before) => {
    if (!hasTrunk(before)) return null;
    return {
      name: "ellipses",
      shoulder_mm: [settings.shoulder_forward_mm, settings.shoulder_up_mm],
      hip_mm: [settings.hip_forward_mm, settings.hip_up_mm],
      phase_deg: phaseOfLegs(before.moving()),
      figures: [before.figure],
    };
  },
  reverse: (_, { stimulus, figure }) => ({
    name: "reverse",
    end_s: stimulus.timing.duration_s,
    figures: [figure],
  }),
  delay: ({ part, phase_deg }, before) => {
    const markers = markersIn(part, before);
    return markers.length > 0 ? { name: "delay", markers, phase_deg, figures: [before.figure] } : null;
  },
  phase_scramble: (settings, { figure }) => ({ name: "phase_scramble", ...settings, figures: [figure] }),
  mirror: (_, { figure }) => ({ name: "mirror", figures: [figure] }),
  invert: (_, { figure }) => ({ name: "invert", figures: [figure] }),
  occlude: ({ part }, before) => {
    const markers = markersIn(part, before);
    return markers.length > 0 ? { name: "occlude", markers, figures: [before.figure] } : null;
  },
  scramble: (settings, { stimulus, moving, figure }) => {
    return { name: "scramble", ...settings, box_mm: extentOf(moving(), stimulus), figures: [figure] };
  },
  limb_dots: (settings, { stimulus, figure }) => {
    const places = stimulus.figures[figure]!.segments.length > 0 ? settings.places : "joints";
    return { name: "limb_dots", ...settings, places, asynchrony: 1, figures: [figure] };
  },
  blur: ({ sd_mm }, { figure }) => ({ name: "blur", sd_mm, figures: [figure] }),
  mask: (settings, { stimulus, moving, figure }) => {
    const there = moving();
    const [width, height] = extentOf(there, stimulus);
    return {
      name: "mask",
      ...settings,
      box_mm: [Math.round(MASK_ROOM[0] * width), Math.round(MASK_ROOM[1] * height)],
      centre_mm: rounded(there.middle),
      direction_deg: null,
      phases: false,
      figures: [figure],
    };
  },
};

/** Whether anything is switched on that needs the chain. */
export const isPlain = ({ transforms }: Pick<State, "transforms">): boolean =>
  Object.keys(transforms).length === 0;

/**
 * A stimulus with what is switched on at the end of its chain.
 *
 * What depends on the figure, such as the box of a scrambled walker, is worked out from the figure
 * as it is at that place of the chain, as Python's `Stimulus.then` does.
 */
export function chained(
  stimulus: Stimulus,
  transforms: Transforms,
  groups: Before["groups"],
): Stimulus {
  const names = (Object.keys(MAKING) as TransformName[]).filter((name) => name in transforms);
  return names.reduce((so_far, name) => {
    const make = MAKING[name] as (settings: unknown, before: Before) => Made;
    let figures: readonly Moving[] | undefined;
    const steps = stimulus.figures.map((_, figure) => {
      const moving = (): Moving => (figures ??= scene(so_far))[figure]!;
      return make(transforms[name], { stimulus: so_far, figure, moving, groups });
    });
    const made = steps.filter((step) => step !== null);
    return { ...so_far, transforms: [...so_far.transforms, ...together(made)] };
  }, stimulus);
}

const TRUNK = ["left_shoulder", "right_shoulder", "left_hip", "right_hip"];

const hasTrunk = ({ stimulus, figure }: Before): boolean =>
  TRUNK.every((name) => markersOf(stimulus, figure).includes(name));

/** Markers of a part of the body that the figure has. */
function markersIn(part: string, { stimulus, figure, groups }: Before): string[] {
  const members = Object.hasOwn(groups, part) ? groups[part]! : [];
  return markersOf(stimulus, figure).filter((name) => members.includes(name));
}

/** Where in its swing forward the left leg is at 0 s: `sin(c + phase)` is how far ahead. */
function phaseOfLegs(moving: Moving): number {
  const [left, right] = [3 * moving.index("left_ankle"), 3 * moving.index("right_ankle")];
  let [sine, cosine] = [0, 0];
  for (let sample = 0; sample < N_SAMPLES; sample++) {
    const { positions } = moving.at((sample * moving.periodS) / N_SAMPLES);
    const ahead = positions[left]! - positions[right]! || 0;
    sine += ahead * Math.sin((2 * Math.PI * sample) / N_SAMPLES);
    cosine += ahead * Math.cos((2 * Math.PI * sample) / N_SAMPLES);
  }
  return Math.round(Math.atan2(cosine, sine) * (180 / Math.PI) * 1000) / 1000;
}

const markersOf = ({ figures }: Stimulus, figure: number): readonly string[] =>
  figures[figure]!.walker?.markers ?? [];

/** Steps that differ in nothing but their figure, as one. */
function together(steps: readonly Step[]): Step[] {
  const bare = steps.map((step) => JSON.stringify({ ...step, figures: null }));
  const alike = bare.every((step) => step === bare[0]);
  if (steps.length === 0 || !alike || steps[0]!.name === "mask") return [...steps];
  return [{ ...steps[0]!, figures: steps.length === 1 ? null : steps.flatMap(({ figures }) => figures!) }];
}

/** Width and height in the picture of a figure's mean posture, in whole millimetres. */
function extentOf(moving: Moving, { view }: Stimulus): readonly [number, number] {
  const [right, up] = observerAxes(view.view_deg, view.elevation_deg);
  const places = moving.body.dots.map((_, i) => [...moving.mean.subarray(3 * i, 3 * i + 3)] as unknown as Vector);
  const along = (axis: Vector): number => {
    const seen = places.map((place) => dot(place, axis)).filter((place) => !Number.isNaN(place));
    return Math.max(Math.ceil(Math.max(...seen) - Math.min(...seen)), 100);
  };
  return [along(right), along(up)];
}

const rounded = (place: Vector): Vector =>
  place.map((at) => Math.round(at * 1000) / 1000) as unknown as Vector;
