/** Playing a stimulus: where every dot is at any moment, in the scene and in the picture. */

import { isKnown, Moving, sampled, walking } from "./movingDots";
import { placewise } from "./spatialTransforms";
import type { Figure, Stimulus, View } from "./stimulus";
import { adds, transformed } from "./transforms";
import { dot, observerAxes, radians, type Axes, type Vector } from "./vector";

/** Nearer to the eye than this a dot of a perspective picture is not seen. */
const NEAREST_MM = 1;

/**
 * The figures of a stimulus, transformed and set in the scene, then its masks.
 *
 * The chain acts on each figure in the figure's own frame; then the figure is turned by its heading
 * and moved to its position. A mask is made from its figure as it is at that place of the chain, in
 * the scene, and no later transform changes it.
 */
export function scene(stimulus: Stimulus): Moving[] {
  const { figures, view } = stimulus;
  const moving = figures.map(figureOf);
  const masks: Moving[] = [];
  for (const step of stimulus.transforms) {
    for (const number of step.figures ?? figures.keys()) {
      const [figure, place] = [moving[number]!, figures[number]!];
      if (adds(step)) {
        const stage = { observer: observerOf(view, 0), figure: number };
        masks.push(transformed(placed(figure, place), stage, step));
      } else {
        const stage = { observer: observerOf(view, place.heading_deg), figure: number };
        moving[number] = transformed(figure, stage, step);
      }
    }
  }
  return [...moving.map((figure, number) => placed(figure, figures[number]!)), ...masks];
}

/** The observer's axes in the frame of a figure that is turned to its left by a heading. */
const observerOf = (view: View, headingDeg: number): Axes =>
  observerAxes(view.view_deg + headingDeg, view.elevation_deg);

export function figureOf({ walker, trajectories, segments, pairs }: Figure): Moving {
  if (walker) return walking(walker, segments, pairs);
  return sampled(trajectories!, segments, pairs);
}

/** A figure turned by its heading and moved to its place in the scene. */
function placed(moving: Moving, { position_mm: offset, heading_deg }: Figure): Moving {
  const cosine = Math.cos(radians(heading_deg));
  const sine = Math.sin(radians(heading_deg));
  return placewise(moving, ([x, y, z]) => [
    cosine * x - sine * y + offset[0],
    sine * x + cosine * y + offset[1],
    z + offset[2],
  ]);
}

/** Places in the picture: millimetres to the right of and above its middle, at walkers' scale. */
export interface Picture {
  /** To the right and up, one dot after the other; NaN where not seen. */
  readonly places: Float64Array;
  /** 1 for each dot whose place is known and before the eye. */
  readonly seen: Uint8Array;
}

/**
 * Where dots are in the picture, and whether they are in front of the eye.
 *
 * In perspective, things as far from the eye as the centre of the view keep their size.
 */
export function inPicture(positions: Float64Array, view: View): Picture {
  const [right, up, towards] = observerAxes(view.view_deg, view.elevation_deg);
  const centre = view.centre_mm;
  const eye = view.eye_distance_mm;
  const nDots = positions.length / 3;
  const places = new Float64Array(2 * nDots).fill(NaN);
  const seen = new Uint8Array(nDots);
  for (let i = 0; i < nDots; i++) {
    if (!isKnown(positions, 3 * i)) continue;
    const way: Vector = [
      positions[3 * i]! - centre[0],
      positions[3 * i + 1]! - centre[1],
      positions[3 * i + 2]! - centre[2],
    ];
    const away = eye === null ? Infinity : eye - dot(way, towards);
    if (away < NEAREST_MM) continue;
    const scale = eye === null ? 1 : eye / away;
    places[2 * i] = dot(way, right) * scale;
    places[2 * i + 1] = dot(way, up) * scale;
    seen[i] = 1;
  }
  return { places, seen };
}
