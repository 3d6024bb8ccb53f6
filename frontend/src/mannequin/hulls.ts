/**
 * The mannequin's body: pieces of wood that go with the dots, each the hull of two balls.
 *
 * `mannequin.json`, which Python reads too, has their places as weighted means of dots and their
 * girth in shares of body height. A hull counts nine numbers: x, y, z and radius of either ball, in
 * millimetres to the observer's right, up and towards the observer from the centre of the view, and
 * its tone, 1 for as bright as the light makes it.
 */

import shape from "../../../src/eigenwalker/stimulus/mannequin.json";
import type { Body } from "../core/movingDots";
import { figureOf } from "../core/scene";
import type { Stimulus, View } from "../core/stimulus";
import { observerAxes } from "../core/vector";

/** Numbers a hull. */
export const HULL = 9;
/** Nearer to the eye than this, in mm, nothing is seen. */
const NEAREST_MM = 1;

interface Piece {
  readonly from: Readonly<Record<string, number>>;
  readonly to?: Readonly<Record<string, number>>;
  readonly radii: readonly number[];
  readonly tone?: number;
  readonly unless?: string;
}

/** A ball whose middle is a weighted mean of dots. */
interface Ball {
  readonly dots: readonly number[];
  readonly weights: readonly number[];
  readonly radiusMm: number;
}

/** A piece of one figure. */
interface Carved {
  readonly balls: readonly [Ball, Ball];
  readonly tone: number;
}

export type Mannequin = readonly Carved[];

/** The pieces of a figure of this height: those whose dots it has, and a rod for other segments. */
export function mannequinOf({ dots, segments }: Body, heightMm: number): Mannequin {
  const known = new Set(dots);
  const pieces = (shape.pieces as unknown as Piece[])
    .flatMap(bothSides)
    .filter(({ from, to = {}, unless = "" }) =>
      [...Object.keys(from), ...Object.keys(to)].every((dot) => known.has(dot)) && !known.has(unless),
    );
  const named = pieces.map(({ from, to }) => new Set(Object.keys({ ...from, ...to })));
  const others = segments.filter((ends) => !named.some((dots) => ends.every((end) => dots.has(end))));
  const rods = others.map(([from, to]): Piece => {
    const radii = [shape.other_radius, shape.other_radius];
    return { from: { [from]: 1 }, to: { [to]: 1 }, radii };
  });
  return [...pieces, ...rods].map(({ from, to = from, radii, tone = 1 }) => {
    const ball = (weights: Piece["from"], radius: number): Ball => ({
      dots: Object.keys(weights).map((dot) => dots.indexOf(dot)),
      weights: Object.values(weights),
      radiusMm: radius * heightMm,
    });
    return { balls: [ball(from, radii[0]!), ball(to, radii.at(-1)!)], tone };
  });
}

/** A piece for each side, where it names joints without one. */
function bothSides(piece: Piece): Piece[] {
  const sides = ["left_", "right_"].map((side): Piece => {
    const sided = (weights: Piece["from"]): Piece["from"] =>
      Object.fromEntries(Object.entries(weights).map(([dot, weight]) => [sidedName(dot, side), weight]));
    const { from, to, unless } = piece;
    return {
      ...piece,
      from: sided(from),
      ...(to && { to: sided(to) }),
      ...(unless !== undefined && { unless: side + unless }),
    };
  });
  const [left, right] = sides.map(({ from, to }) => JSON.stringify([from, to]));
  return left === right ? [sides[0]!] : sides;
}

const sidedName = (dot: string, side: string): string =>
  /^(head|sternum|pelvis|left_.*|right_.*)$/.test(dot) ? dot : side + dot;

/**
 * The body height of each figure of a stimulus, in mm, by which its mannequin is as thick.
 *
 * It is that of the figure as it stands in the file, times the factors by which it is resized.
 */
export function bodyHeights({ figures, transforms }: Stimulus): number[] {
  return figures.map((figure, number) => {
    const { mean } = figureOf(figure);
    const extents = [0, 1, 2].map((axis) => {
      const places = mean.filter((place, i) => i % 3 === axis && !Number.isNaN(place));
      return Math.max(...places) - Math.min(...places);
    });
    const height = shape.body_height * Math.max(...extents, 0);
    return transforms.reduce(
      (so, step) =>
        step.name === "resize" && (step.figures ?? [number]).includes(number) ? so * step.factor : so,
      height,
    );
  });
}

/** All hulls of one picture, in an array that is used again from frame to frame. */
export class Hulls {
  numbers = new Float32Array(64 * HULL);
  count = 0;

  clear(): void {
    this.count = 0;
  }

  /** Add a figure; its pieces of which a dot is not seen are left out. */
  add(pieces: Mannequin, positions: Float64Array, visible: Uint8Array, view: View): void {
    const axes = observerAxes(view.view_deg, view.elevation_deg);
    const nearest = (view.eye_distance_mm ?? Infinity) - NEAREST_MM;
    this.#makeRoom(pieces.length);
    for (const { balls, tone } of pieces) {
      const first = HULL * this.count;
      if (!balls.every((ball, i) => this.#put(first + 4 * i, ball, positions, visible, axes, view, nearest))) continue;
      this.numbers[first + 8] = tone;
      this.count += 1;
    }
  }

  /** Write a ball down, and say whether it is to be seen. */
  #put(
    at: number,
    { dots, weights, radiusMm }: Ball,
    positions: Float64Array,
    visible: Uint8Array,
    axes: ReturnType<typeof observerAxes>,
    { centre_mm: centre }: View,
    nearest: number,
  ): boolean {
    let [x, y, z] = [-centre[0], -centre[1], -centre[2]];
    for (let i = 0; i < dots.length; i++) {
      const [dot, weight] = [dots[i]!, weights[i]!];
      if (!visible[dot]) return false;
      x += weight * positions[3 * dot]!;
      y += weight * positions[3 * dot + 1]!;
      z += weight * positions[3 * dot + 2]!;
    }
    const { numbers } = this;
    for (let axis = 0; axis < 3; axis++) {
      const [along_x, along_y, along_z] = axes[axis]!;
      numbers[at + axis] = x * along_x + y * along_y + z * along_z;
    }
    numbers[at + 3] = radiusMm;
    return numbers[at + 2]! + radiusMm <= nearest;
  }

  #makeRoom(more: number): void {
    const wanted = HULL * (this.count + more);
    if (wanted <= this.numbers.length) return;
    const larger = new Float32Array(2 * wanted);
    larger.set(this.numbers);
    this.numbers = larger;
  }
}
