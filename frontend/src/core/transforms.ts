/** All transforms by their names in a stimulus file. */

import { bodyTransforms } from "./bodyTransforms";
import { dotTransforms } from "./dotTransforms";
import type { MovingDots, Transform, TransformContext, Transforms } from "./movingDots";
import { spatialTransforms } from "./spatialTransforms";
import type { Step, TransformName } from "./stimulus";
import { timeTransforms } from "./timeTransforms";

const TRANSFORMS: Transforms<TransformName> = {
  ...spatialTransforms,
  ...timeTransforms,
  ...bodyTransforms,
  ...dotTransforms,
};

export const transformed = (moving: MovingDots, step: Step, context: TransformContext): MovingDots =>
  (TRANSFORMS[step.name] as Transform<never>)(moving, step as never, context);

/** Whether the result of a transform joins the scene instead of replacing the figure. */
export const addsFigure = (step: Step): boolean => step.name === "mask";
