/**
 * The mannequin's body: pieces that move with the dots, each the convex hull of two balls.
 *
 * `mannequin.json`, which Python reads too, gives their positions as weighted means of dots and their
 * radii in shares of body height. A hull has nine numbers: x, y, z and radius of each ball, in
 * millimetres to the observer's right, up and towards the observer from the centre of the view, and
 * its tone, 1 for full brightness.
 */

import shape from "../../../src/eigenwalker/stimulus/mannequin.json";
import { figureOf, type Body } from "../core/movingDots";
import type { Display, Stimulus, View } from "../core/stimulus";
import { observerAxes } from "../core/vector";

export const HULL = 9;
/** Nothing nearer to the eye than this is visible. */
const NEAREST_MM = 1;

interface Piece {
  readonly from: Readonly<Record<string, number>>;
  readonly to?: Readonly<Record<string, number>>;
  readonly radii: readonly number[];
  readonly tone?: number;
  readonly unless?: string;
}

/** A ball whose centre is a weighted mean of dots. */
interface Ball {
  readonly dots: readonly number[];
  readonly weights: readonly number[];
  readonly radiusMm: number;
}

export type Mannequin = readonly { readonly balls: readonly [Ball, Ball]; readonly tone: number }[];

/** The picture that hulls are drawn in. */
export interface RenderSettings extends Pick<Display, "width_px" | "height_px" | "px_per_mm" | "colour"> {
  readonly eye_distance_mm: number | null;
  /** Canvas pixels for one pixel of the picture. */
  readonly pixelRatio: number;
}

/** Draws all hulls over the present content of the canvas, the farther first. */
export type DrawHulls = (context: CanvasRenderingContext2D, hulls: Hulls, settings: RenderSettings) => void;

/** Direction towards the light, seen by the observer: right, up, towards. */
export const LIGHT = [-0.44, 0.67, 0.6] as const;

/** Share of white light in the specular reflection. */
const SPECULAR = 0.1;

/** Red, green and blue, 0 to 1, of a colour like `#ffffff` in full light. */
export function litColour(colour: string): [number, number, number] {
  const part = (i: number): number => {
    const share = parseInt(colour.slice(i, i + 2), 16) / 255;
    return share + SPECULAR * (1 - share);
  };
  return [part(1), part(3), part(5)];
}

/** The pieces of a figure of this height: those whose dots it has, and a rod for each other segment. */
export function mannequinOf({ dots, segments }: Body, heightMm: number): Mannequin {
  const known = new Set(dots);
  const pieces = (shape.pieces as unknown as Piece[])
    .flatMap(bothSides)
    .filter(({ from, to = {}, unless = "" }) =>
      [...Object.keys(from), ...Object.keys(to)].every((dot) => known.has(dot)) && !known.has(unless),
    );
  const named = pieces.map(({ from, to }) => new Set(Object.keys({ ...from, ...to })));
  const others = segments.filter((ends) => !named.some((dots) => ends.every((end) => dots.has(end))));
  const radii = [shape.other_radius];
  const rods = others.map(([from, to]): Piece => ({ from: { [from]: 1 }, to: { [to]: 1 }, radii }));
  return [...pieces, ...rods].map(({ from, to = from, radii, tone = 1 }) => {
    const ball = (weights: Piece["from"], radius: number): Ball => ({
      dots: Object.keys(weights).map((dot) => dots.indexOf(dot)),
      weights: Object.values(weights),
      radiusMm: radius * heightMm,
    });
    return { balls: [ball(from, radii[0]!), ball(to, radii.at(-1)!)], tone };
  });
}

/** A piece for each side, if it names joints without a side. */
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
 * The body height of each figure of a stimulus, in mm, which scales the radii of its mannequin.
 *
 * It is the height of the figure in the file, times the factors of its resize transforms.
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
      (scaled, step) =>
        step.name === "resize" && (step.figures ?? [number]).includes(number) ? scaled * step.factor : scaled,
      height,
    );
  });
}

/** All hulls of one picture, in an array that all frames share. */
export class Hulls {
  numbers = new Float32Array(64 * HULL);
  count = 0;

  clear(): void {
    this.count = 0;
  }

  /** Add a figure, without the pieces of which a dot is not visible. */
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

  /** Write a ball into the array; whether it is visible. */
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
      const [ax, ay, az] = axes[axis]!;
      numbers[at + axis] = x * ax + y * ay + z * az;
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
