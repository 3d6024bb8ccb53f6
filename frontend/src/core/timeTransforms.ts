/** Transforms of time: faster, backwards, elsewhere in the cycle, from one walker to another. */

import { Purpose, uniforms } from "./randomStream";
import { walking, type Moment, type Moving } from "./movingDots";
import type { Stage } from "./transformContext";
import type { Parameters } from "./stimulus";

/** Play faster or slower: what was at `factor t` is at `t`. */
export function speed(moving: Moving, _: Stage, { factor }: Parameters<"speed">): Moving {
  const at = (time: number): Moment => moving.at(time * factor);
  return moving.with({ at, periodS: moving.periodS / Math.abs(factor) });
}

/** Play backwards: what was at `end - t` is at `t`. */
export function reverse(moving: Moving, _: Stage, { end_s }: Parameters<"reverse">): Moving {
  return moving.with({ at: (time) => moving.at(end_s - time) });
}

/** Begin elsewhere in the cycle: what was at `t + phase / 360 * period` is at `t`. */
export function start(moving: Moving, _: Stage, { phase_deg }: Parameters<"start">): Moving {
  const later = (phase_deg / 360) * moving.periodS;
  return moving.with({ at: (time) => moving.at(time + later) });
}

/** Stand still as at one moment. */
export function freeze(moving: Moving, _: Stage, { time_s }: Parameters<"freeze">): Moving {
  return moving.with({ at: () => moving.at(time_s) });
}

/** Let each dot run on a clock of its own: dot d is shown as at `t + spread u_d period`. */
export function phaseScramble(
  moving: Moving,
  stage: Stage,
  { seed, spread }: Parameters<"phase_scramble">,
): Moving {
  const shifts = moving.body.dots.map((_, dot) => {
    const [drawn] = uniforms(Purpose.phaseScramble, seed, dot, stage.figure, 1);
    return spread * drawn! * moving.periodS;
  });
  return shifted(moving, shifts);
}

/** Let some dots lag: they are shown as at `t - phase / 360 * period`. */
export function delay(moving: Moving, _: Stage, step: Parameters<"delay">): Moving {
  const lag = (step.phase_deg / 360) * moving.periodS;
  return shifted(moving, moving.named(step.markers).map((lags) => (lags ? -lag : 0)));
}

/** A figure of which each dot runs ahead by a time of its own. */
function shifted(moving: Moving, shifts: readonly number[]): Moving {
  const clocks = [...new Set(shifts)];
  const clock = shifts.map((shift) => clocks.indexOf(shift));
  const at = (time: number): Moment => {
    const moments = clocks.map((shift) => moving.at(time + shift));
    return gathered(clock.map((which, dot) => [moments[which]!, dot]));
  };
  return moving.with({ at });
}

/** One moment of dots that are taken from several, each by its number there. */
export function gathered(sources: readonly (readonly [Moment, number])[]): Moment {
  const positions = new Float64Array(3 * sources.length);
  const visible = new Uint8Array(sources.length);
  sources.forEach(([moment, dot], i) => {
    positions.set(moment.positions.subarray(3 * dot, 3 * dot + 3), 3 * i);
    visible[i] = moment.visible[dot]!;
  });
  return { positions, visible };
}

/**
 * Pass from the figure into another walker, evenly, from start to end.
 *
 * Both are taken at the same phase of their cycles and their places averaged; the frequency passes
 * evenly too, so that the phase in cycles is `f_a t + (f_b - f_a) W(t)`, W being the integral of
 * the other's share.
 */
export function morph(moving: Moving, _: Stage, step: Parameters<"morph">): Moving {
  const other = walking(step.walker, [], []);
  const order = moving.body.dots.map((dot) => other.index(dot));
  const lasts = step.end_s - step.start_s;
  const ownHz = 1 / moving.periodS;
  const otherHz = 1 / other.periodS;
  const at = (time: number): Moment => {
    const share = Math.min(Math.max((time - step.start_s) / lasts, 0), 1);
    const integral = (share * share * lasts) / 2 + Math.max(time - step.end_s, 0);
    const cycles = ownHz * time + (otherHz - ownHz) * integral;
    const moment = moving.at(cycles * moving.periodS);
    const there = gathered(order.map((dot) => [other.at(cycles * other.periodS), dot]));
    moment.positions.forEach((place, i) => {
      moment.positions[i] = (1 - share) * place + share * there.positions[i]!;
    });
    return moment;
  };
  return moving.with({ at });
}
