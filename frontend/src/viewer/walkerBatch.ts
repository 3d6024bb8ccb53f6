/** Walkers of one model as typed arrays, posed and seen without a new object for each frame. */

import type { Walker } from "../core/stimulus";
import type { Axes, Vector } from "../core/vector";
import { middleOf, type Staging } from "./arrangement";

const TURN = 2 * Math.PI;
/** Nearer to the eye than this a dot is not seen. */
const NEAREST_MM = 1;

/** From where walkers are seen. */
export interface Sight {
  readonly axes: Axes;
  /** Null for parallel lines of sight. */
  readonly eyeMm: number | null;
}

export class Troupe {
  readonly count: number;
  readonly nDots: number;
  /** Cycles at 0 s, and cycles a second, of each. */
  readonly starts: Float64Array;
  readonly rates: Float64Array;
  /** Pixels from the left and the upper edge of the picture, NaN where not seen. */
  readonly places: Float64Array;
  readonly #nPostures: number;
  readonly #p0: Float64Array;
  readonly #p: Float64Array;
  readonly #harmonics: Float64Array;
  readonly #phases: Float64Array;
  readonly #middles: Float64Array;
  readonly #positions: Float64Array;

  constructor(walkers: readonly Walker[]) {
    const first = walkers[0]!;
    this.count = walkers.length;
    this.nDots = first.markers.length;
    this.#nPostures = first.harmonics.length;
    this.starts = new Float64Array(this.count);
    this.rates = Float64Array.from(walkers, ({ frequency_hz }) => frequency_hz);
    this.places = new Float64Array(2 * this.count * this.nDots);
    this.#p0 = flat(walkers.map(({ p0 }) => p0));
    this.#p = flat(walkers.flatMap(({ p }) => p));
    this.#harmonics = Float64Array.from(first.harmonics);
    this.#phases = Float64Array.from(walkers.flatMap(({ phases }) => phases));
    this.#middles = Float64Array.from(walkers.flatMap((walker) => middleOf(walker)));
    this.#positions = new Float64Array(3 * this.nDots);
  }

  /** Where in its stride a walker is, in cycles. */
  cycle(number: number, time: number): number {
    return this.starts[number]! + this.rates[number]! * time;
  }

  /** Put the places of all dots at a time in seconds into `into`. */
  see(time: number, sight: Sight, staging: Staging, width: number, height: number, into = this.places): void {
    const [right, up, towards] = sight.axes;
    const { pxPerMm, middleMm, offsets } = staging;
    const eye = sight.eyeMm;
    const positions = this.#positions;
    for (let walker = 0; walker < this.count; walker++) {
      this.#pose(walker, TURN * this.cycle(walker, time));
      const [across, above] = offsets[walker]!;
      const [x0, y0] = [this.#middles[2 * walker]!, this.#middles[2 * walker + 1]!];
      let place = 2 * walker * this.nDots;
      for (let i = 0; i < positions.length; i += 3, place += 2) {
        const x = positions[i]! - x0;
        const y = positions[i + 1]! - y0;
        const z = positions[i + 2]! - middleMm;
        let scale = pxPerMm;
        if (eye !== null) {
          const away = eye - (x * towards[0] + y * towards[1] + z * towards[2]);
          scale = away < NEAREST_MM ? NaN : (pxPerMm * eye) / away;
        }
        into[place] = width / 2 + scale * (x * right[0] + y * right[1] + z * right[2] + across);
        into[place + 1] = height / 2 - scale * (x * up[0] + y * up[1] + z * up[2] + above);
      }
    }
  }

  /** Eq. 3 of Troje (2002). */
  #pose(walker: number, angle: number): void {
    const positions = this.#positions;
    const size = positions.length;
    const p0 = walker * size;
    for (let i = 0; i < size; i++) positions[i] = this.#p0[p0 + i]!;
    for (let posture = 0; posture < this.#nPostures; posture++) {
      const row = walker * this.#nPostures + posture;
      const sine = Math.sin(this.#harmonics[posture]! * angle + this.#phases[row]!);
      const p = row * size;
      for (let i = 0; i < size; i++) positions[i]! += sine * this.#p[p + i]!;
    }
  }
}

/** The coordinates of postures, one after the other. */
function flat(postures: readonly (readonly Vector[])[]): Float64Array {
  const nDots = postures[0]?.length ?? 0;
  const coordinates = new Float64Array(3 * nDots * postures.length);
  let at = 0;
  for (const posture of postures) {
    for (const place of posture) {
      coordinates.set(place, at);
      at += 3;
    }
  }
  return coordinates;
}
