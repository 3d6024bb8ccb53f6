/** A figure as named dots that are a function of time, which transforms change. */

import { coefficientsOf, posture } from "./posture";
import type { Figure, Link, Parameters, Trajectories, TransformName, Walker } from "./stimulus";
import type { Axes, Vector } from "./vector";

/** Moments of the period over which means are taken. */
const N_SAMPLES = 64;

/** All dots at one moment; the caller owns the arrays and may change them. */
export interface Moment {
  /** x, y, z of one dot after the other, in millimetres; NaN where unknown. */
  readonly positions: Float64Array;
  /** 1 for each visible dot. */
  readonly visible: Uint8Array;
}

export type At = (time: number) => Moment;

/** Names of the dots, the segments that join them, and their left-right pairs. */
export interface Body {
  readonly dots: readonly string[];
  readonly segments: readonly Link[];
  readonly pairs: readonly Link[];
}

/** What a transform knows beside its figure. */
export interface TransformContext {
  /** The observer's axes in the figure's own frame. */
  readonly observer: Axes;
  /** Number of the figure, from 0: figures of one scene draw different random numbers. */
  readonly figure: number;
}

/** The figure after a step; for a mask, the noise that joins the scene. */
export type Transform<Name extends TransformName> = (
  moving: MovingDots,
  step: Parameters<Name>,
  context: TransformContext,
) => MovingDots;

export type Transforms<Names extends TransformName> = { readonly [Name in Names]: Transform<Name> };

/** A figure as a function of time, in its own frame: x forward, y left, z up. */
export class MovingDots {
  #mean: Float64Array | undefined;

  constructor(
    readonly body: Body,
    /** The dots at a time in seconds. */
    readonly at: At,
    /** Seconds after which the motion repeats; the duration of sampled trajectories. */
    readonly periodS: number,
    /** Standard deviation of each dot's blob, at the walker's scale or in the picture; 0 for discs. */
    readonly blurMm = 0,
    readonly blurPx = 0,
  ) {}

  /** The same figure with other dots, another motion, another period, or blurred. */
  with(change: { body?: Body; at?: At; periodS?: number; blurMm?: number; blurPx?: number }): MovingDots {
    const { body, at, periodS, blurMm, blurPx } = { ...this, ...change };
    return new MovingDots(body, at, periodS, blurMm, blurPx);
  }

  /** The same figure with each moment changed in place. */
  map(change: (moment: Moment, time: number) => void): MovingDots {
    const at = (time: number): Moment => {
      const moment = this.at(time);
      change(moment, time);
      return moment;
    };
    return this.with({ at });
  }

  /** The number of the dot of this name, -1 where there is none. */
  index(dot: string): number {
    return this.body.dots.indexOf(dot);
  }

  /** For each dot, whether it is one of those named. */
  named(markers: readonly string[]): boolean[] {
    return this.body.dots.map((dot) => markers.includes(dot));
  }

  /** Mean position of each dot over 64 moments of the period, without those where it is unknown. */
  get mean(): Float64Array {
    return (this.#mean ??= this.#meanPositions());
  }

  #meanPositions(): Float64Array {
    const total = new Float64Array(3 * this.body.dots.length);
    const count = new Float64Array(total.length);
    for (let sample = 0; sample < N_SAMPLES; sample++) {
      const { positions } = this.at((sample * this.periodS) / N_SAMPLES);
      for (let i = 0; i < total.length; i++) {
        if (Number.isNaN(positions[i]!)) continue;
        total[i]! += positions[i]!;
        count[i]! += 1;
      }
    }
    return total.map((sum, i) => (count[i]! > 0 ? sum / count[i]! : NaN));
  }

  /** Middle between the least and the greatest mean position, on each axis. */
  get middle(): Vector {
    const { mean } = this;
    const known = this.body.dots.map((_, dot) => 3 * dot).filter((i) => isKnown(mean, i));
    if (known.length === 0) return [0, 0, 0];
    const between = (axis: number): number => {
      const values = known.map((i) => mean[i + axis]!);
      return (Math.min(...values) + Math.max(...values)) / 2;
    };
    return [between(0), between(1), between(2)];
  }

