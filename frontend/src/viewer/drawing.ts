/** Background, trails and ground of the viewer. */

import { dot, type Vector } from "../core/vector";
import type { Arrangement, Size } from "./arrangement";
import type { ViewPoint } from "./walkerBatch";

const TRAIL_S = 0.6;
const N_TRAIL_STEPS = 18;
/** Opacity of a trail at the dot. */
const TRAIL_OPACITY = 0.8;
/** Radius of the ground below a walker, in diameters of a dot: it does not go with the walker. */
const GROUND_PER_DOT = 13;
const N_GROUND_CORNERS = 48;

/** Colours of the viewer; the style sheet of the page has the same. */
export interface Palette {
  readonly background: string;
  readonly colour: string;
  /** Of the mannequin, whose shades are darker. */
  readonly body: string;
  readonly ground: string;
}

const DARK: Palette = { background: "#0c0d0f", colour: "#ffffff", body: "#ffffff", ground: "#16191e" };
const LIGHT: Palette = { background: "#f8f7f3", colour: "#16181c", body: "#c9bfae", ground: "#efede6" };

export const paletteOf = (dark: boolean): Palette => (dark ? DARK : LIGHT);

export interface Brush {
  readonly context: CanvasRenderingContext2D;
  readonly palette: Palette;
  readonly dotPx: number;
}

/** The paths of the dots in the last moments, fading; `project` gives the places at a time. */
export function drawTrails(
  { context, palette, dotPx }: Brush,
  project: (time: number, into: Float64Array) => void,
  time: number,
  size: number,
): void {
  context.strokeStyle = palette.colour;
  context.lineCap = "butt";
  let [newer, older] = [new Float64Array(size), new Float64Array(size)];
  project(time, newer);
  for (let step = 1; step <= N_TRAIL_STEPS; step++) {
    project(time - (step * TRAIL_S) / N_TRAIL_STEPS, older);
    const left = 1 - step / (N_TRAIL_STEPS + 1);
    context.globalAlpha = TRAIL_OPACITY * left;
    context.lineWidth = Math.max(0.5 * dotPx * left, 0.75);
    context.beginPath();
    for (let i = 0; i < size; i += 2) {
      context.moveTo(newer[i]!, newer[i + 1]!);
      context.lineTo(older[i]!, older[i + 1]!);
    }
    context.stroke();
    [newer, older] = [older, newer];
  }
  context.globalAlpha = 1;
}

/** A disc on the floor below each walker, which shows the elevation of the view. */
export function drawGround(
  { context, palette, dotPx }: Brush,
  { offsets, middleMm, pxPerMm }: Arrangement,
  { axes: [right, up, towards], eyeMm }: ViewPoint,
  { width_px, height_px }: Size,
): void {
  context.fillStyle = palette.ground;
  const radius = (GROUND_PER_DOT * dotPx) / pxPerMm;
  for (const [across, above] of offsets) {
    context.beginPath();
    for (let corner = 0; corner < N_GROUND_CORNERS; corner++) {
      const angle = (2 * Math.PI * corner) / N_GROUND_CORNERS;
      const at: Vector = [radius * Math.cos(angle), radius * Math.sin(angle), -middleMm];
      const scale = pxPerMm * (eyeMm === null ? 1 : eyeMm / (eyeMm - dot(at, towards)));
      context.lineTo(width_px / 2 + scale * (dot(at, right) + across), height_px / 2 - scale * (dot(at, up) + above));
    }
    context.fill();
  }
}
