/** What is on the stage, as the content of a stimulus file. */

import type { Figure, Step, Stimulus } from "../core/stimulus";
import { observerAxes, type Vector } from "../core/vector";
import type { Cast } from "../model/figures";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import { walkerOf } from "../model/features";
import { chained } from "./transformChain";
import { paletteOf } from "./palette";
import { middleOf, roomOf, sharedRoom, stagingOf, type Room, type Size, type Staging } from "./arrangement";

/** Figures that a file may hold. */
export const MOST_FIGURES = 64;
/** How long a stimulus that is kept lasts. */
export const DURATION_S = 4;
const RATE_HZ = 60;
const USUAL_SIZE: Size = { width_px: 640, height_px: 640 };

/** The stimulus that a visitor sees, to be kept: `Stimulus.from_json` of Python takes it. */
export function stimulusOf(
  model: Model,
  cast: readonly Cast[],
  state: State,
  size: Size = USUAL_SIZE,
): Stimulus {
  const shown = cast.slice(0, MOST_FIGURES);
  const staging = stagingOf(shown.length, roomFor(model, shown), size, state.elevation_deg);
  return stagedStimulus(model, shown, state, size, staging);
}

/** The room that each of a cast is given. */
export const roomFor = (model: Model, cast: readonly Cast[]): Room =>
  sharedRoom(roomOf(walkerOf(model, model.average)), cast.map(({ walker }) => walker));

/**
 * The stimulus of a cast that stands in its places.
 *
 * Its chain begins with the steps given; a figure that turns by itself starts from an angle.
 */
export function stagedStimulus(
  model: Model,
  cast: readonly Cast[],
  state: State,
  size: Size,
  staging: Staging,
  first: readonly Step[] = [],
  turn_deg = 0,
): Stimulus {
  const palette = paletteOf(state.dark);
  const middle = middleOf(cast[0]!.walker);
  const plain: Stimulus = {
    format: "eigenwalker stimulus",
    version: 1,
    figures: cast.map((each, i) => figureOf(model, each, state, staging, i, middle)),
    transforms: [...first, ...tempo(state)],
    view: {
      view_deg: state.azimuth_deg,
      elevation_deg: state.elevation_deg,
      eye_distance_mm: state.perspective ? staging.eyeMm : null,
      centre_mm: [middle[0], middle[1], staging.middleMm],
    },
    timing: { duration_s: DURATION_S, rate_hz: RATE_HZ },
    display: {
      ...size,
      px_per_mm: staging.pxPerMm,
      dot_px: staging.dotPx,
      style: state.style,
      colour: state.style === "mannequin" ? palette.body : palette.colour,
      background: palette.background,
      viewing_distance_mm: null,
      px_per_cm: null,
    },
    provenance: { ...model.provenance, program: model.program },
  };
  return turning(chained(plain, state.transforms, model.groups), state, turn_deg);
}

/** A walker in its place; the first stands where it was made. */
function figureOf(
  model: Model,
  { walker }: Cast,
  { azimuth_deg, elevation_deg }: State,
  { offsets }: Staging,
  number: number,
  origin: readonly [number, number],
): Figure {
  const [right, up] = observerAxes(azimuth_deg, elevation_deg);
  const [across, above] = offsets[number]!;
  const [x, y] = middleOf(walker);
  const own: Vector = [origin[0] - x, origin[1] - y, 0];
  const position = own.map((at, axis) => at + across * right[axis]! + above * up[axis]!);
  const whole = { ...walker, form: model.form };
  return {
    walker: whole,
    trajectories: null,
    segments: model.segments,
    pairs: model.pairs,
    position_mm: position as unknown as Vector,
    heading_deg: 0,
  };
}

/** Playback faster or slower. */
const tempo = ({ tempo: factor }: State): Step[] =>
  factor === 1 ? [] : [{ name: "speed", factor, figures: null }];

/** A figure that turns by itself does so as the last thing, before noise is added. */
function turning(stimulus: Stimulus, { turning_deg_s: speed_deg_s }: State, angle_deg: number): Stimulus {
  if (speed_deg_s === 0 && angle_deg === 0) return stimulus;
  const turn: Step = { name: "rotate", axis: "z", angle_deg, speed_deg_s, figures: null };
  const masks = stimulus.transforms.filter(({ name }) => name === "mask");
  const others = stimulus.transforms.filter(({ name }) => name !== "mask");
  return { ...stimulus, transforms: [...others, turn, ...masks] };
}
