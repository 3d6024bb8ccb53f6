/** All transforms by their names in a stimulus file. */

import { conflict, ellipses, gain, occlude, perturb } from "./bodyTransforms";
import { blur, limbDots, mask, scramble } from "./dotTransforms";
import type { MovingDots, TransformContext } from "./movingDots";
import { invert, mirror, resize, rotate, translate } from "./spatialTransforms";
import type { Parameters, Step, TransformName } from "./stimulus";
import { delay, freeze, morph, phaseScramble, reverse, speed, start } from "./timeTransforms";

type Transform<Name extends TransformName> = (
  moving: MovingDots,
  context: TransformContext,
  step: Parameters<Name>,
) => MovingDots;

const TRANSFORMS: { readonly [Name in TransformName]: Transform<Name> } = {
  invert, mirror, rotate, resize, translate,
  speed, reverse, start, freeze, phase_scramble: phaseScramble, delay, morph,
  occlude, gain, conflict, ellipses, perturb,
  scramble, limb_dots: limbDots, blur, mask,
};

/** The figure after one transform; for a mask, the noise that joins the scene. */
export function transformed(moving: MovingDots, context: TransformContext, step: Step): MovingDots {
  const transform = TRANSFORMS[step.name] as Transform<never>;
  return transform(moving, context, step as never);
}

/** Whether the result of a transform joins the scene instead of replacing the figure. */
export const addsFigure = (step: Step): boolean => step.name === "mask";
