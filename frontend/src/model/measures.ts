/** Visible measures of a walk, as in Python's `eigenwalker.gait.appearance`. */

import { coefficientsOf, posture } from "../core/posture";
import type { Walker } from "../core/stimulus";

const N_SAMPLES = 200;
const SHOULDERS = ["left_shoulder", "right_shoulder"];
const ANKLES = ["left_ankle", "right_ankle"];
/** Share of the stride in which an ankle is in its stance phase: when it is lowest. */
const STANCE_SHARE = 0.35;
/** A low ankle stands if it moves with the ground at least at this share of the median speed. */
const MIN_STANDING_SPEED = 0.7;

/** Name, label, unit, and the number of decimals to show. */
export const MEASURES = [
  { name: "shoulder_width_mm", label: "shoulder width", unit: "mm", digits: 0 },
  { name: "hip_width_mm", label: "hip width", unit: "mm", digits: 0 },
  { name: "elbow_distance_mm", label: "elbows apart", unit: "mm", digits: 0 },
  { name: "lateral_sway_mm", label: "sway from side to side", unit: "mm", digits: 0 },
  { name: "vertical_movement_mm", label: "up and down", unit: "mm", digits: 0 },
  { name: "frequency_hz", label: "strides a second", unit: "Hz", digits: 2 },
  { name: "stride_length_mm", label: "stride length", unit: "mm", digits: 0 },
] as const;

export type MeasureName = (typeof MEASURES)[number]["name"];
export type Measures = Readonly<Record<MeasureName, number>>;

/** The measures of a walker, whose speed is that of its feet times a factor; NaN if it lacks the markers. */
export function measuresOf(walker: Walker, speedFactor = 1): Measures {
  const { frequency_hz } = walker;
  const trunk = walker.markers.includes("pelvis") ? ["pelvis"] : ["left_hip", "right_hip"];
  const moving = withMarkers(walker, [...SHOULDERS, ...trunk, ...ANKLES]);
  const { markers } = moving;
  const one = sampled(moving, (i) => i / N_SAMPLES);
  const two = sampled(moving, (i) => (2 * i) / (N_SAMPLES - 1));
  const rateHz = ((N_SAMPLES - 1) * frequency_hz) / 2;
  const ankles = ANKLES.map((name) => [0, 1, 2].map((axis) => pathOf(markers, two, name, axis)));
  const range = (names: readonly string[], axis: number): number =>
    rangeOf(names.map((name) => pathOf(markers, one, name, axis)));
  return {
    shoulder_width_mm: Math.hypot(...sideDistance(walker, "shoulder")),
    hip_width_mm: Math.hypot(...sideDistance(walker, "hip")),
    elbow_distance_mm: sideDistance(walker, "elbow")[1]!,
    lateral_sway_mm: range(SHOULDERS, 1),
    vertical_movement_mm: range(trunk, 2),
    frequency_hz,
    stride_length_mm: (speedFactor * stanceSpeed(ankles, rateHz)) / frequency_hz,
  };
}

/** The walker with fewer markers, which is faster to sample. */
function withMarkers(walker: Walker, names: readonly string[]): Walker {
  const used = [...walker.markers.keys()].filter((i) => names.includes(walker.markers[i]!));
  const pick = <T>(values: readonly T[]): T[] => used.map((i) => values[i]!);
  return { ...walker, markers: pick(walker.markers), p0: pick(walker.p0), p: walker.p.map(pick) };
}

/** From the right joint to the left one in the mean posture. */
function sideDistance({ markers, p0 }: Walker, part: string): number[] {
  const [left, right] = ["left", "right"].map((side) => p0[markers.indexOf(`${side}_${part}`)]);
  return [0, 1, 2].map((axis) => (left?.[axis] ?? NaN) - (right?.[axis] ?? NaN));
}

/** Postures at moments of the walk, in strides. */
function sampled(walker: Walker, strides: (sample: number) => number): Float64Array[] {
  const coefficients = coefficientsOf(walker);
  return Array.from({ length: N_SAMPLES }, (_, i) => posture(coefficients, 2 * Math.PI * strides(i)));
}

type Path = Float64Array;

/** One coordinate of one marker, moment by moment. */
function pathOf(markers: readonly string[], postures: readonly Float64Array[], name: string, axis: number): Path {
  const marker = markers.indexOf(name);
  const path = new Float64Array(postures.length);
  for (let i = 0; i < path.length; i++) path[i] = postures[i]![3 * marker + axis] ?? NaN;
  return path;
}

function rangeOf(paths: readonly Path[]): number {
  const middles = paths[0]!.map((_, moment) => mean(paths.map((path) => path[moment]!)));
  return Math.max(...middles) - Math.min(...middles);
}

/**
 * The forward speed of a walk in place, in mm/s, from the feet that stand: the ground moves backwards
 * with them. As Python's `stance_speed`; each ankle has paths of x, y and z.
 */
function stanceSpeed(ankles: readonly Path[][], rateHz: number): number {
  return -mean(ankles.map(([x, y, z]) => standingVelocity(x!, y!, z!, rateHz)));
}

/** The velocity of an ankle along x while it stands. */
function standingVelocity(x: Path, y: Path, z: Path, rateHz: number): number {
  const velocity = { x: gradient(x, rateHz), y: gradient(y, rateHz) };
  const limit = quantile([...z], STANCE_SHARE);
  const low = [...z.keys()].filter((moment) => z[moment]! <= limit);
  const usual = [mean(low.map((m) => velocity.x[m]!)), mean(low.map((m) => velocity.y[m]!))] as const;
  const length = Math.max(Math.hypot(...usual), 1e-9);
  const along = low.map((m) => (velocity.x[m]! * usual[0] + velocity.y[m]! * usual[1]) / length);
  const least = MIN_STANDING_SPEED * quantile(along, 0.5);
  return mean(low.filter((_, i) => along[i]! >= least).map((m) => velocity.x[m]!));
}

/** Change per second: over two samples, over one at the ends. */
function gradient(path: Path, rateHz: number): Path {
  const last = path.length - 1;
  return path.map((_, i) => {
    const [before, after] = [Math.max(i - 1, 0), Math.min(i + 1, last)];
    return ((path[after]! - path[before]!) * rateHz) / (after - before);
  });
}

function quantile(values: readonly number[], share: number): number {
  const sorted = values.toSorted((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const below = Math.floor(place);
  const [low, high] = [sorted[below]!, sorted[Math.min(below + 1, sorted.length - 1)]!];
  return low + (place - below) * (high - low);
}

const mean = (values: readonly number[]): number =>
  values.reduce((sum, value) => sum + value, 0) / values.length;
