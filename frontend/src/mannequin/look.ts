/** How the mannequin is lit and coloured, and what draws its hulls. */

import type { Hulls } from "./hulls";

/** How large a picture is, from where it is seen, and in what colour. */
export interface Look {
  readonly width_px: number;
  readonly height_px: number;
  readonly px_per_mm: number;
  readonly eye_distance_mm: number | null;
  readonly colour: string;
  /** Pixels of the canvas for one of the picture. */
  readonly fine: number;
}

/** Draws all hulls, the nearer before the farther, over what the canvas shows. */
export type DrawHulls = (context: CanvasRenderingContext2D, hulls: Hulls, look: Look) => void;

/** Where the light comes from, seen by the observer: right, up, towards. */
export const LIGHT = [-0.44, 0.67, 0.6] as const;

/** How much of white light the varnish throws back. */
const VARNISH = 0.1;

/** Red, green and blue, 0 to 1, of a colour like `#ffffff` in full light. */
export function litColour(colour: string): [number, number, number] {
  const part = (i: number): number => {
    const share = parseInt(colour.slice(i, i + 2), 16) / 255;
    return share + VARNISH * (1 - share);
  };
  return [part(1), part(3), part(5)];
}
