/** The picture in the viewer as the content of a stimulus file. */

import type { Figure, Step, Stimulus, Walker } from "../core/stimulus";
import { observerAxes, type Vector } from "../core/vector";
import { walkerOf } from "../model/features";
import type { Scene, SceneFigure } from "../model/figures";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import { arrange, centreOf, sharedExtent, type Arrangement, type Extent, type Size } from "./arrangement";
import { paletteOf } from "./drawing";
import { withTransforms } from "./transformChain";

export const MAX_FIGURES = 64;
/** Duration of a saved stimulus. */
export const DURATION_S = 4;
const RATE_HZ = 60;
const DEFAULT_SIZE: Size = { width_px: 640, height_px: 640 };

/** The present picture as a stimulus that Python's `Stimulus.from_json` reads. */
export function stimulusOf(scene: Scene, size: Size = DEFAULT_SIZE): Stimulus {
  const some = { ...scene, figures: scene.figures.slice(0, MAX_FIGURES) };
  const stimulus = arrangedStimulus(some, size, arrangementFor(some, size));
  const figures = stimulus.figures.map((figure) => ({ ...figure, walker: figure.walker && beginning(figure.walker) }));
  return { ...stimulus, figures };
}

/**
 * A walker whose left ankle passes the right one, on its way forward, at 0 s: as Python's, all begin alike.
 * Where phases are fixed, the walker as it is.
 */
function beginning(walker: Walker & { readonly form?: string }): Walker {
  const { markers, p, harmonics, phases, form } = walker;
  const [left, right] = [markers.indexOf("left_ankle"), markers.indexOf("right_ankle")];
  if (form === "fourier" || left < 0 || right < 0) return walker;
  let [sine, cosine] = [0, 0];
  p.forEach((posture, i) => {
    if (harmonics[i] !== 1) return;
    const swing = posture[left]![0] - posture[right]![0];
    sine += swing * Math.cos(phases[i]!);
    cosine += swing * Math.sin(phases[i]!);
  });
  const own = Math.atan2(cosine, sine);
  return { ...walker, phases: phases.map((phase, i) => phase - harmonics[i]! * own) };
}

export const arrangementFor = (scene: Scene, size: Size): Arrangement =>
  arrange(scene.figures.length, extentFor(scene), size, scene.state.elevation_deg, scene.state.zoom);

export const extentFor = ({ model, figures }: Scene): Extent =>
  sharedExtent(walkerOf(model, model.average), figures.map(({ walker }) => walker));

/**
 * The stimulus of arranged figures.
 *
 * Its chain begins with the steps `first`; a figure that turns by itself starts from the angle `turn_deg`.
 */
export function arrangedStimulus(
  { model, figures, state }: Scene,
  size: Size,
  arrangement: Arrangement,
  first: readonly Step[] = [],
  turn_deg = 0,
): Stimulus {
  const palette = paletteOf(state.dark);
  const centre = centreOf(figures[0]!.walker);
  const plain: Stimulus = {
    format: "eigenwalker stimulus",
    version: 1,
    figures: figures.map((figure, i) => placed(model, figure, state, arrangement.offsets[i]!, centre)),
    transforms: [...first, ...tempo(state)],
    view: {
      view_deg: state.azimuth_deg,
      elevation_deg: state.elevation_deg,
      eye_distance_mm: state.perspective ? arrangement.eyeMm : null,
      centre_mm: [...centre, arrangement.middleMm],
    },
    timing: { duration_s: DURATION_S, rate_hz: RATE_HZ },
    display: {
      ...size,
      px_per_mm: arrangement.pxPerMm,
      dot_px: arrangement.dotPx,
      style: state.style,
      colour: state.style === "mannequin" ? palette.body : palette.colour,
      background: palette.background,
      viewing_distance_mm: null,
      px_per_cm: null,
    },
    provenance: { ...model.provenance, program: model.program },
  };
  return turning(withTransforms(plain, state.transforms, model.groups), state, turn_deg);
}

/** A walker at its place; the first keeps the place where it was made. */
function placed(
  { form, segments, pairs }: Model,
  { walker }: SceneFigure,
  { azimuth_deg, elevation_deg }: State,
  [across, above]: readonly [number, number],
  origin: readonly [number, number],
): Figure {
  const [right, up] = observerAxes(azimuth_deg, elevation_deg);
  const [x, y] = centreOf(walker);
  const own: Vector = [origin[0] - x, origin[1] - y, 0];
  const position = own.map((at, axis) => at + across * right[axis]! + above * up[axis]!);
  const whole = { ...walker, form };
  return {
    walker: whole,
    trajectories: null,
    segments,
    pairs,
    position_mm: position as unknown as Vector,
    heading_deg: 0,
  };
}

const tempo = ({ tempo: factor }: State): Step[] =>
  factor === 1 ? [] : [{ name: "speed", factor, figures: null }];

/** Turning by itself is the last transform before noise. */
function turning(stimulus: Stimulus, { turning_deg_s: speed_deg_s }: State, angle_deg: number): Stimulus {
  if (speed_deg_s === 0 && angle_deg === 0) return stimulus;
  const turn: Step = { name: "rotate", axis: "z", angle_deg, speed_deg_s, figures: null };
  const masks = stimulus.transforms.filter(({ name }) => name === "mask");
  const others = stimulus.transforms.filter(({ name }) => name !== "mask");
  return { ...stimulus, transforms: [...others, turn, ...masks] };
}
