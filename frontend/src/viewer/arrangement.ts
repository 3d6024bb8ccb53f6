/** The arrangement of walkers in a picture: each in the middle of its own cell, as large as possible. */

import { coefficientsOf, posture } from "../core/posture";
import type { Display, Walker } from "../core/stimulus";
import { radians } from "../core/vector";

/** Share of a cell that a walker fills. */
const FILL = 0.84;
/**
 * Diameter of a dot at the scale at which a usual walker fills a cell: it does not go with the walkers
 * that are shown, and so tells nothing about them.
 */
const DOT_MM = 36;
const USUAL: Extent = { radius: 450, height: 1600 };
const MIN_DOT_PX = 2;
/** Least distance from the eye to the middle of the scene in perspective. */
const MIN_EYE_MM = 3000;
const N_MOMENTS = 16;
/** Margin beyond the average walker, so that most caricatures do not change the scale. */
const MARGIN = 1.06;

/** The space that a walker needs at any azimuth. */
export interface Extent {
  /** About the vertical through the centre of its mean posture. */
  readonly radius: number;
  /** Above the floor. */
  readonly height: number;
}

export type Size = Pick<Display, "width_px" | "height_px">;

/** The cell of a walker in the picture, in pixels. */
export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

export interface Arrangement {
  readonly pxPerMm: number;
  readonly dotPx: number;
  /** Height in the middle of the picture. */
  readonly middleMm: number;
  readonly eyeMm: number;
  /** For each walker, from the middle of the picture to the right and up, in mm. */
  readonly offsets: readonly (readonly [number, number])[];
  readonly boxes: readonly Box[];
}

/** The centre of a walker's mean posture on the floor: the middle of its extent. */
export function centreOf({ p0 }: Walker): readonly [number, number] {
  const middle = (axis: 0 | 1): number => {
    const values = p0.map((place) => place[axis]);
    return (Math.min(...values) + Math.max(...values)) / 2;
  };
  return [middle(0), middle(1)];
}

export function extentOf(walker: Walker): Extent {
  const coefficients = coefficientsOf(walker);
  const [x0, y0] = centreOf(walker);
  const positions = new Float64Array(3 * walker.p0.length);
  let [squared, height] = [1, 1];
  for (let moment = 0; moment < N_MOMENTS; moment++) {
    posture(coefficients, (2 * Math.PI * moment) / N_MOMENTS, positions);
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y] = [positions[i]! - x0, positions[i + 1]! - y0];
      squared = Math.max(squared, x * x + y * y);
      height = Math.max(height, positions[i + 2]!);
    }
  }
  return { radius: Math.sqrt(squared), height };
}

/** The space for each of some walkers: at least that of the average walker with a margin. */
export function sharedExtent(average: Walker, walkers: readonly Walker[]): Extent {
  const { radius, height } = extentOf(average);
  const extents = [{ radius: MARGIN * radius, height: MARGIN * height }, ...walkers.map(extentOf)];
  return {
    radius: Math.max(...extents.map((extent) => extent.radius)),
    height: Math.max(...extents.map((extent) => extent.height)),
  };
}

/** Arrange a number of walkers in rows and columns, as large as the picture allows times `zoom`. */
export function arrange(count: number, extent: Extent, size: Size, elevationDeg: number, zoom = 1): Arrangement {
  const tilt = Math.abs(Math.sin(radians(elevationDeg)));
  const needed = ({ radius, height }: Extent): { across: number; above: number } => ({
    across: (2 * radius) / FILL,
    above: (height * Math.cos(radians(elevationDeg)) + 2 * radius * tilt) / FILL,
  });
  const { across, above } = needed(extent);
  const scaleOf = (columns: number): number => {
    const rows = Math.ceil(count / columns);
    return Math.min(size.width_px / columns / across, size.height_px / rows / above);
  };
  const choices = Array.from({ length: count }, (_, i) => i + 1);
  const columns = choices.reduce((best, n) => (scaleOf(n) > scaleOf(best) * 1.0001 ? n : best), 1);
  const rows = Math.ceil(count / columns);
  const pxPerMm = Math.max(zoom * scaleOf(columns), 1e-4);
  const [width, height] = [(zoom * size.width_px) / columns, (zoom * size.height_px) / rows];
  const offsets = Array.from({ length: count }, (_, i) => {
    const [row, column] = [Math.floor(i / columns), i % columns];
    const inRow = Math.min(columns, count - row * columns);
    return [((column - (inRow - 1) / 2) * width) / pxPerMm, (((rows - 1) / 2 - row) * height) / pxPerMm] as const;
  });
  const boxes = offsets.map(([right, up]) => ({
    left: size.width_px / 2 + right * pxPerMm - width / 2,
    top: size.height_px / 2 - up * pxPerMm - height / 2,
    width,
    height,
  }));
  return {
    pxPerMm,
    dotPx: Math.max(DOT_MM * Math.min(width / needed(USUAL).across, height / needed(USUAL).above), MIN_DOT_PX),
    middleMm: extent.height / 2,
    eyeMm: count === 1 ? MIN_EYE_MM : Math.max(MIN_EYE_MM, (1.5 * zoom * Math.max(size.width_px, size.height_px)) / pxPerMm),
    offsets,
    boxes,
  };
}
