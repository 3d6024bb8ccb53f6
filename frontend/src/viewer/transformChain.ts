/** The transforms that are switched on, as steps of a stimulus file. */

import type { MovingDots } from "../core/movingDots";
import { completeStep } from "../core/readStimulus";
import { entry } from "../core/schema";
import { scene } from "../core/scene";
import type { Step, Stimulus } from "../core/stimulus";
import type { Settings, State, TransformName, Transforms } from "../model/state";

/** A usual walker's height in diameters of a dot: what does not go with the walkers goes by it. */
const USUAL_HEIGHT_DOTS = 42;
const USUAL_HEIGHT_MM = 1500;
/** Width and height of boxes, in heights of a usual walker, as in Python. */
const MASK_BOX = [0.75, 1.15] as const;
const SCRAMBLE_BOX = [0.4, 1] as const;
const N_SAMPLES = 64;
const ARM_SWING = ["left_elbow", "left_wrist", "right_elbow", "right_wrist"];
const TRUNK = ["left_shoulder", "right_shoulder", "left_hip", "right_hip"];

/** What a step is made from: the figure at that place of the chain. */
interface Before {
  readonly stimulus: Stimulus;
  /** Markers and segments of the figure. */
  readonly markers: readonly string[];
  readonly joined: boolean;
  /** The figure, computed on demand. */
  readonly moving: () => MovingDots;
  readonly groups: Readonly<Record<string, readonly string[]>>;
}

/** Parameters of a step, without its figures and defaults; null for no step. */
type MakeStep<Name extends TransformName> = (settings: Settings<Name>, before: Before) => object | null;

/** Steps in the order of the chain. */
const STEPS: { readonly [Name in TransformName]: MakeStep<Name> } = {
  arm_swing: ({ factor }, { markers }) => ({
    name: "gain",
    markers: ARM_SWING.filter((name) => markers.includes(name)),
    factor,
  }),
  conflict: (settings, before) => (hasTrunk(before) ? settings : null),
  ellipses: ({ shoulder_forward_mm, shoulder_up_mm, hip_forward_mm, hip_up_mm }, before) =>
    hasTrunk(before)
      ? {
          shoulder_mm: [shoulder_forward_mm, shoulder_up_mm],
          hip_mm: [hip_forward_mm, hip_up_mm],
          phase_deg: legPhase(before.moving()),
        }
      : null,
  reverse: (_, { stimulus }) => ({ end_s: stimulus.timing.duration_s }),
  delay: ({ part, phase_deg }, before) => ({ markers: markersIn(part, before), phase_deg }),
  phase_scramble: (settings) => settings,
  mirror: (settings) => settings,
  invert: (settings) => settings,
  occlude: ({ part }, before) => ({ markers: markersIn(part, before) }),
  scramble: (settings, { stimulus }) => ({ ...settings, box_mm: boxOf(SCRAMBLE_BOX, stimulus) }),
  limb_dots: (settings, { joined }) => ({ ...settings, places: joined ? settings.places : "joints" }),
  blur: ({ sd_mm }, { stimulus: { display } }) => ({ sd_px: (sd_mm * USUAL_HEIGHT_DOTS * display.dot_px) / USUAL_HEIGHT_MM }),
  mask: (settings, { stimulus, moving }) => ({
    ...settings,
    box_mm: boxOf(MASK_BOX, stimulus),
    centre_mm: moving().middle.map((at) => Math.round(at * 1000) / 1000),
  }),
};

export const isPlain = ({ transforms }: Pick<State, "transforms">): boolean =>
  Object.keys(transforms).length === 0;

/**
 * A stimulus with transforms added to its chain.
 *
 * Parameters that depend on the figure, such as the box of a scrambled walker, are computed from the
 * figure at that place of the chain, as Python's `Stimulus.then` does.
 */
export function withTransforms(stimulus: Stimulus, transforms: Transforms, groups: Before["groups"]): Stimulus {
  const names = (Object.keys(STEPS) as TransformName[]).filter((name) => name in transforms);
  return names.reduce((before, name) => {
    const make = STEPS[name] as (settings: unknown, before: Before) => { markers?: readonly string[] } | null;
    let figures: readonly MovingDots[] | undefined;
    const steps = before.figures.flatMap(({ walker, segments }, figure): Step[] => {
      const step = make(transforms[name], {
        stimulus: before,
        markers: walker?.markers ?? [],
        joined: segments.length > 0,
        moving: () => (figures ??= scene(before))[figure]!,
        groups,
      });
      return step && step.markers?.length !== 0 ? [completeStep({ name, ...step, figures: [figure] })] : [];
    });
    return { ...before, transforms: [...before.transforms, ...merged(steps)] };
  }, stimulus);
}

const hasTrunk = ({ markers }: Before): boolean => TRUNK.every((name) => markers.includes(name));

function markersIn(part: string, { markers, groups }: Before): string[] {
  const members = entry(groups, part) ?? [];
  return markers.filter((name) => members.includes(name));
}

/** The phase of the left leg at 0 s, in degrees: `sin(c + phase)` is how far it is in front. */
function legPhase(moving: MovingDots): number {
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

/** Steps that differ only in their figures, as one step. */
function merged(steps: readonly Step[]): readonly Step[] {
  const [first, ...others] = steps.map((step) => JSON.stringify({ ...step, figures: null }));
  if (first === undefined || others.some((step) => step !== first) || steps[0]!.name === "mask") return steps;
  return [{ ...steps[0]!, figures: steps.length === 1 ? null : steps.flatMap(({ figures }) => figures!) }];
}

/** A box in millimetres that is as large in the picture for all walkers. */
const boxOf = (shape: readonly [number, number], { display: { dot_px, px_per_mm } }: Stimulus): number[] =>
  shape.map((side) => Math.round((1000 * side * USUAL_HEIGHT_DOTS * dot_px) / px_per_mm) / 1000);
