/** The mannequin: a module of its own, which a page loads on demand. */

import type { MannequinPainter } from "../canvas/mannequinLoader";
import { flatPainter, makePainter } from "./hullPainter";
import { solidDrawing } from "./solid";

/** The licence of three.js, which this module includes. */
export { default as licence } from "../../node_modules/three/LICENSE?raw";

let shared: MannequinPainter | undefined;

/** The painter of mannequins: one for the whole page, as browsers limit the number of WebGL contexts. */
export const mannequinPainter = (): MannequinPainter => (shared ??= newPainter());

/** In three dimensions, or flat where there is no WebGL. */
function newPainter(): MannequinPainter {
  try {
    return makePainter(solidDrawing());
  } catch (error) {
    console.warn("There is no WebGL, so the mannequin is drawn flat:", error);
    return flatPainter();
  }
}
