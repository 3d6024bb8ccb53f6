/** The model of the golden file, and stimuli around its walkers, for tests of the page. */

import golden from "../../tests/golden/model.json";
import { walking } from "../src/core/movingDots";
import type { Stimulus, Walker } from "../src/core/stimulus";
import type { Model } from "../src/model/model";
import { readModel } from "../src/model/readModel";

export const goldenModel = (): Model => readModel(golden.model);

export function stimulusWith(walker: Walker): Stimulus {
  return {
    format: "eigenwalker stimulus",
    version: 1,
    figures: [{ walker, trajectories: null, segments: [], pairs: [], position_mm: [0, 0, 0], heading_deg: 0 }],
    transforms: [],
    view: { view_deg: 0, elevation_deg: 0, eye_distance_mm: null, centre_mm: [0, 0, 900] },
    timing: { duration_s: 1, rate_hz: 60 },
    display: {
      width_px: 100, height_px: 100, px_per_mm: 0.05, dot_px: 3, style: "dots",
      colour: "#ffffff", background: "#000000", viewing_distance_mm: null, px_per_cm: null,
    },
    provenance: {},
  };
}

/** All coordinates at a time in seconds. */
export const posture = (walker: Walker, time: number): number[] => [
  ...walking(walker, [], []).at(time).positions,
];
