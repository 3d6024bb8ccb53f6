/** Transforms of dots: scrambled places, dots that live for a moment, blobs, noise. */

import { permutation, Purpose, uniforms } from "./randomStream";
import { gathered } from "./timeTransforms";
import { Moving, type Moment } from "./movingDots";
import type { Stage } from "./transformContext";
import type { Parameters } from "./stimulus";
import { dot as product, radians, type Vector } from "./vector";

const SHOWN_AXES = { both: [1, 1], horizontal: [1, 0], vertical: [0, 1] } as const;

const place = (positions: Float64Array, dot: number): Vector => [
  positions[3 * dot]!,
  positions[3 * dot + 1]!,
  positions[3 * dot + 2]!,
];

/** Put the dots elsewhere in the picture, at the same depth; each moves as it did. */
export function scramble(moving: Moving, stage: Stage, step: Parameters<"scramble">): Moving {
  const [right, up] = stage.observer;
  const middle = moving.middle;
  const seen = moving.body.dots.map((_, dot) => {
    const [x, y, z] = place(moving.mean, dot);
    const arm: Vector = [x - middle[0], y - middle[1], z - middle[2]];
    return [product(arm, right), product(arm, up)] as const;
  });
  const wanted = wantedPlaces(seen, stage, step);
  const shown = SHOWN_AXES[step.directions];
  const moved = seen.flatMap(([x, y], dot) => {
    const across = (wanted[dot]![0] - x) * shown[0];
    const above = (wanted[dot]![1] - y) * shown[1];
    return [0, 1, 2].map((axis) => across * right[axis]! + above * up[axis]!);
  });
  const at = (time: number): Moment => {
    const moment = moving.at(time);
    moved.forEach((way, i) => (moment.positions[i]! += way));
    return moment;
  };
  return moving.with({ at });
}

type Seen = readonly (readonly [number, number])[];

/** Places about the middle of the picture that the dots are to have. */
function wantedPlaces(seen: Seen, stage: Stage, step: Parameters<"scramble">): Seen {
  if (step.keep === "structure") {
    const order = permutation(Purpose.scramble, step.seed, stage.figure, seen.length);
    return order.map((dot) => seen[dot]!);
  }
  return seen.map((_, dot) => {
    const [across, above] = uniforms(Purpose.scramble, step.seed, dot, stage.figure, 2);
    return [(across! - 0.5) * step.box_mm[0], (above! - 0.5) * step.box_mm[1]];
  });
}

/**
 * Show dots that live for a moment at random places of the body in place of the joints.
 *
 * Beintema and Lappe (2002). Dot d is in life `floor(t / lifetime + asynchrony d / number)`; each
 * life draws u_1, which chooses a segment in proportion to its length in the mean posture (or a
 * joint), and u_2, how far along it.
 */
export function limbDots(moving: Moving, stage: Stage, step: Parameters<"limb_dots">): Moving {
  const { ends, reach } = segmentsOf(moving);
  const joints = moving.body.dots.length;
  const chosen = (u: number): readonly [number, number] => {
    if (step.places === "joints") {
      const joint = Math.floor(u * joints);
      return [joint, joint];
    }
    const far = u * reach.at(-1)!;
    const segment = reach.findIndex((end) => end > far);
    return ends[segment < 0 ? ends.length - 1 : segment]!;
  };
  const at = (time: number): Moment => {
    const posture = moving.at(time);
    const positions = new Float64Array(3 * step.number);
    const visible = new Uint8Array(step.number);
    for (let dot = 0; dot < step.number; dot++) {
      const ahead = (step.asynchrony * dot) / step.number;
      const life = step.lifetime_s === null ? 0 : Math.floor(time / step.lifetime_s + ahead);
      const index = dot + 65536 * stage.figure;
      const [which, share] = uniforms(Purpose.limbDots, step.seed, index, life, 2);
      const [one, other] = chosen(which!);
      for (let axis = 0; axis < 3; axis++) {
        positions[3 * dot + axis] =
          posture.positions[3 * one + axis]! * (1 - share!) +
          posture.positions[3 * other + axis]! * share!;
      }
      visible[dot] = posture.visible[one]! & posture.visible[other]!;
    }
    return { positions, visible };
  };
  return moving.with({ body: looseDots("dot", step.number), at });
}

