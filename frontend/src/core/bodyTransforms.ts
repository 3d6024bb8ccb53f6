/** Transforms of the body: parts hidden, larger or smaller movements, planted cues. */

import { outward, type Moment, type Moving } from "./movingDots";
import type { Stage } from "./transformContext";
import type { Parameters } from "./stimulus";
import { radians } from "./vector";

const SIDES = ["left", "right"] as const;
const ARM = ["shoulder", "elbow", "wrist"];
const LEG = ["hip", "knee", "ankle"];

/** How far each dot goes along when the shoulders, or the hips, sway more. */
const SWAY = {
  shoulder: along([["head", 1], ["sternum", 1]], [["shoulder", 1], ["elbow", 1], ["wrist", 1]]),
  hip: along([["pelvis", 1]], [["hip", 1], ["knee", 0.5]]),
};

function along(
  middle: readonly (readonly [string, number])[],
  sides: readonly (readonly [string, number])[],
): Map<string, number> {
  const both = SIDES.flatMap((side) => sides.map(([part, far]) => [`${side}_${part}`, far] as const));
  return new Map([...middle, ...both]);
}

/** The same figure with each moment changed in place. */
function momentwise(moving: Moving, change: (moment: Moment, time: number) => void): Moving {
  const at = (time: number): Moment => {
    const moment = moving.at(time);
    change(moment, time);
    return moment;
  };
  return moving.with({ at });
}

/** Hide dots; their motion stays as it is. */
export function occlude(moving: Moving, _: Stage, step: Parameters<"occlude">): Moving {
  const hidden = moving.named(step.markers);
  return momentwise(moving, ({ visible }) => {
    hidden.forEach((hides, dot) => {
      if (hides) visible[dot] = 0;
    });
  });
}

/**
 * Make movements of joints larger or smaller.
 *
 * From the root outwards, the way from the joint that carries it is r(t) with the mean m over a
 * period; for the named joints it becomes `m + factor (r - m)` on the named axes, and what they
 * carry goes along.
 */
export function gain(moving: Moving, _: Stage, step: Parameters<"gain">): Moving {
  const parents = moving.parents();
  const order = outward(parents);
  const factors = [..."xyz"].map((axis) => (step.axes.includes(axis) ? step.factor : 1));
  const named = moving.named(step.markers);
  const mean = moving.mean;
  return momentwise(moving, ({ positions }) => {
    const usual = positions.slice();
    for (const dot of order) {
      const parent = parents[dot]!;
      for (let axis = 0; axis < 3; axis++) {
        const [here, there] = [3 * dot + axis, 3 * parent + axis];
        let way = usual[here]! - (parent < 0 ? 0 : usual[there]!);
        if (named[dot]) {
          const meanWay = mean[here]! - (parent < 0 ? 0 : mean[there]!);
          way = meanWay + factors[axis]! * (way - meanWay);
        }
        positions[here] = (parent < 0 ? 0 : positions[there]!) + way;
      }
    }
  });
}

/** Set the widths of shoulders and hips against their sway from side to side. */
export function conflict(moving: Moving, _: Stage, step: Parameters<"conflict">): Moving {
  const { dots } = moving.body;
  const mean = moving.mean;
  const y = (side: string, joint: string): number => 3 * moving.index(`${side}_${joint}`) + 1;
  const wider = new Float64Array(dots.length);
  for (const [joint, chain, factor] of [
    ["shoulder", ARM, step.shoulder_width],
    ["hip", LEG, step.hip_width],
  ] as const) {
    const apart = mean[y("left", joint)]! - mean[y("right", joint)]!;
    for (const [side, sign] of [["left", 0.5], ["right", -0.5]] as const) {
      for (const part of chain) {
        const dot = moving.index(`${side}_${part}`);
        if (dot >= 0) wider[dot]! += sign * (factor - 1) * apart;
      }
    }
  }
  const sways = ([["shoulder", step.shoulder_sway], ["hip", step.hip_sway]] as const).map(
    ([joint, factor]) => ({
      left: y("left", joint),
      right: y("right", joint),
      more: factor - 1,
      along: dots.map((dot) => SWAY[joint].get(dot) ?? 0),
    }),
  );
  return momentwise(moving, ({ positions }) => {
    const more = sways.map(
      ({ left, right, more }) =>
        more * ((positions[left]! + positions[right]!) / 2 - (mean[left]! + mean[right]!) / 2),
    );
    dots.forEach((_dot, dot) => {
      positions[3 * dot + 1]! += wider[dot]!;
      sways.forEach((sway, i) => (positions[3 * dot + 1]! += more[i]! * sway.along[dot]!));
    });
  });
}

/** Let shoulders and hips go round ellipses, as in Cutting's (1978) synthetic walkers. */
export function ellipses(moving: Moving, _: Stage, step: Parameters<"ellipses">): Moving {
  const mean = moving.mean;
  const rings = SIDES.flatMap((side) =>
    ([[ARM, step.shoulder_mm, 180], [LEG, step.hip_mm, 0]] as const).map(([chain, axes, turn]) => {
      const carried = chain.map((part) => moving.index(`${side}_${part}`)).filter((dot) => dot >= 0);
      const joint = moving.index(`${side}_${chain[0]}`);
      return { joint, carried, axes, ahead: radians(step.phase_deg + (side === "right" ? 180 : 0) + turn) };
    }),
  );
  return momentwise(moving, ({ positions }, time) => {
    for (const { joint, carried, axes, ahead } of rings) {
      const cycle = (2 * Math.PI * time) / moving.periodS + ahead;
      const x = mean[3 * joint]! + axes[0] * Math.sin(cycle) - positions[3 * joint]!;
      const z = mean[3 * joint + 2]! + axes[1] * Math.cos(cycle) - positions[3 * joint + 2]!;
      for (const dot of carried) {
        positions[3 * dot]! += x;
        positions[3 * dot + 2]! += z;
      }
    }
  });
}

/** Disturb single joints: from start to before end, `amount sin(2 pi f (t - start) + phase)`. */
export function perturb(moving: Moving, _: Stage, step: Parameters<"perturb">): Moving {
  const named = moving.named(step.markers);
  return momentwise(moving, ({ positions }, time) => {
    if (time < step.start_s || time >= step.end_s) return;
    const wave = Math.sin(
      2 * Math.PI * step.frequency_hz * (time - step.start_s) + radians(step.phase_deg),
    );
    for (let i = 0; i < positions.length; i++) {
      if (named[Math.floor(i / 3)]) positions[i]! += wave * step.amount_mm[i % 3]!;
    }
  });
}
