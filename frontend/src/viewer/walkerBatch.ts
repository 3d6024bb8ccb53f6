/** Walkers of one model in typed arrays, projected without new objects for each frame. */

import { coefficientsOf, posture, type Coefficients } from "../core/posture";
import type { Walker } from "../core/stimulus";
import type { Axes } from "../core/vector";
import { centreOf, type Arrangement, type Size } from "./arrangement";

/** A dot nearer to the eye than this is not visible. */
const NEAREST_MM = 1;

export interface ViewPoint {
  readonly axes: Axes;
  /** Distance of the eye; null for orthographic projection. */
  readonly eyeMm: number | null;
}

export class WalkerBatch {
  readonly nDots: number;
  /** For each walker its strides at 0 s, and strides a second. */
  readonly starts: Float64Array;
  readonly rates: Float64Array;
  /** Pixels from the left and the upper edge of the picture, NaN where not visible. */
  readonly places: Float64Array;
  readonly #coefficients: readonly Coefficients[];
  readonly #centres: readonly (readonly [number, number])[];
  readonly #positions: Float64Array;

  constructor(walkers: readonly Walker[]) {
    this.nDots = walkers[0]!.markers.length;
    this.starts = new Float64Array(walkers.length);
    this.rates = Float64Array.from(walkers, ({ frequency_hz }) => frequency_hz);
    this.places = new Float64Array(2 * walkers.length * this.nDots);
    this.#coefficients = walkers.map(coefficientsOf);
    this.#centres = walkers.map(centreOf);
    this.#positions = new Float64Array(3 * this.nDots);
  }

  /** The phase of a walker, in strides. */
  strides(walker: number, time: number): number {
    return this.starts[walker]! + this.rates[walker]! * time;
  }

  /** Write the places of all dots at a time in seconds into `into`. */
  project(
    time: number,
    { axes: [right, up, towards], eyeMm: eye }: ViewPoint,
    { pxPerMm, middleMm, offsets }: Arrangement,
    { width_px, height_px }: Size,
    into = this.places,
  ): void {
    const positions = this.#positions;
    let place = 0;
    for (let walker = 0; walker < this.#coefficients.length; walker++) {
      posture(this.#coefficients[walker]!, 2 * Math.PI * this.strides(walker, time), positions);
      const [across, above] = offsets[walker]!;
      const [x0, y0] = this.#centres[walker]!;
      for (let i = 0; i < positions.length; i += 3, place += 2) {
        const x = positions[i]! - x0;
        const y = positions[i + 1]! - y0;
        const z = positions[i + 2]! - middleMm;
        let scale = pxPerMm;
        if (eye !== null) {
          const away = eye - (x * towards[0] + y * towards[1] + z * towards[2]);
          scale = away < NEAREST_MM ? NaN : (pxPerMm * eye) / away;
        }
        into[place] = width_px / 2 + scale * (x * right[0] + y * right[1] + z * right[2] + across);
        into[place + 1] = height_px / 2 - scale * (x * up[0] + y * up[1] + z * up[2] + above);
      }
    }
  }
}
