/** Transforms of dots: scrambled positions, dots of limited lifetime, blobs, noise. */

import { gathered, MovingDots, positionOf, type Moment, type TransformContext, type Transforms } from "./movingDots";
import { permutation, Purpose, uniforms } from "./randomStream";
import type { Parameters } from "./stimulus";
import { dot as product, minus, radians, type Axes, type Vector } from "./vector";

/** Whether positions change to the right, and upwards. */
const DIRECTIONS = { both: [1, 1], horizontal: [1, 0], vertical: [0, 1] } as const;

export const dotTransforms: Transforms<"scramble" | "limb_dots" | "blur" | "mask"> = {
  /** Move the dots to other places of the picture, at the same depth; each keeps its motion. */
  scramble(moving, step, context) {
    const [right, up] = context.observer;
    const places = moving.body.dots.map((_, dot) => {
      const arm = minus(positionOf(moving.mean, dot), moving.middle);
      return [product(arm, right), product(arm, up)] as const;
    });
    const targets = scrambledPlaces(places, context, step);
    const directions = DIRECTIONS[step.directions];
    const offsets = places.flatMap(([x, y], dot) => {
      const across = (targets[dot]![0] - x) * directions[0];
      const above = (targets[dot]![1] - y) * directions[1];
      return inScene(across, above, context.observer);
    });
    return moving.map(({ positions }) => offsets.forEach((offset, i) => (positions[i]! += offset)));
  },

  /**
   * Show dots of limited lifetime at random places of the body instead of the joints (Beintema and
   * Lappe, 2002).
   *
   * The life of dot d is `floor(t / lifetime + asynchrony d / number)`. For each life, u_1 chooses a
   * segment with a probability in proportion to its length in the mean posture (or a joint), and u_2 the
   * place along it.
   */
  limb_dots(moving, step, context) {
    const { ends, reach } = segmentLengths(moving);
    const nJoints = moving.body.dots.length;
    const chosen = (u: number): readonly [number, number] => {
      if (step.places === "joints") {
        const joint = Math.floor(u * nJoints);
        return [joint, joint];
      }
      const far = u * reach.at(-1)!;
      const segment = reach.findIndex((end) => end > far);
      return ends[segment < 0 ? ends.length - 1 : segment]!;
    };
    const at = (time: number): Moment => {
      const whole = moving.at(time);
      const positions = new Float64Array(3 * step.number);
      const visible = new Uint8Array(step.number);
      for (let dot = 0; dot < step.number; dot++) {
        const ahead = (step.asynchrony * dot) / step.number;
        const life = step.lifetime_s === null ? 0 : Math.floor(time / step.lifetime_s + ahead);
        const [which, share] = uniforms([Purpose.limbDots, step.seed, dot + 65536 * context.figure, life], 2);
        const [one, other] = chosen(which!);
        for (let axis = 0; axis < 3; axis++) {
          positions[3 * dot + axis] =
            whole.positions[3 * one + axis]! * (1 - share!) + whole.positions[3 * other + axis]! * share!;
        }
        visible[dot] = whole.visible[one]! & whole.visible[other]!;
      }
      return { positions, visible };
    };
    return moving.with({ body: looseDots("dot", step.number), at });
  },

  /** Draw each dot as a Gaussian blob of this standard deviation. */
  blur: (moving, { sd_mm, sd_px }) => moving.with({ blurMm: sd_mm ?? 0, blurPx: sd_px ?? 0 }),

  /**
   * Noise dots in a box that faces the observer; they are a figure of their own.
   *
   * For each life, `floor(t / lifetime + d / number)`, dot d draws its place and its direction. It stands
   * still (`"random"`), moves straight on (`"linear"`), or moves as a dot of the figure (`"scrambled"`).
   */
  mask(moving, step, { observer }) {
    const [width, height] = step.box_mm;
    const motion = step.kind === "scrambled" ? noiseMotion(moving, step) : undefined;
    const place = (time: number, dot: number): readonly number[] => {
      const lived = step.lifetime_s === null ? 0 : time / step.lifetime_s + dot / step.number;
      const life = Math.floor(lived);
      const age = step.lifetime_s === null ? time : (lived - life) * step.lifetime_s;
      const u = uniforms([Purpose.mask, step.seed, dot, life], 3);
      let [x, y] = [u[0]! * width, u[1]! * height];
      if (step.kind === "linear") {
        const heading = step.direction_deg === null ? 2 * Math.PI * u[2]! : radians(step.direction_deg);
        x = wrapped(x + step.speed_mm_s * Math.cos(heading) * age, width);
        y = wrapped(y + step.speed_mm_s * Math.sin(heading) * age, height);
      }
      return inScene(x - width / 2, y - height / 2, observer);
    };
    const at = (time: number): Moment => {
      const moved = motion?.(time);
      const positions = moved?.positions ?? new Float64Array(3 * step.number);
      const visible = moved?.visible ?? new Uint8Array(step.number).fill(1);
      for (let dot = 0; dot < step.number; dot++) {
        place(time, dot).forEach((along, axis) => (positions[3 * dot + axis]! += step.centre_mm[axis]! + along));
      }
      return { positions, visible };
    };
    return new MovingDots(looseDots("noise", step.number), at, moving.periodS, moving.blurMm, moving.blurPx);
  },
};

