/** Transforms of the body: hidden parts, larger or smaller movements, planted cues. */

import type { Transforms } from "./movingDots";
import { radians } from "./vector";

const SIDES = ["left", "right"] as const;
const ARM = ["shoulder", "elbow", "wrist"];
const LEG = ["hip", "knee", "ankle"];

/** The share of the sway of shoulders, or hips, that each dot takes part in. */
const SWAY = {
  shoulder: swayShares({ head: 1, sternum: 1 }, { shoulder: 1, elbow: 1, wrist: 1 }),
  hip: swayShares({ pelvis: 1 }, { hip: 1, knee: 0.5 }),
};

function swayShares(middle: Record<string, number>, sides: Record<string, number>): Map<string, number> {
  const sided = SIDES.flatMap((side) =>
    Object.entries(sides).map(([part, share]) => [`${side}_${part}`, share] as const),
  );
  return new Map([...Object.entries(middle), ...sided]);
}

export const bodyTransforms: Transforms<"occlude" | "gain" | "conflict" | "ellipses" | "perturb"> = {
  /** Hide dots; their motion stays as it is. */
  occlude(moving, step) {
    const hidden = moving.named(step.markers);
    return moving.map(({ visible }) => {
      hidden.forEach((isHidden, dot) => {
        if (isHidden) visible[dot] = 0;
      });
    });
  },

  /**
   * Make movements of joints larger or smaller.
   *
   * From the root outwards, the vector from a joint's parent to the joint is r(t), with the mean m over a
   * period; for the named joints it becomes `m + factor (r - m)` on the named axes. Their descendants
   * move along.
   */
  gain(moving, step) {
    const order = moving.outward();
    const factors = [..."xyz"].map((axis) => (step.axes.includes(axis) ? step.factor : 1));
    const named = moving.named(step.markers);
    const { mean } = moving;
    return moving.map(({ positions }) => {
      const before = positions.slice();
      for (const [dot, parent] of order) {
        for (let axis = 0; axis < 3; axis++) {
          const [here, there] = [3 * dot + axis, 3 * parent + axis];
          let from = before[here]! - (parent < 0 ? 0 : before[there]!);
          if (named[dot]) {
            const meanFrom = mean[here]! - (parent < 0 ? 0 : mean[there]!);
            from = meanFrom + factors[axis]! * (from - meanFrom);
          }
          positions[here] = (parent < 0 ? 0 : positions[there]!) + from;
        }
      }
    });
  },

  /** Set the widths of shoulders and hips against their lateral sway. */
  conflict(moving, step) {
    const { mean, body: { dots } } = moving;
    const y = (side: string, joint: string): number => 3 * moving.index(`${side}_${joint}`) + 1;
    const wider = new Float64Array(dots.length);
    for (const [chain, factor] of [[ARM, step.shoulder_width], [LEG, step.hip_width]] as const) {
      const width = mean[y("left", chain[0]!)]! - mean[y("right", chain[0]!)]!;
      for (const [side, sign] of [["left", 0.5], ["right", -0.5]] as const) {
        for (const part of chain) {
          const dot = moving.index(`${side}_${part}`);
          if (dot >= 0) wider[dot]! += sign * (factor - 1) * width;
        }
      }
    }
    const sways = ([["shoulder", step.shoulder_sway], ["hip", step.hip_sway]] as const).map(([joint, factor]) => ({
      left: y("left", joint),
      right: y("right", joint),
      more: factor - 1,
      shares: dots.map((dot) => SWAY[joint].get(dot) ?? 0),
    }));
    return moving.map(({ positions }) => {
      const more = sways.map(
        ({ left, right, more }) =>
          more * ((positions[left]! + positions[right]!) / 2 - (mean[left]! + mean[right]!) / 2),
      );
      dots.forEach((_dot, dot) => {
        positions[3 * dot + 1]! += wider[dot]!;
        sways.forEach(({ shares }, i) => (positions[3 * dot + 1]! += more[i]! * shares[dot]!));
      });
    });
  },

  /** Move shoulders and hips on ellipses, as in Cutting's (1978) synthetic walkers. */
  ellipses(moving, step) {
    const { mean } = moving;
    const rings = SIDES.flatMap((side) =>
      ([[ARM, step.shoulder_mm, 180], [LEG, step.hip_mm, 0]] as const).map(([chain, axes, turn]) => {
        const carried = chain.map((part) => moving.index(`${side}_${part}`)).filter((dot) => dot >= 0);
        const joint = moving.index(`${side}_${chain[0]}`);
        return { joint, carried, axes, phase: radians(step.phase_deg + (side === "right" ? 180 : 0) + turn) };
      }),
    );
    return moving.map(({ positions }, time) => {
      for (const { joint, carried, axes, phase } of rings) {
        const angle = (2 * Math.PI * time) / moving.periodS + phase;
        const x = mean[3 * joint]! + axes[0] * Math.sin(angle) - positions[3 * joint]!;
        const z = mean[3 * joint + 2]! + axes[1] * Math.cos(angle) - positions[3 * joint + 2]!;
        for (const dot of carried) {
          positions[3 * dot]! += x;
          positions[3 * dot + 2]! += z;
        }
      }
    });
  },

  /** Disturb single joints: from start to before end, `amount sin(2 pi f (t - start) + phase)`. */
  perturb(moving, step) {
    const named = moving.named(step.markers);
    return moving.map(({ positions }, time) => {
      if (time < step.start_s || time >= step.end_s) return;
      const angle = 2 * Math.PI * step.frequency_hz * (time - step.start_s) + radians(step.phase_deg);
      const wave = Math.sin(angle);
      for (let i = 0; i < positions.length; i++) {
        if (named[Math.floor(i / 3)]) positions[i]! += wave * step.amount_mm[i % 3]!;
      }
    });
  },
};