/** Painters of mannequins, and one that needs no WebGL: outlines of hulls, shaded across, the farther first. */

import { hasLimbs, type MannequinPainter } from "../canvas/mannequinLoader";
import {
  bodyHeights, HULL, Hulls, LIGHT, litColour, mannequinOf,
  type DrawHulls, type Mannequin, type RenderSettings,
} from "./hulls";

/** A small painter that needs no WebGL; pages with a viewer include it. */
export const flatPainter = (): MannequinPainter => makePainter(drawFlat);

export function makePainter(draw: DrawHulls): MannequinPainter {
  const hulls = new Hulls();
  const mannequins = new WeakMap<object, readonly Mannequin[]>();
  return {
    solid: draw !== drawFlat,
    paint(context, figures, stimulus, pixelRatio) {
      let bodies = mannequins.get(stimulus);
      if (!bodies) {
        const heights = bodyHeights(stimulus);
        bodies = figures.map(({ moving }, i) => mannequinOf(moving.body, heights[i] ?? 0));
        mannequins.set(stimulus, bodies);
      }
      hulls.clear();
      figures.forEach(({ moving, positions, visible }, i) => {
        if (hasLimbs(moving)) hulls.add(bodies[i]!, positions, visible, stimulus.view);
      });
      const { eye_distance_mm } = stimulus.view;
      draw(context, hulls, { ...stimulus.display, eye_distance_mm, pixelRatio });
    },
  };
}

/** Brightness across the width of a hull, from the lit side to the dark side. */
const SHADES = [
  [0, 0.62],
  [0.3, 0.85],
  [0.65, 0.7],
  [1, 0.32],
] as const;

interface Ball {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
  /** Position towards the observer, and radius, in mm. */
  readonly near: number;
  readonly girth: number;
}

const drawFlat: DrawHulls = (context, hulls, settings) => {
  const { numbers } = hulls;
  const colour = litColour(settings.colour);
  const pieces = Array.from({ length: hulls.count }, (_, i) => ({
    one: ballOf(numbers, HULL * i, settings),
    other: ballOf(numbers, HULL * i + 4, settings),
    tone: numbers[HULL * i + 8]!,
  }));
  const near = ({ one, other, tone }: (typeof pieces)[number]): number =>
    (one.near + other.near) / 2 - (tone < 1 ? one.girth : 0); // joints before the limbs they join
  pieces.sort((a, b) => near(a) - near(b));
  for (const { one, other, tone } of pieces) {
    const larger = one.radius >= other.radius ? one : other;
    outline(context, one, other);
    context.fillStyle = shadeOf(context, larger, one, other, colour.map((part) => part * tone));
    context.fill();
  }
};

function ballOf(numbers: Float32Array, at: number, settings: RenderSettings): Ball {
  const [right, up, near, radius] = numbers.subarray(at, at + 4) as unknown as number[];
  const eye = settings.eye_distance_mm;
  const scale = settings.px_per_mm * (eye === null ? 1 : eye / (eye - near!));
  return {
    x: settings.width_px / 2 + scale * right!,
    y: settings.height_px / 2 - scale * up!,
    radius: scale * radius!,
    near: near!,
    girth: radius!,
  };
}

function outline(context: CanvasRenderingContext2D, one: Ball, other: Ball): void {
  const along = Math.atan2(other.y - one.y, other.x - one.x);
  const apart = Math.hypot(other.x - one.x, other.y - one.y);
  context.beginPath();
  if (apart <= Math.abs(one.radius - other.radius)) {
    const ball = one.radius >= other.radius ? one : other;
    context.arc(ball.x, ball.y, ball.radius, 0, 2 * Math.PI);
    return;
  }
  const lean = Math.acos((one.radius - other.radius) / apart);
  context.arc(one.x, one.y, one.radius, along + lean, along - lean);
  context.arc(other.x, other.y, other.radius, along - lean, along + lean);
  context.closePath();
}

/** A gradient across a hull, away from the light. */
function shadeOf(
  context: CanvasRenderingContext2D,
  { radius }: Ball,
  one: Ball,
  other: Ball,
  colour: readonly number[],
): CanvasGradient {
  const [x, y] = [(one.x + other.x) / 2, (one.y + other.y) / 2];
  const along = Math.atan2(other.y - one.y, other.x - one.x);
  const across = one.x === other.x && one.y === other.y ? Math.atan2(LIGHT[1], -LIGHT[0]) : along + Math.PI / 2;
  const [dx, dy] = [Math.cos(across), Math.sin(across)];
  const away = LIGHT[0] * dx - LIGHT[1] * dy <= 0 ? radius : -radius;
  const shade = context.createLinearGradient(x - away * dx, y - away * dy, x + away * dx, y + away * dy);
  for (const [share, light] of SHADES) {
    shade.addColorStop(share, `rgb(${colour.map((part) => Math.round(255 * light * part)).join(" ")})`);
  }
  return shade;
}
