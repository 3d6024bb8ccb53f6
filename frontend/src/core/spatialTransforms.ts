/** Transforms of space: inversion, mirror image, rotation, size, position. */

import { positionOf, type Moment, type MovingDots, type TransformContext, type Transforms } from "./movingDots";
import type { Parameters } from "./stimulus";
import { dot, minus, radians, type Vector } from "./vector";

const NAMED_AXES: Record<"x" | "y" | "z", Vector> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** The same figure with each position changed; `change` gets the position and the time. */
export function mapPositions(moving: MovingDots, change: (position: Vector, time: number) => Vector): MovingDots {
  return moving.map(({ positions }, time) => {
    for (let i = 0; i < positions.length; i += 3) {
      positions.set(change([positions[i]!, positions[i + 1]!, positions[i + 2]!], time), i);
    }
  });
}

export const spatialTransforms: Transforms<"invert" | "mirror" | "rotate" | "resize" | "translate"> = {
  /** Turn the figure upside down: `z` becomes `2 m - z`, where m is the height of its middle. */
  invert(moving) {
    const double = 2 * moving.middle[2];
    return mapPositions(moving, ([x, y, z]) => [x, y, -z + double]);
  },

  /** Swap the sides: `y` becomes `2 m - y`, and left dots become right dots. */
  mirror(moving) {
    const double = 2 * moving.middle[1];
    const partner = moving.mirrored();
    const at = (time: number): Moment => {
      const there = moving.at(time);
      const positions = new Float64Array(there.positions.length);
      partner.forEach((other, i) => {
        const [x, y, z] = positionOf(there.positions, other);
        positions.set([x, -y + double, z], 3 * i);
      });
      return { positions, visible: Uint8Array.from(partner, (other) => there.visible[other]!) };
    };
    return moving.with({ at });
  },

  /** Turn the figure about an axis through its middle, right-handed, by an angle and at a speed. */
  rotate(moving, step, context) {
    const axis = axisOf(step.axis, context);
    const length = Math.sqrt(dot(axis, axis));
    const unit: Vector = [axis[0] / length, axis[1] / length, axis[2] / length];
    const { middle } = moving;
    return mapPositions(moving, (position, time) => {
      const angle = radians(step.angle_deg + step.speed_deg_s * time);
      const turned = turn(minus(position, middle), unit, angle);
      return [turned[0] + middle[0], turned[1] + middle[1], turned[2] + middle[2]];
    });
  },

  /** Make the figure larger or smaller about the point of the floor below its middle. */
  resize(moving, { factor }) {
    const [x0, y0] = moving.middle;
    return mapPositions(moving, ([x, y, z]) => [x0 + factor * (x - x0), y0 + factor * (y - y0), factor * z]);
  },

  /** Move the figure: `x + offset + velocity t`. */
  translate(moving, step) {
    const { offset_mm: offset, velocity_mm_s: velocity } = step;
    return mapPositions(moving, ([x, y, z], time) => [
      x + offset[0] + velocity[0] * time,
      y + offset[1] + velocity[1] * time,
      z + offset[2] + velocity[2] * time,
    ]);
  },
};

function axisOf(axis: Parameters<"rotate">["axis"], { observer }: TransformContext): Vector {
  if (axis === "sight") return observer[2];
  return typeof axis === "string" ? NAMED_AXES[axis] : axis;
}

/** Rodrigues' rotation formula. */
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