/** Ends of the segments, and the summed lengths up to the end of each in the mean posture. */
function segmentsOf(moving: Moving): {
  ends: readonly (readonly [number, number])[];
  reach: readonly number[];
} {
  const ends = moving.body.segments.map(
    ([one, other]) => [moving.index(one), moving.index(other)] as const,
  );
  let total = 0;
  const reach = ends.map(([one, other]) => {
    const [a, b] = [place(moving.mean, one), place(moving.mean, other)];
    const way = a.map((from, axis) => from - b[axis]!).map((w) => (Number.isNaN(w) ? 0 : w));
    total += Math.sqrt(way[0]! * way[0]! + way[1]! * way[1]! + way[2]! * way[2]!);
    return total;
  });
  return { ends, reach };
}

function looseDots(word: string, number: number): Moving["body"] {
  const dots = Array.from({ length: number }, (_, dot) => `${word}_${dot + 1}`);
  return { dots, segments: [], pairs: [] };
}

/** Draw each dot as a Gaussian blob of this standard deviation. */
export function blur(moving: Moving, _: Stage, { sd_mm }: Parameters<"blur">): Moving {
  return moving.with({ blurMm: sd_mm });
}

/**
 * Noise dots in a box that faces the observer, which become a figure of their own.
 *
 * Dot d, in life `floor(t / lifetime + d / number)`, draws its place and its direction. It stays
 * (`"random"`), moves straight on (`"linear"`), or as a dot of the figure does (`"scrambled"`).
 */
export function mask(moving: Moving, stage: Stage, step: Parameters<"mask">): Moving {
  const [width, height] = step.box_mm;
  const [right, up] = stage.observer;
  const motion = step.kind === "scrambled" ? motions(moving, step) : undefined;
  const placed = (time: number, dot: number): Vector => {
    const lived = step.lifetime_s === null ? 0 : time / step.lifetime_s + dot / step.number;
    const life = Math.floor(lived);
    const age = step.lifetime_s === null ? time : (lived - life) * step.lifetime_s;
    const drawn = uniforms(Purpose.mask, step.seed, dot, life, 3);
    let [x, y] = [drawn[0]! * width, drawn[1]! * height];
    if (step.kind === "linear") {
      const heading =
        step.direction_deg === null ? 2 * Math.PI * drawn[2]! : radians(step.direction_deg);
      x = wrapped(x + step.speed_mm_s * Math.cos(heading) * age, width);
      y = wrapped(y + step.speed_mm_s * Math.sin(heading) * age, height);
    }
    const [across, above] = [x - width / 2, y - height / 2];
    return [0, 1, 2].map(
      (axis) => step.centre_mm[axis]! + across * right[axis]! + above * up[axis]!,
    ) as unknown as Vector;
  };
  const at = (time: number): Moment => {
    const moved = motion?.(time);
    const positions = moved?.positions ?? new Float64Array(3 * step.number);
    const visible = moved?.visible ?? new Uint8Array(step.number).fill(1);
    for (let dot = 0; dot < step.number; dot++) {
      placed(time, dot).forEach((where, axis) => (positions[3 * dot + axis]! += where));
    }
    return { positions, visible };
  };
  return new Moving(looseDots("noise", step.number), at, moving.periodS, moving.blurMm);
}

const wrapped = (where: number, size: number): number => where - Math.floor(where / size) * size;

/** How noise dots move about their places: the figure's dots about their means. */
function motions(moving: Moving, step: Parameters<"mask">): (time: number) => Moment {
  const source = Array.from({ length: step.number }, (_, dot) => dot % moving.body.dots.length);
  const ahead = source.map(
    (_, dot) => uniforms(Purpose.mask, step.seed, dot, 0, 3)[2]! * moving.periodS,
  );
  const mean = source.flatMap((dot) => [...place(moving.mean, dot)]);
  return (time) => {
    const now = step.phases ? undefined : moving.at(time);
    const moment = gathered(source.map((dot, i) => [now ?? moving.at(time + ahead[i]!), dot]));
    mean.forEach((where, i) => (moment.positions[i]! -= where));
    return moment;
  };
}
