/** Where walkers stand in a picture, and how large: each in the middle of a cell of its own. */

import type { Walker } from "../core/stimulus";
import { radians } from "../core/vector";

/** Share of a cell that a walker fills. */
const FILLED = 0.84;
/** Diameter of a dot at the scale of the walker, as in Python. */
const DOT_MM = 36;
const LEAST_DOT_PX = 2;
/** From the eye to the middle of the scene, where the picture is in perspective. */
const LEAST_EYE_MM = 3000;
const MOMENTS = 16;
/** Room that is kept beyond that of the average walker, so that most caricatures change no scale. */
const SPARE = 1.06;

/** The room that a walker takes, however it is turned. */
export interface Room {
  /** About the upright line through the middle of its mean posture. */
  readonly radius: number;
  /** From the floor. */
  readonly height: number;
}

export interface Size {
  readonly width_px: number;
  readonly height_px: number;
}

export interface Staging {
  readonly columns: number;
  readonly rows: number;
  readonly pxPerMm: number;
  readonly dotPx: number;
  /** Height that is in the middle of the picture. */
  readonly middleMm: number;
  readonly eyeMm: number;
  /** Of each walker, from the middle of the picture to the right and up, in mm. */
  readonly offsets: readonly (readonly [number, number])[];
}

/** The place of a walker's mean posture on the floor: the middle of its extent. */
export function middleOf({ p0 }: Walker): readonly [number, number] {
  const between = (axis: 0 | 1): number => {
    const places = p0.map((place) => place[axis]);
    return (Math.min(...places) + Math.max(...places)) / 2;
  };
  return [between(0), between(1)];
}

export function roomOf(walker: Walker): Room {
  const { harmonics, phases, p0, p } = walker;
  const [x0, y0] = middleOf(walker);
  let [farSquared, height] = [1, 1];
  for (let moment = 0; moment < MOMENTS; moment++) {
    const angle = (2 * Math.PI * moment) / MOMENTS;
    const sines = harmonics.map((harmonic, i) => Math.sin(harmonic * angle + phases[i]!));
    for (let dot = 0; dot < p0.length; dot++) {
      let [x, y, z] = p0[dot]!;
      for (let i = 0; i < sines.length; i++) {
        const far = p[i]![dot]!;
        x += sines[i]! * far[0];
        y += sines[i]! * far[1];
        z += sines[i]! * far[2];
      }
      farSquared = Math.max(farSquared, (x - x0) * (x - x0) + (y - y0) * (y - y0));
      height = Math.max(height, z);
    }
  }
  return { radius: Math.sqrt(farSquared), height };
}

/** The room that any of some walkers takes; never less than the usual one and some to spare. */
export function sharedRoom(usual: Room, walkers: readonly Walker[]): Room {
  const rooms = walkers.map(roomOf);
  return {
    radius: Math.max(SPARE * usual.radius, ...rooms.map(({ radius }) => radius)),
    height: Math.max(SPARE * usual.height, ...rooms.map(({ height }) => height)),
  };
}

/** Set so many walkers in rows and columns, as large as the picture allows. */
export function stagingOf(count: number, room: Room, size: Size, elevationDeg: number): Staging {
  const lean = Math.abs(Math.sin(radians(elevationDeg)));
  const across = (2 * room.radius) / FILLED;
  const above = (room.height * Math.cos(radians(elevationDeg)) + 2 * room.radius * lean) / FILLED;
  const scaleOf = (columns: number): number => {
    const rows = Math.ceil(count / columns);
    return Math.min(size.width_px / columns / across, size.height_px / rows / above);
  };
  const choices = Array.from({ length: count }, (_, i) => i + 1);
  const columns = choices.reduce((best, n) => (scaleOf(n) > scaleOf(best) * 1.0001 ? n : best), 1);
  const rows = Math.ceil(count / columns);
  const pxPerMm = Math.max(scaleOf(columns), 1e-4);
  const [wide, high] = [size.width_px / pxPerMm / columns, size.height_px / pxPerMm / rows];
  const offsets = Array.from({ length: count }, (_, i) => {
    const [row, column] = [Math.floor(i / columns), i % columns];
    const inRow = Math.min(columns, count - row * columns);
    return [(column - (inRow - 1) / 2) * wide, ((rows - 1) / 2 - row) * high] as const;
  });
  const extent = Math.max(size.width_px, size.height_px) / pxPerMm;
  return {
    columns,
    rows,
    pxPerMm,
    dotPx: Math.max(DOT_MM * pxPerMm, LEAST_DOT_PX),
    middleMm: room.height / 2,
    eyeMm: count === 1 ? LEAST_EYE_MM : Math.max(LEAST_EYE_MM, 1.5 * extent),
    offsets,
  };
}

/** The part of a picture that a walker has for itself, in its pixels. */
export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

export function boxesOf({ columns, rows, offsets, pxPerMm }: Staging, size: Size): Box[] {
  const [width, height] = [size.width_px / columns, size.height_px / rows];
  return offsets.map(([right, up]) => ({
    left: size.width_px / 2 + right * pxPerMm - width / 2,
    top: size.height_px / 2 - up * pxPerMm - height / 2,
    width,
    height,
  }));
}
