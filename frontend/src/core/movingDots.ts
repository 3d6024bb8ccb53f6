/** A figure that moves: dots with names, as a function of time, which transforms change. */

import type { Link, Trajectories, Walker } from "./stimulus";
import type { Vector } from "./vector";

/** Moments of the period over which means are taken. */
const N_SAMPLES = 64;

/** All dots at one moment; whoever asked for it may change it. */
export interface Moment {
  /** x, y, z of one dot after the other, in millimetres; NaN where not known. */
  readonly positions: Float64Array;
  /** 1 for each dot that is seen. */
  readonly visible: Uint8Array;
}

export type At = (time: number) => Moment;

/** Who the dots are, who is joined to whom, and who is whose counterpart. */
export interface Body {
  readonly dots: readonly string[];
  readonly segments: readonly Link[];
  readonly pairs: readonly Link[];
}

/** A figure as a function of time, in its own frame: x forward, y left, z up. */
export class Moving {
  #mean: Float64Array | undefined;

  constructor(
    readonly body: Body,
    /** The dots at a time in seconds. */
    readonly at: At,
    /** Seconds after which it repeats; of sampled trajectories, how long they last. */
    readonly periodS: number,
    /** Standard deviation of each dot's blob; 0 for discs. */
    readonly blurMm = 0,
  ) {}

  /** The same figure with other dots, another motion, another period, or blurred. */
  with(change: { body?: Body; at?: At; periodS?: number; blurMm?: number }): Moving {
    return new Moving(
      change.body ?? this.body,
      change.at ?? this.at,
      change.periodS ?? this.periodS,
      change.blurMm ?? this.blurMm,
    );
  }

  /** The number of the dot of this name, -1 where there is none. */
  index(dot: string): number {
    return this.body.dots.indexOf(dot);
  }

  /** For each dot, whether it is among those named. */
  named(markers: readonly string[]): boolean[] {
    return this.body.dots.map((dot) => markers.includes(dot));
  }

  /** Mean place of each dot over 64 moments of the period; those not known are left out. */
  get mean(): Float64Array {
    this.#mean ??= this.#meanPlaces();
    return this.#mean;
  }

  #meanPlaces(): Float64Array {
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

  /** Middle between the least and the greatest mean place, on each axis. */
  get middle(): Vector {
    const mean = this.mean;
    const known = this.body.dots.map((_, dot) => 3 * dot).filter((i) => isKnown(mean, i));
    if (known.length === 0) return [0, 0, 0];
    const between = (axis: number): number => {
      const places = known.map((i) => mean[i + axis]!);
      return (Math.min(...places) + Math.max(...places)) / 2;
    };
    return [between(0), between(1), between(2)];
  }

  /** For each dot its left-right counterpart, or itself. */
  mirrored(): number[] {
    const partner = new Map(this.body.pairs.flatMap(([left, right]) => [[left, right], [right, left]]));
    return this.body.dots.map((dot) => this.index(partner.get(dot) ?? dot));
  }

  /**
   * For each dot the one that carries it, along the segments from the root outwards, and -1 where
   * nothing does. The root is `pelvis`, or the first dot where there is none.
   */
  parents(): number[] {
    const { dots, segments } = this.body;
    const root = dots.includes("pelvis") ? "pelvis" : dots[0]!;
    const parent = new Map([[root, -1]]);
    const waiting = [root];
    for (const carrier of waiting) {
      for (const [one, other] of segments) {
        if (one !== carrier && other !== carrier) continue;
        const far = one === carrier ? other : one;
        if (parent.has(far)) continue;
        parent.set(far, dots.indexOf(carrier));
        waiting.push(far);
      }
    }
    return dots.map((dot) => parent.get(dot) ?? -1);
  }
}

/** Whether all three numbers from a place in an array on are known. */
export function isKnown(positions: Float64Array, i: number): boolean {
  return !Number.isNaN(positions[i]! + positions[i + 1]! + positions[i + 2]!);
}

/** Dots in such an order that each comes after the one that carries it. */
export function outward(parents: readonly number[]): number[] {
  const depth = (dot: number): number => (parents[dot]! < 0 ? 0 : 1 + depth(parents[dot]!));
  return parents.map((_, dot) => dot).sort((a, b) => depth(a) - depth(b));
}

/** A walker as a moving figure: eq. 3 of Troje (2002), p0 + sum_i p_i sin(h_i 2 pi f t + phi_i). */
export function walking(walker: Walker, segments: readonly Link[], pairs: readonly Link[]): Moving {
  const p0 = Float64Array.from(walker.p0.flat());
  const p = walker.p.map((eigenposture) => Float64Array.from(eigenposture.flat()));
  const at = (time: number): Moment => {
    const cycle = 2 * Math.PI * walker.frequency_hz * time;
    const positions = p0.slice();
    for (let i = 0; i < p.length; i++) {
      const sine = Math.sin(walker.harmonics[i]! * cycle + walker.phases[i]!);
      const eigenposture = p[i]!;
      for (let j = 0; j < positions.length; j++) positions[j]! += sine * eigenposture[j]!;
    }
    return { positions, visible: new Uint8Array(walker.markers.length).fill(1) };
  };
  return new Moving({ dots: walker.markers, segments, pairs }, at, 1 / walker.frequency_hz);
}

/**
 * Sampled trajectories as a moving figure, a straight line between frames.
 *
 * Before the first and after the last frame it holds still, or begins anew one frame after the
 * last. Between two frames of which one lacks a dot, the dot is not visible.
 */
export function sampled(
  { markers, rate_hz, repeat, samples }: Trajectories,
  segments: readonly Link[],
  pairs: readonly Link[],
): Moving {
  const nFrames = samples.length;
  const frames = samples.map((dots) =>
    Float64Array.from(dots.flatMap((p) => (p.includes(null) ? [NaN, NaN, NaN] : (p as number[])))),
  );
  const at = (time: number): Moment => {
    let frame = time * rate_hz;
    if (repeat) frame -= Math.floor(frame / nFrames) * nFrames;
    else frame = Math.min(Math.max(frame, 0), nFrames - 1);
    const before = Math.min(Math.floor(frame), nFrames - 1);
    const next = repeat ? (before + 1) % nFrames : Math.min(before + 1, nFrames - 1);
    const one = frames[before]!;
    const other = frames[frame === before ? before : next]!;
    const share = frame - before;
    const positions = one.map((place, i) => place * (1 - share) + other[i]! * share);
    const visible = Uint8Array.from(markers, (_, dot) => Number(isKnown(positions, 3 * dot)));
    return { positions, visible };
  };
  const lasts = repeat ? nFrames : Math.max(nFrames - 1, 1);
  return new Moving({ dots: markers, segments, pairs }, at, lasts / rate_hz);
}
