/** The mannequin for pages that need it: its module is loaded on demand. */

import type { MovingDots } from "../core/movingDots";
import type { Stimulus } from "../core/stimulus";
import type { FigureFrame } from "./figureFrames";

export interface MannequinPainter {
  /** Whether it draws in three dimensions; without WebGL it draws flat. */
  readonly solid: boolean;
  /**
   * Draw the figures of a stimulus that have limbs over the present content of the canvas, the farther
   * first. `pixelRatio` canvas pixels are one pixel of the picture; the context is scaled so.
   */
  paint(
    context: CanvasRenderingContext2D,
    figures: readonly FigureFrame[],
    stimulus: Stimulus,
    pixelRatio: number,
  ): void;
}

/** Whether a figure can be a mannequin: masks, limb dots and blobs have no limbs. */
export const hasLimbs = ({ body, blurMm, blurPx }: MovingDots): boolean =>
  body.segments.length > 0 && blurMm === 0 && blurPx === 0;

/** The painter from the module in the script element `mannequin` of the page. */
export async function mannequinInPage(): Promise<MannequinPainter> {
  const text = document.querySelector("script#mannequin")?.textContent?.trim();
  if (!text) throw new Error("This page does not hold the mannequin; make it anew with the style 'mannequin'.");
  return mannequinFrom(text);
}

/** The painter from the text of `mannequin/mannequin.ts`, built. */
export async function mannequinFrom(text: string): Promise<MannequinPainter> {
  const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  try {
    const module = (await import(/* @vite-ignore */ address)) as { mannequinPainter(): MannequinPainter };
    return module.mannequinPainter();
  } finally {
    URL.revokeObjectURL(address);
  }
}
