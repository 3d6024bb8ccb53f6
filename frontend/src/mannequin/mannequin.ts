/** The mannequin: a module of its own, loaded when a stimulus asks for it. */

import { hasLimbs, type MannequinPainter } from "../canvas/mannequin";
import { drawFlat } from "./flat";
import { bodyHeights, Hulls, mannequinOf, type Mannequin } from "./hulls";
import type { DrawHulls } from "./look";
import { solidDrawing } from "./solid";

let shared: MannequinPainter | undefined;

/** What draws mannequins; one for the whole page, as browsers give few contexts of WebGL. */
export function mannequinPainter(): MannequinPainter {
  return (shared ??= makePainter(drawing()));
}

/** In three dimensions, or flat where there is no WebGL. */
function drawing(): DrawHulls {
  try {
    return solidDrawing();
  } catch (error) {
    console.warn("There is no WebGL, so the mannequin is drawn flat:", error);
    return drawFlat;
  }
}

function makePainter(draw: DrawHulls): MannequinPainter {
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
