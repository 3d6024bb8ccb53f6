/** What moves on the stage: walkers as they are, or as the chain of transforms leaves them. */

import { framesOf } from "../canvas/figureFrames";
import type { MannequinPainter } from "../canvas/mannequinLoader";
import { drawingOf } from "../canvas/painter";
import type { Link, Step } from "../core/stimulus";
import { observerAxes } from "../core/vector";
import type { Cast } from "../model/figures";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import { isPlain } from "./transformChain";
import { clear, drawDots, drawGround, drawSticks, drawTrails, type Ink } from "./drawing";
import { paletteOf } from "./palette";
import type { Size, Staging } from "./arrangement";
import { DURATION_S, stagedStimulus } from "./viewedStimulus";
import { Troupe, type Sight } from "./walkerBatch";

/** Walkers of whom trails and the ground are drawn; with more there is no room for them. */
const MOST_WITH_TRAILS = 4;

/** What an act is made of. */
export interface Script {
  readonly model: Model;
  readonly cast: readonly Cast[];
  readonly state: State;
  readonly size: Size;
  readonly staging: Staging;
  /** Where in its stride each walker is, in cycles, at the time given. */
  readonly cycles: readonly number[];
  readonly time: number;
  /** How far it has turned by itself at that time. */
  readonly turned_deg: number;
  readonly mannequin: MannequinPainter | null;
}

export interface Act {
  /** Draw all as it is at a time in seconds; `fine` pixels of the canvas are one of the picture. */
  draw(context: CanvasRenderingContext2D, time: number, fine: number): void;
  /** Where in its stride a walker is, in cycles. */
  cycle(number: number, time: number): number;
  /** See it from elsewhere; false where a new act is needed for that. */
  turn(azimuth_deg: number, elevation_deg: number, staging: Staging): boolean;
}

/** How far apart in their strides the walkers of a crowd are: no two are ever alike. */
const GOLDEN = (Math.sqrt(5) - 1) / 2;

/** How far a walker is ahead of the first one, in cycles. */
export const lead = ({ scene }: State, number: number): number =>
  scene === "crowd" ? (GOLDEN * number) % 1 : 0;

export function actOf(script: Script): Act {
  const { state, mannequin } = script;
  const carved = state.style === "mannequin" && mannequin !== null;
  return isPlain(state) && !carved ? plainAct(script) : chainedAct(script);
}

/** Strides a second of each walker as it is played; backwards is less than 0. */
export const ratesOf = ({ cast, state }: Pick<Script, "cast" | "state">): number[] => {
  const factor = "reverse" in state.transforms ? -state.tempo : state.tempo;
  return cast.map(({ walker }) => factor * walker.frequency_hz);
};

function plainAct(script: Script): Act {
  const { model, cast, state, size } = script;
  const troupe = new Troupe(cast.map(({ walker }) => walker));
  ratesOf(script).forEach((rate, i) => {
    troupe.rates[i] = rate;
    troupe.starts[i] = script.cycles[i]! - rate * script.time;
  });
  const segments = segmentsOf(model.markers, model.segments);
  const few = cast.length <= MOST_WITH_TRAILS;
  let { staging } = script;
  let { azimuth_deg, elevation_deg } = state;
  return {
    cycle: (number, time) => troupe.cycle(number, time),
    turn(azimuth, elevation, stagingThere) {
      [azimuth_deg, elevation_deg, staging] = [azimuth, elevation, stagingThere];
      return true;
    },
    draw(context, time, fine) {
      const turned = azimuth_deg + script.turned_deg + state.turning_deg_s * (time - script.time);
      const sight: Sight = {
        axes: observerAxes(turned, elevation_deg),
        eyeMm: state.perspective ? staging.eyeMm : null,
      };
      const ink = inkOf(state, staging, context);
      const see = (when: number, into: Float64Array): void =>
        troupe.see(when, sight, staging, size.width_px, size.height_px, into);
      clear(ink, size, fine);
      if (few) drawGround(ink, staging, sight, size);
      if (few && state.trails) drawTrails(ink, see, time, troupe.places.length);
      see(time, troupe.places);
      if (state.style !== "dots") drawSticks(ink, troupe.places, segments, troupe.nDots);
      drawDots(ink, troupe.places, troupe.nDots);
    },
  };
}

function chainedAct(script: Script): Act {
  const { model, cast, state, size, staging, mannequin } = script;
  const style = state.style === "mannequin" && !mannequin ? "sticks" : state.style;
  const rates = ratesOf(script);
  // Played backwards, what is shown at t is what was at the end of the file less t.
  const [end, way] = "reverse" in state.transforms ? [DURATION_S, -1] : [0, 1];
  const starts = rates.map((rate, i) => script.cycles[i]! - rate * (script.time + way * end));
  const clocks: Step[] = starts.map((cycles, i) => ({ name: "start", phase_deg: 360 * cycles, figures: [i] }));
  const turn = script.turned_deg - state.turning_deg_s * script.time;
  const played = { ...state, style };
  const stimulus = stagedStimulus(model, cast, played, size, staging, clocks, turn);
  const draw = drawingOf(stimulus, mannequin ?? undefined);
  const frameAt = framesOf(stimulus);
  const trailed = state.trails && cast.length <= MOST_WITH_TRAILS && !("limb_dots" in state.transforms);
  const see = (time: number, into: Float64Array): void => {
    const figures = frameAt(time).slice(0, cast.length);
    figures.reduce((at, { places }) => (into.set(places, at), at + places.length), 0);
  };
  return {
    cycle: (number, time) => starts[number]! + rates[number]! * (time + way * end),
    turn: () => false,
    draw(context, time, fine) {
      draw(context, time, fine);
      if (trailed) drawTrails(inkOf(state, staging, context), see, time, 2 * cast.length * model.markers.length);
    },
  };
}

const inkOf = ({ dark }: State, { dotPx }: Staging, context: CanvasRenderingContext2D): Ink => ({
  context,
  palette: paletteOf(dark),
  dotPx,
});

function segmentsOf(markers: readonly string[], segments: readonly Link[]): Uint16Array {
  return Uint16Array.from(segments.flatMap((ends) => ends.map((name) => markers.indexOf(name))));
}
