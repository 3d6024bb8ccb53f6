/** What the eye takes in of a walk, in numbers, as `eigenwalker.gait.appearance` has them (J32, W11). */

import type { Walker } from "../core/stimulus";
import { stanceSpeed, type Path } from "./stanceSpeed";

const N_SAMPLES = 200;

/** What each is called, its unit, and the decimals worth showing. */
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

/** The measures of a walker; NaN where it lacks the markers. */
export function measuresOf(walker: Walker): Record<MeasureName, number> {
  const stride = sinesOf(walker, Array.from({ length: N_SAMPLES }, (_, i) => i / N_SAMPLES));
  const strides = sinesOf(walker, Array.from({ length: N_SAMPLES }, (_, i) => (2 * i) / (N_SAMPLES - 1)));
  const rateHz = ((N_SAMPLES - 1) * walker.frequency_hz) / 2;
  const trunk = walker.markers.includes("pelvis") ? ["pelvis"] : ["left_hip", "right_hip"];
  const ankles = ["left_ankle", "right_ankle"].map((name): Path => {
    const [x, y, z] = [0, 1, 2].map((axis) => along(walker, name, axis, strides));
    return { x: x!, y: y!, z: z! };
  });
  const range = (names: readonly string[], axis: number): number =>
    rangeOf(names.map((name) => along(walker, name, axis, stride)));
  return {
    shoulder_width_mm: Math.hypot(...apart(walker, "shoulder")),
    hip_width_mm: Math.hypot(...apart(walker, "hip")),
    elbow_distance_mm: apart(walker, "elbow")[1]!,
    lateral_sway_mm: range(["left_shoulder", "right_shoulder"], 1),
    vertical_movement_mm: range(trunk, 2),
    frequency_hz: walker.frequency_hz,
    stride_length_mm: stanceSpeed(ankles, rateHz) / walker.frequency_hz,
  };
}

/** From the right joint to the left one in the mean posture. */
function apart({ markers, p0 }: Walker, part: string): number[] {
  const [left, right] = ["left", "right"].map((side) => p0[markers.indexOf(`${side}_${part}`)]);
  return [0, 1, 2].map((axis) => (left?.[axis] ?? NaN) - (right?.[axis] ?? NaN));
}

/** The sine that each posture rides on, at some times in cycles. */
function sinesOf({ harmonics, phases }: Walker, times: readonly number[]): Float64Array[] {
  return harmonics.map((harmonic, i) =>
    Float64Array.from(times, (time) => Math.sin(harmonic * 2 * Math.PI * time + phases[i]!)),
  );
}

/** Where one marker is on one axis, moment by moment. */
function along({ markers, p0, p }: Walker, name: string, axis: number, sines: readonly Float64Array[]): Float64Array {
  const marker = markers.indexOf(name);
  const path = new Float64Array(N_SAMPLES).fill(p0[marker]?.[axis] ?? NaN);
  sines.forEach((sine, i) => {
    const far = p[i]![marker]?.[axis] ?? NaN;
    for (let moment = 0; moment < N_SAMPLES; moment++) path[moment]! += sine[moment]! * far;
  });
  return path;
}

/** How far the middle of some paths moves. */
function rangeOf(paths: readonly Float64Array[]): number {
  const middles = paths[0]!.map(
    (_, moment) => paths.reduce((sum, path) => sum + path[moment]!, 0) / paths.length,
  );
  return Math.max(...middles) - Math.min(...middles);
}
