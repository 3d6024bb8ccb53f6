/** The positions of all dots of a stimulus at any moment, in the scene and in the picture. */

import { bodyTransforms } from "./bodyTransforms";
import { dotTransforms } from "./dotTransforms";
import {
  figureOf, isKnown, MovingDots, positionOf,
  type Transform, type TransformContext, type Transforms,
} from "./movingDots";
import { mapPositions, spatialTransforms } from "./spatialTransforms";
import type { Figure, Step, Stimulus, TransformName, View } from "./stimulus";
import { timeTransforms } from "./timeTransforms";
import { dot, minus, observerAxes, radians } from "./vector";

/** A dot nearer to the eye than this is not visible in perspective. */
const NEAREST_MM = 1;

/**
 * The figures of a stimulus, transformed and placed in the scene, then its masks.
 *
 * The chain acts on each figure in the figure's own frame; then the figure is turned by its heading
 * and moved to its position. A mask is made from its figure at that place of the chain, in the scene,
 * and no later transform changes it.
 */
export function scene({ figures, transforms, view }: Stimulus): MovingDots[] {
  const moving = figures.map(figureOf);
  const masks: MovingDots[] = [];
  const observer = (headingDeg: number) => observerAxes(view.view_deg + headingDeg, view.elevation_deg);
  for (const step of transforms) {
    for (const number of step.figures ?? figures.keys()) {
      const [dots, figure] = [moving[number]!, figures[number]!];
      if (addsFigure(step)) {
        masks.push(transformed(placed(dots, figure), step, { observer: observer(0), figure: number }));
      } else {
        moving[number] = transformed(dots, step, { observer: observer(figure.heading_deg), figure: number });
      }
    }
  }
  return [...moving.map((dots, number) => placed(dots, figures[number]!)), ...masks];
}

/** A figure turned by its heading and moved to its position in the scene. */
function placed(moving: MovingDots, { position_mm: offset, heading_deg }: Figure): MovingDots {
  const cosine = Math.cos(radians(heading_deg));
  const sine = Math.sin(radians(heading_deg));
  return mapPositions(moving, ([x, y, z]) => [
    cosine * x - sine * y + offset[0],
    sine * x + cosine * y + offset[1],
    z + offset[2],
  ]);
}

/** Places of dots in the picture. */
export interface Picture {
  /** Millimetres of the scene to the right of and above the middle, one dot after the other; NaN where not seen. */
  readonly places: Float64Array;
  /** 1 for each dot that is known and in front of the eye. */
  readonly seen: Uint8Array;
}

/** Project positions into the picture; in perspective, things at the centre of the view keep their size. */
export function inPicture(positions: Float64Array, view: View): Picture {
  const [right, up, towards] = observerAxes(view.view_deg, view.elevation_deg);
  const eye = view.eye_distance_mm;
  const nDots = positions.length / 3;
  const places = new Float64Array(2 * nDots).fill(NaN);
  const seen = new Uint8Array(nDots);
  for (let i = 0; i < nDots; i++) {
    if (!isKnown(positions, 3 * i)) continue;
    const from = minus(positionOf(positions, i), view.centre_mm);
    const away = eye === null ? Infinity : eye - dot(from, towards);
    if (away < NEAREST_MM) continue;
    const scale = eye === null ? 1 : eye / away;
    places[2 * i] = dot(from, right) * scale;
    places[2 * i + 1] = dot(from, up) * scale;
    seen[i] = 1;
  }
  return { places, seen };
}

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