/** So far to the right and up for the observer, in the figure's frame. */
const inScene = (across: number, above: number, [right, up]: Axes): readonly number[] =>
  right.map((axis, i) => across * axis + above * up[i]!);

type Places = readonly (readonly [number, number])[];

/** New places of the dots about the middle of the picture. */
function scrambledPlaces(places: Places, { figure }: TransformContext, step: Parameters<"scramble">): Places {
  if (step.keep === "structure") {
    return permutation(Purpose.scramble, step.seed, figure, places.length).map((dot) => places[dot]!);
  }
  return places.map((_, dot) => {
    const [across, above] = uniforms([Purpose.scramble, step.seed, dot, figure], 2);
    return [(across! - 0.5) * step.box_mm[0], (above! - 0.5) * step.box_mm[1]];
  });
}
/** Ends of the segments, and the cumulated lengths in the mean posture. */
function segmentLengths(moving: MovingDots): {
  ends: readonly (readonly [number, number])[];
  reach: readonly number[];
} {
  const ends = moving.body.segments.map(
    ([one, other]) => [moving.index(one), moving.index(other)] as const,
  );
  let total = 0;
  const reach = ends.map(([one, other]) => {
    const between = minus(positionOf(moving.mean, one), positionOf(moving.mean, other));
    const known = between.map((way) => (Number.isNaN(way) ? 0 : way)) as unknown as Vector;
    return (total += Math.sqrt(product(known, known)));
  });
  return { ends, reach };
}

function looseDots(word: string, number: number): MovingDots["body"] {
  const dots = Array.from({ length: number }, (_, dot) => `${word}_${dot + 1}`);
  return { dots, segments: [], pairs: [] };
}
const wrapped = (value: number, size: number): number => value - Math.floor(value / size) * size;

/** The motion of noise dots about their places: that of the figure's dots about their means. */
function noiseMotion(moving: MovingDots, step: Parameters<"mask">): (time: number) => Moment {
  const source = Array.from({ length: step.number }, (_, dot) => dot % moving.body.dots.length);
  const ahead = source.map((_, dot) => uniforms([Purpose.mask, step.seed, dot, 0], 3)[2]! * moving.periodS);
  const mean = source.flatMap((dot) => positionOf(moving.mean, dot));
  return (time) => {
    const now = step.phases ? undefined : moving.at(time);
    const moment = gathered(source.map((dot, i) => [now ?? moving.at(time + ahead[i]!), dot]));
    mean.forEach((value, i) => (moment.positions[i]! -= value));
    return moment;
  };
}
