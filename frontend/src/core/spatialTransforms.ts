/** Transforms of places: turned over, mirrored, turned, moved. */

import type { Moment, Moving } from "./movingDots";
import type { Stage } from "./transformContext";
import type { Parameters } from "./stimulus";
import { dot, radians, type Vector } from "./vector";

const NAMED_AXES: Record<"x" | "y" | "z", Vector> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** The same figure with each place changed; `change` gets the place and the time. */
export function placewise(moving: Moving, change: (place: Vector, time: number) => Vector): Moving {
  const at = (time: number): Moment => {
    const moment = moving.at(time);
    const { positions } = moment;
    for (let i = 0; i < positions.length; i += 3) {
      positions.set(change([positions[i]!, positions[i + 1]!, positions[i + 2]!], time), i);
    }
    return moment;
  };
  return moving.with({ at });
}

/** Turn the figure upside down: `z` becomes `2 m - z`, m being the middle's height. */
export function invert(moving: Moving): Moving {
  const double = 2 * moving.middle[2];
  return placewise(moving, ([x, y, z]) => [x, y, -z + double]);
}

/** Swap the sides: `y` becomes `2 m - y`, and what was left is called right. */
export function mirror(moving: Moving): Moving {
  const double = 2 * moving.middle[1];
  const partner = moving.mirrored();
  const at = (time: number): Moment => {
    const there = moving.at(time);
    const positions = new Float64Array(there.positions.length);
    partner.forEach((other, i) => {
      const [x, y, z] = there.positions.subarray(3 * other, 3 * other + 3);
      positions.set([x!, -y! + double, z!], 3 * i);
    });
    return { positions, visible: Uint8Array.from(partner, (other) => there.visible[other]!) };
  };
  return moving.with({ at });
}

/** Turn the figure about an axis through its middle, right-handed, standing or on and on. */
export function rotate(moving: Moving, stage: Stage, step: Parameters<"rotate">): Moving {
  const axis = named(step.axis, stage);
  const length = Math.sqrt(dot(axis, axis));
  const unit: Vector = [axis[0] / length, axis[1] / length, axis[2] / length];
  const middle = moving.middle;
  return placewise(moving, (place, time) => {
    const angle = radians(step.angle_deg + step.speed_deg_s * time);
    const arm: Vector = [place[0] - middle[0], place[1] - middle[1], place[2] - middle[2]];
    const turned = turn(arm, unit, angle);
    return [turned[0] + middle[0], turned[1] + middle[1], turned[2] + middle[2]];
  });
}

function named(axis: Parameters<"rotate">["axis"], stage: Stage): Vector {
  if (axis === "sight") return stage.observer[2];
  return typeof axis === "string" ? NAMED_AXES[axis] : axis;
}

/** Rodrigues' formula. */
function turn(arm: Vector, unit: Vector, angle: number): Vector {
  const cosine = Math.cos(angle);
  const sine = Math.sin(angle);
  const along = dot(arm, unit) * (1 - cosine);
  return [
    arm[0] * cosine + (unit[1] * arm[2] - unit[2] * arm[1]) * sine + unit[0] * along,
    arm[1] * cosine + (unit[2] * arm[0] - unit[0] * arm[2]) * sine + unit[1] * along,
    arm[2] * cosine + (unit[0] * arm[1] - unit[1] * arm[0]) * sine + unit[2] * along,
  ];
}

/** Make the figure larger or smaller about the point of the floor below its middle. */
export function resize(moving: Moving, _: Stage, { factor }: Parameters<"resize">): Moving {
  const [fixedX, fixedY] = moving.middle;
  return placewise(moving, ([x, y, z]) => [
    fixedX + factor * (x - fixedX),
    fixedY + factor * (y - fixedY),
    factor * z,
  ]);
}

/** Move the figure: `x + offset + velocity t`. */
export function translate(moving: Moving, _: Stage, step: Parameters<"translate">): Moving {
  const { offset_mm: offset, velocity_mm_s: velocity } = step;
  return placewise(moving, ([x, y, z], time) => [
    x + offset[0] + velocity[0] * time,
    y + offset[1] + velocity[1] * time,
    z + offset[2] + velocity[2] * time,
  ]);
}