  /** For each dot its left-right counterpart, or itself. */
  mirrored(): number[] {
    const partner = new Map(this.body.pairs.flatMap(([left, right]) => [[left, right], [right, left]]));
    return this.body.dots.map((dot) => this.index(partner.get(dot) ?? dot));
  }

  /**
   * Each dot with its parent along the segments, parents first; -1 for the root and for dots that are
   * not joined to it. The root is `pelvis`, or the first dot where there is none.
   */
  outward(): (readonly [dot: number, parent: number])[] {
    const links = this.body.segments.map((ends) => ends.map((name) => this.index(name)));
    const order: [number, number][] = [[Math.max(this.index("pelvis"), 0), -1]];
    const reached = new Set([order[0]![0]]);
    for (const [carrier] of order) {
      for (const [one, other] of links) {
        const far = one === carrier ? other! : one!;
        if ((one !== carrier && other !== carrier) || reached.has(far)) continue;
        reached.add(far);
        order.push([far, carrier]);
      }
    }
    const loose = [...this.body.dots.keys()].filter((dot) => !reached.has(dot));
    return [...order, ...loose.map((dot) => [dot, -1] as const)];
  }
}

/** Whether the three numbers that begin at an index are all known. */
export function isKnown(positions: Float64Array, i: number): boolean {
  return !Number.isNaN(positions[i]! + positions[i + 1]! + positions[i + 2]!);
}

export const positionOf = (positions: Float64Array, dot: number): Vector => [
  positions[3 * dot]!,
  positions[3 * dot + 1]!,
  positions[3 * dot + 2]!,
];

/** One moment of dots that come from several moments, each by its number there. */
export function gathered(sources: readonly (readonly [Moment, number])[]): Moment {
  const positions = new Float64Array(3 * sources.length);
  const visible = new Uint8Array(sources.length);
  sources.forEach(([moment, dot], i) => {
    positions.set(moment.positions.subarray(3 * dot, 3 * dot + 3), 3 * i);
    visible[i] = moment.visible[dot]!;
  });
  return { positions, visible };
}

export function walking(walker: Walker, segments: readonly Link[], pairs: readonly Link[]): MovingDots {
  const coefficients = coefficientsOf(walker);
  const at = (time: number): Moment => ({
    positions: posture(coefficients, 2 * Math.PI * walker.frequency_hz * time),
    visible: new Uint8Array(walker.markers.length).fill(1),
  });
  return new MovingDots({ dots: walker.markers, segments, pairs }, at, 1 / walker.frequency_hz);
}

/**
 * Sampled trajectories as moving dots, with linear interpolation between frames.
 *
 * Before the first and after the last frame the dots stand still, or the motion repeats one frame
 * after the last. Between two frames of which one lacks a dot, the dot is not visible.
 */
export function sampled(
  { markers, rate_hz, repeat, samples }: Trajectories,
  segments: readonly Link[],
  pairs: readonly Link[],
): MovingDots {
  const nFrames = samples.length;
  const frames = samples.map((dots) =>
    Float64Array.from(dots.flatMap((p) => (p.includes(null) ? [NaN, NaN, NaN] : (p as number[])))),
  );
  const at = (time: number): Moment => {
    let frame = time * rate_hz;
    if (repeat) frame -= Math.floor(frame / nFrames) * nFrames;
    else frame = Math.min(Math.max(frame, 0), nFrames - 1);
    const before = Math.min(Math.floor(frame), nFrames - 1);
    const after = repeat ? (before + 1) % nFrames : Math.min(before + 1, nFrames - 1);
    const one = frames[before]!;
    const other = frames[frame === before ? before : after]!;
    const share = frame - before;
    const positions = one.map((value, i) => value * (1 - share) + other[i]! * share);
    const visible = Uint8Array.from(markers, (_, dot) => Number(isKnown(positions, 3 * dot)));
    return { positions, visible };
  };
  const nIntervals = repeat ? nFrames : Math.max(nFrames - 1, 1);
  return new MovingDots({ dots: markers, segments, pairs }, at, nIntervals / rate_hz);
}

/** The dots of a figure of a stimulus, before its transforms. */
export function figureOf({ walker, trajectories, segments, pairs }: Figure): MovingDots {
  if (walker) return walking(walker, segments, pairs);
  return sampled(trajectories!, segments, pairs);
}
