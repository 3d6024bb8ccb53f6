/** From the figures of a stimulus to hulls, and to a function that draws them. */

import { hasLimbs, type MannequinPainter } from "../canvas/mannequinLoader";
import { drawFlat } from "./flat";
import { bodyHeights, Hulls, mannequinOf, type DrawHulls, type Mannequin } from "./hulls";

/** A small painter that needs no WebGL; pages with a viewer include it. */
export const flatPainter = (): MannequinPainter => makePainter(drawFlat);

export function makePainter(draw: DrawHulls): MannequinPainter {
  const hulls = new Hulls();
  const mannequins = new WeakMap<object, readonly Mannequin[]>();
  return {
    solid: draw !== drawFlat,
    paint(context, figures, stimulus, pixelRatio) {
      let bodies = mannequins.get(stimulus);
      if (!bodies) {
        const heights = bodyHeights(stimulus);
        bodies = figures.map(({ moving }, i) => mannequinOf(moving.body, heights[i] ?? 0));
        mannequins.set(stimulus, bodies);
      }
      hulls.clear();
      figures.forEach(({ moving, positions, visible }, i) => {
        if (hasLimbs(moving)) hulls.add(bodies[i]!, positions, visible, stimulus.view);
      });
      const { eye_distance_mm } = stimulus.view;
      draw(context, hulls, { ...stimulus.display, eye_distance_mm, pixelRatio });
    },
  };
}
