/** The mannequin as pages ask for it: its module is loaded then, and not before. */

import type { Moving } from "../core/movingDots";
import type { Stimulus } from "../core/stimulus";
import type { Shown } from "./figureFrames";

export interface MannequinPainter {
  /** Whether it draws in three dimensions; without WebGL it draws flat. */
  readonly solid: boolean;
  /**
   * Draw the figures of a stimulus that have limbs, the nearer before the farther, over what the
   * canvas shows. `fine` is how many of its pixels are one of the picture; the context is scaled so.
   */
  paint(
    context: CanvasRenderingContext2D,
    figures: readonly Shown[],
    stimulus: Stimulus,
    fine: number,
  ): void;
}

/** What `mannequin/mannequin.ts` gives. */
export interface MannequinModule {
  mannequinPainter(): MannequinPainter;
}

/** Whether a figure can be a mannequin: masks, limb dots and blobs, which have no limbs, cannot. */
export const hasLimbs = ({ body, blurMm }: Moving): boolean => body.segments.length > 0 && blurMm === 0;

/** The painter whose module a page holds as text, in a script element with the id `mannequin`. */
export async function heldMannequin(): Promise<MannequinPainter> {
  const text = document.querySelector("script#mannequin")?.textContent?.trim();
  if (!text) throw new Error("This page does not hold the mannequin; make it anew with the style 'mannequin'.");
  return mannequinFrom(text);
}

/** The painter of a module that is there as text. */
export async function mannequinFrom(text: string): Promise<MannequinPainter> {
  const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  try {
    const module = (await import(/* @vite-ignore */ address)) as MannequinModule;
    return module.mannequinPainter();
  } finally {
    URL.revokeObjectURL(address);
  }
}
