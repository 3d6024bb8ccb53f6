/** The animation in the viewer: walkers as they are, or after a chain of transforms. */

import { framesOf } from "../canvas/figureFrames";
import type { MannequinPainter } from "../canvas/mannequinLoader";
import { drawBackground, drawDots, drawingOf, drawSticks, linksOf } from "../canvas/painter";
import type { Step } from "../core/stimulus";
import { observerAxes } from "../core/vector";
import type { Scene } from "../model/figures";
import type { State } from "../model/state";
import type { Arrangement, Size } from "./arrangement";
import { drawGround, drawTrails, paletteOf, type Brush } from "./drawing";
import { isPlain } from "./transformChain";
import { arrangedStimulus, DURATION_S } from "./viewedStimulus";
import { WalkerBatch, type ViewPoint } from "./walkerBatch";

/** Trails and the ground are drawn for at most this many walkers. */
const MAX_WITH_TRAILS = 4;

export interface AnimationSpec extends Scene {
  readonly size: Size;
  readonly arrangement: Arrangement;
  /** The phase of each walker at `time`, in strides. */
  readonly phases: readonly number[];
  readonly time: number;
  /** Azimuth that has been added at `time` by turning by itself. */
  readonly turned_deg: number;
  readonly mannequin: MannequinPainter | null;
}

export interface ViewerAnimation {
  /** Draw everything at a time in seconds; `pixelRatio` canvas pixels are one pixel of the picture. */
  draw(context: CanvasRenderingContext2D, time: number, pixelRatio: number): void;
  /** The phase of a walker, in strides. */
  phase(number: number, time: number): number;
  /** Change the view; false if that needs a new animation. */
  turn(azimuth_deg: number, elevation_deg: number, arrangement: Arrangement): boolean;
}

/** The phases of a crowd are spaced by the golden ratio: no two are alike. */
const GOLDEN = (Math.sqrt(5) - 1) / 2;

/** The phase of a walker relative to the first one, in strides. */
export const phaseOffset = ({ scene }: State, number: number): number =>
  scene === "crowd" ? (GOLDEN * number) % 1 : 0;

export function animationOf(spec: AnimationSpec): ViewerAnimation {
  const solid = spec.state.style === "mannequin" && spec.mannequin !== null;
  return isPlain(spec.state) && !solid ? plainAnimation(spec) : chainAnimation(spec);
}

/** Strides a second of each walker during playback; negative when it plays backwards. */
export const strideRates = ({ figures, state }: Pick<AnimationSpec, "figures" | "state">): number[] => {
  const factor = "reverse" in state.transforms ? -state.tempo : state.tempo;
  return figures.map(({ walker }) => factor * walker.frequency_hz);
};

function plainAnimation(spec: AnimationSpec): ViewerAnimation {
  const { model: { markers, segments }, figures, state, size } = spec;
  const batch = new WalkerBatch(figures.map(({ walker }) => walker));
  strideRates(spec).forEach((rate, i) => {
    batch.rates[i] = rate;
    batch.starts[i] = spec.phases[i]! - rate * spec.time;
  });
  const links = linksOf(markers, segments);
  const few = figures.length <= MAX_WITH_TRAILS;
  let { arrangement } = spec;
  let { azimuth_deg, elevation_deg } = state;
  return {
    phase: (number, time) => batch.strides(number, time),
    turn(azimuth, elevation, next) {
      [azimuth_deg, elevation_deg, arrangement] = [azimuth, elevation, next];
      return true;
    },
    draw(context, time, pixelRatio) {
      const turned = azimuth_deg + spec.turned_deg + state.turning_deg_s * (time - spec.time);
      const view: ViewPoint = {
        axes: observerAxes(turned, elevation_deg),
        eyeMm: state.perspective ? arrangement.eyeMm : null,
      };
      const brush = brushOf(state, arrangement, context);
      const project = (at: number, into: Float64Array): void => batch.project(at, view, arrangement, size, into);
      drawBackground(context, { ...size, background: brush.palette.background }, pixelRatio);
      if (few) drawGround(brush, arrangement, view, size);
      if (few && state.trails) drawTrails(brush, project, time, batch.places.length);
      project(time, batch.places);
      context.fillStyle = context.strokeStyle = brush.palette.colour;
      if (state.style !== "dots") drawSticks(context, batch.places, batch.nDots, links, brush.dotPx);
      drawDots(context, batch.places, batch.nDots, brush.dotPx);
    },
  };
}

function chainAnimation(spec: AnimationSpec): ViewerAnimation {
  const { model, figures, state, size, arrangement, mannequin } = spec;
  const style = state.style === "mannequin" && !mannequin ? "sticks" : state.style;
  const rates = strideRates(spec);
  // When it plays backwards, the picture at t is the one at the end of the file minus t.
  const [end, direction] = "reverse" in state.transforms ? [DURATION_S, -1] : [0, 1];
  const starts = rates.map((rate, i) => spec.phases[i]! - rate * (spec.time + direction * end));
  const clocks: Step[] = starts.map((phase, i) => ({ name: "start", phase_deg: 360 * phase, figures: [i] }));
  const turn = spec.turned_deg - state.turning_deg_s * spec.time;
  const stimulus = arrangedStimulus({ ...spec, state: { ...state, style } }, size, arrangement, clocks, turn);
  const draw = drawingOf(stimulus, mannequin ?? undefined);
  const frameAt = framesOf(stimulus);
  const trails = state.trails && figures.length <= MAX_WITH_TRAILS && !("limb_dots" in state.transforms);
  const project = (time: number, into: Float64Array): void => {
    const frames = frameAt(time).slice(0, figures.length);
    frames.reduce((at, { places }) => (into.set(places, at), at + places.length), 0);
  };
  return {
    phase: (number, time) => starts[number]! + rates[number]! * (time + direction * end),
    turn: () => false,
    draw(context, time, pixelRatio) {
      draw(context, time, pixelRatio);
      const brush = brushOf(state, arrangement, context);
      if (trails) drawTrails(brush, project, time, 2 * figures.length * model.markers.length);
    },
  };
}

const brushOf = ({ dark }: State, { dotPx }: Arrangement, context: CanvasRenderingContext2D): Brush => ({
  context,
  palette: paletteOf(dark),
  dotPx,
});
