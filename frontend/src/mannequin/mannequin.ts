/** The mannequin: a module of its own, loaded when a stimulus asks for it. */

import type { MannequinPainter } from "../canvas/mannequinLoader";
import { drawFlat } from "./flat";
import type { DrawHulls } from "./look";
import { makePainter } from "./hullPainter";
import { solidDrawing } from "./solid";

/** Under which three.js, which this module holds, may be passed on: the text goes with it. */
export { default as licence } from "../../node_modules/three/LICENSE?raw";

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
