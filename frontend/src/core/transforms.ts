/** Every transform by its name in a stimulus file. */

import * as body from "./bodyTransforms";
import * as clocks from "./timeTransforms";
import type { Moving } from "./movingDots";
import * as scattered from "./dotTransforms";
import * as space from "./spatialTransforms";
import type { Stage } from "./transformContext";
import type { Parameters, Step } from "./stimulus";

type Transform<Name extends Step["name"]> = (
  moving: Moving,
  stage: Stage,
  step: Parameters<Name>,
) => Moving;

const TRANSFORMS: { readonly [Name in Step["name"]]: Transform<Name> } = {
  invert: space.invert,
  mirror: space.mirror,
  rotate: space.rotate,
  resize: space.resize,
  translate: space.translate,
  speed: clocks.speed,
  reverse: clocks.reverse,
  start: clocks.start,
  freeze: clocks.freeze,
  phase_scramble: clocks.phaseScramble,
  delay: clocks.delay,
  morph: clocks.morph,
  occlude: body.occlude,
  gain: body.gain,
  conflict: body.conflict,
  ellipses: body.ellipses,
  perturb: body.perturb,
  scramble: scattered.scramble,
  limb_dots: scattered.limbDots,
  blur: scattered.blur,
  mask: scattered.mask,
};

/** The figure as one transform leaves it; of a mask, the noise that joins the scene. */
export function transformed(moving: Moving, stage: Stage, step: Step): Moving {
  const transform = TRANSFORMS[step.name] as (m: Moving, s: Stage, p: Step) => Moving;
  return transform(moving, stage, step);
}

/** Whether what a transform returns joins the scene, rather than taking the figure's place. */
export const adds = (step: Step): boolean => step.name === "mask";
