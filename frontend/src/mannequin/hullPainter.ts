/** From the figures of a stimulus to hulls, and to whatever draws them. */

import { hasLimbs, type MannequinPainter } from "../canvas/mannequinLoader";
import { drawFlat } from "./flat";
import { bodyHeights, Hulls, mannequinOf, type Mannequin } from "./hulls";
import type { DrawHulls } from "./look";

/** A painter that needs no WebGL: small, and in every page that lets itself be turned. */
export const flatPainter = (): MannequinPainter => makePainter(drawFlat);

export function makePainter(draw: DrawHulls): MannequinPainter {
  const hulls = new Hulls();
  const carved = new WeakMap<object, readonly Mannequin[]>();
  return {
    solid: draw !== drawFlat,
    paint(context, figures, stimulus, fine) {
      let bodies = carved.get(stimulus);
      if (!bodies) {
        const heights = bodyHeights(stimulus);
        bodies = figures.map(({ moving }, i) => mannequinOf(moving.body, heights[i] ?? 0));
        carved.set(stimulus, bodies);
      }
      hulls.clear();
      figures.forEach((shown, i) => {
        if (hasLimbs(shown.moving)) hulls.add(bodies[i]!, shown.positions, shown.visible, stimulus.view);
      });
      const { eye_distance_mm } = stimulus.view;
      draw(context, hulls, { ...stimulus.display, eye_distance_mm, fine });
    },
  };
}
