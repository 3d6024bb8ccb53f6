/** Places of dots in the picture of a stimulus, in pixels, moment by moment. */

import type { Moment, MovingDots } from "../core/movingDots";
import { inPicture, scene } from "../core/scene";
import type { Stimulus } from "../core/stimulus";

/** One figure, or the dots of one mask, at one moment. */
export interface FigureFrame extends Moment {
  readonly moving: MovingDots;
  /** Pixels from the left and the upper edge of the picture, one dot after the other. */
  readonly places: Float64Array;
}

/** The function that gives all figures of a stimulus at a time in seconds. */
export function framesOf(stimulus: Stimulus): (time: number) => FigureFrame[] {
  const figures = scene(stimulus);
  const { width_px, height_px, px_per_mm } = stimulus.display;
  return (time) =>
    figures.map((moving) => {
      const { positions, visible } = moving.at(time);
      const { places, seen } = inPicture(positions, stimulus.view);
      const inPixels = places.map((place, i) =>
        i % 2 === 0 ? width_px / 2 + px_per_mm * place : height_px / 2 - px_per_mm * place,
      );
      return { moving, places: inPixels, positions, visible: visible.map((is, dot) => is & seen[dot]!) };
    });
}
