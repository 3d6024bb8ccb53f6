/** Transforms of time: faster, backwards, another phase, from one walker to another. */

import { gathered, walking, type Moment, type MovingDots, type Transforms } from "./movingDots";
import { Purpose, uniforms } from "./randomStream";

type TimeTransform = "speed" | "reverse" | "start" | "freeze" | "phase_scramble" | "delay" | "morph";

export const timeTransforms: Transforms<TimeTransform> = {
  /** Play faster or slower: the new figure at `t` is the old one at `factor t`. */
  speed: (moving, { factor }) =>
    moving.with({ at: (time) => moving.at(time * factor), periodS: moving.periodS / Math.abs(factor) }),

  /** Play backwards: the new figure at `t` is the old one at `end - t`. */
  reverse: (moving, { end_s }) => moving.with({ at: (time) => moving.at(end_s - time) }),

  /** Begin at another phase: the new figure at `t` is the old one at `t + phase / 360 * period`. */
  start(moving, { phase_deg }) {
    const later = (phase_deg / 360) * moving.periodS;
    return moving.with({ at: (time) => moving.at(time + later) });
  },

  /** Stand still in the posture of one moment. */
  freeze: (moving, { time_s }) => moving.with({ at: () => moving.at(time_s) }),

  /** Give each dot a clock of its own: dot d is shown at `t + spread u_d period`. */
  phase_scramble(moving, { seed, spread }, { figure }) {
    const shifts = moving.body.dots.map((_, dot) => {
      const [u] = uniforms([Purpose.phaseScramble, seed, dot, figure], 1);
      return spread * u! * moving.periodS;
    });
    return shifted(moving, shifts);
  },

  /** Delay some dots: they are shown at `t - phase / 360 * period`. */
  delay(moving, step) {
    const lag = (step.phase_deg / 360) * moving.periodS;
    return shifted(moving, moving.named(step.markers).map((lags) => (lags ? -lag : 0)));
  },

  /**
   * Pass from the figure into another walker, at an even rate from start to end.
   *
   * Both are taken at the same phase of their strides, and their positions are averaged. The frequency
   * changes at the same rate, so that the phase in strides is `f_a t + (f_b - f_a) W(t)`, where W is the
   * integral of the other walker's share.
   */
  morph(moving, step) {
    const other = walking(step.walker, [], []);
    const order = moving.body.dots.map((dot) => other.index(dot));
    const durationS = step.end_s - step.start_s;
    const ownHz = 1 / moving.periodS;
    const otherHz = 1 / other.periodS;
    const at = (time: number): Moment => {
      const share = Math.min(Math.max((time - step.start_s) / durationS, 0), 1);
      const integral = (share * share * durationS) / 2 + Math.max(time - step.end_s, 0);
      const strides = ownHz * time + (otherHz - ownHz) * integral;
      const moment = moving.at(strides * moving.periodS);
      const there = other.at(strides * other.periodS);
      const { positions } = gathered(order.map((dot) => [there, dot]));
      moment.positions.forEach((value, i) => {
        moment.positions[i] = (1 - share) * value + share * positions[i]!;
      });
      return moment;
    };
    return moving.with({ at });
  },
};

/** The figure with each dot shifted in time. */
function shifted(moving: MovingDots, shifts: readonly number[]): MovingDots {
  const clocks = [...new Set(shifts)];
  const clock = shifts.map((shift) => clocks.indexOf(shift));
  const at = (time: number): Moment => {
    const moments = clocks.map((shift) => moving.at(time + shift));
    return gathered(clock.map((which, dot) => [moments[which]!, dot]));
  };
  return moving.with({ at });
}