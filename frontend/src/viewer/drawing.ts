/** Dots, sticks, trails and the ground, for many walkers with few calls to the canvas. */

import { dot, type Vector } from "../core/vector";
import type { Palette } from "./palette";
import type { Size, Staging } from "./arrangement";
import type { Sight } from "./walkerBatch";

/** Width of a stick beside the diameter of a dot. */
const STICK = 0.6;
const TRAIL_S = 0.6;
const TRAIL_STEPS = 18;
/** How strong a trail is where it begins. */
const TRAIL_LIGHT = 0.8;
const GROUND_MM = 470;
const GROUND_CORNERS = 48;

export interface Ink {
  readonly context: CanvasRenderingContext2D;
  readonly palette: Palette;
  readonly dotPx: number;
}

/** Begin a frame: from here on a unit is a pixel of the picture, `fine` pixels of the canvas. */
export function clear({ context, palette }: Ink, { width_px, height_px }: Size, fine: number): void {
  context.setTransform(fine, 0, 0, fine, 0, 0);
  context.fillStyle = palette.background;
  context.fillRect(0, 0, width_px, height_px);
}

/** One path for each walker: a single path of all dots is slower to fill. */
export function drawDots({ context, palette, dotPx }: Ink, places: Float64Array, nDots: number): void {
  const radius = dotPx / 2;
  context.fillStyle = palette.colour;
  for (let from = 0; from < places.length; from += 2 * nDots) {
    context.beginPath();
    for (let i = from; i < from + 2 * nDots; i += 2) {
      context.moveTo(places[i]! + radius, places[i + 1]!);
      context.arc(places[i]!, places[i + 1]!, radius, 0, 2 * Math.PI);
    }
    context.fill();
  }
}

/** Ends of segments are numbers of dots, two by two. */
export function drawSticks(
  { context, palette, dotPx }: Ink,
  places: Float64Array,
  segments: Uint16Array,
  nDots: number,
): void {
  context.strokeStyle = palette.colour;
  context.lineWidth = Math.max(STICK * dotPx, 1);
  context.lineCap = "round";
  for (let from = 0; from < places.length; from += 2 * nDots) {
    context.beginPath();
    for (let i = 0; i < segments.length; i += 2) {
      const [one, other] = [from + 2 * segments[i]!, from + 2 * segments[i + 1]!];
      context.moveTo(places[one]!, places[one + 1]!);
      context.lineTo(places[other]!, places[other + 1]!);
    }
    context.stroke();
  }
}

/** Where the dots were in the last moments, fainter the longer ago; `see` tells it of a time. */
export function drawTrails(
  { context, palette, dotPx }: Ink,
  see: (time: number, into: Float64Array) => void,
  time: number,
  size: number,
): void {
  context.strokeStyle = palette.colour;
  context.lineCap = "butt";
  let [newer, older] = [new Float64Array(size), new Float64Array(size)];
  see(time, newer);
  for (let step = 1; step <= TRAIL_STEPS; step++) {
    see(time - (step * TRAIL_S) / TRAIL_STEPS, older);
    const left = 1 - step / (TRAIL_STEPS + 1);
    context.globalAlpha = TRAIL_LIGHT * left;
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

/** A disc on the floor below each walker, which shows how the view is tilted. */
export function drawGround({ context, palette }: Ink, staging: Staging, { axes, eyeMm }: Sight, size: Size): void {
  const [right, up, towards] = axes;
  context.fillStyle = palette.faint;
  for (const [across, above] of staging.offsets) {
    context.beginPath();
    for (let corner = 0; corner < GROUND_CORNERS; corner++) {
      const angle = (2 * Math.PI * corner) / GROUND_CORNERS;
      const at: Vector = [GROUND_MM * Math.cos(angle), GROUND_MM * Math.sin(angle), -staging.middleMm];
      const scale = staging.pxPerMm * (eyeMm === null ? 1 : eyeMm / (eyeMm - dot(at, towards)));
      const x = size.width_px / 2 + scale * (dot(at, right) + across);
      const y = size.height_px / 2 - scale * (dot(at, up) + above);
      context.lineTo(x, y);
    }
    context.fill();
  }
}
