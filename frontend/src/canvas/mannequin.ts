/** A mannequin of tapered, shaded limbs, the farther drawn before the nearer. */

import type { Stimulus } from "../core/stimulus";
import { dot, observerAxes, type Vector } from "../core/vector";
import type { Shown } from "./frame";

/** Radii in mm about joints, of the limb that leads to them from the trunk or ends there. */
const RADII: Readonly<Record<string, number>> = {
  head: 88,
  sternum: 92,
  pelvis: 96,
  shoulder: 52,
  elbow: 37,
  wrist: 27,
  hand: 24,
  hip: 84,
  knee: 53,
  ankle: 36,
  heel: 34,
  toe: 26,
};
const USUAL_MM = 30;
const NECK_MM = 46;
/** How bright a limb is across its width, seen from upper left to lower right. */
const SHADES = [
  [0, 0.72],
  [0.3, 1],
  [0.65, 0.72],
  [1, 0.38],
] as const;

interface Ball {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
  /** Towards the observer, in mm. */
  readonly near: number;
}

/** Draw one figure, which must have its joints' usual names to have its usual girth. */
export function drawMannequin(
  context: CanvasRenderingContext2D,
  shown: Shown,
  { display, view }: Stimulus,
): void {
  const towards = observerAxes(view.view_deg, view.elevation_deg)[2];
  const { body } = shown.moving;
  const ball = (number: number, girth: number): Ball => {
    const place = [...shown.positions.subarray(3 * number, 3 * number + 3)] as unknown as Vector;
    const near = dot(place, towards) - dot(view.centre_mm, towards);
    const eye = view.eye_distance_mm;
    const scale = eye === null ? 1 : eye / (eye - near);
    const [x, y] = [shown.places[2 * number]!, shown.places[2 * number + 1]!];
    return { x, y, near, radius: girth * display.px_per_mm * scale };
  };
  const limbs = body.segments
    .map((names) => [...names].sort((a, b) => girthOf(b) - girthOf(a)))
    .map((names) => ({ names, ends: names.map((name) => body.dots.indexOf(name)) }))
    .filter(({ ends }) => ends.every((end) => shown.visible[end]))
    .map(({ names, ends }) => {
      const neck = names.includes("head");
      return ends.map((end, i) => ball(end, neck ? NECK_MM : girthOf(names[i]!)));
    });
  const loose = body.dots
    .map((name, number) => ({ name, number }))
    .filter(({ name, number }) => shown.visible[number] && name === "head")
    .map(({ name, number }) => [ball(number, girthOf(name))]);
  const depth = (balls: readonly Ball[]): number =>
    balls.reduce((sum, { near }) => sum + near, 0) / balls.length;
  for (const balls of [...limbs, ...loose].sort((a, b) => depth(a) - depth(b))) {
    drawLimb(context, balls[0]!, balls.at(-1)!, display.colour);
  }
}

const girthOf = (name: string): number =>
  RADII[name] ?? RADII[name.replace(/^(left|right)_/, "")] ?? USUAL_MM;

/** Two balls and what lies between them. */
function drawLimb(context: CanvasRenderingContext2D, one: Ball, other: Ball, colour: string): void {
  const along = Math.atan2(other.y - one.y, other.x - one.x);
  const apart = Math.hypot(other.x - one.x, other.y - one.y);
  const larger = Math.max(one.radius, other.radius);
  context.beginPath();
  if (apart <= Math.abs(one.radius - other.radius)) {
    const ball = one.radius >= other.radius ? one : other;
    context.arc(ball.x, ball.y, ball.radius, 0, 2 * Math.PI);
  } else {
    const lean = Math.acos((one.radius - other.radius) / apart);
    context.arc(one.x, one.y, one.radius, along + lean, along - lean);
    context.arc(other.x, other.y, other.radius, along - lean, along + lean);
    context.closePath();
  }
  context.fillStyle = one === other ? roundShade(context, one, colour) : limbShade();
  context.fill();

  /** Light falls from the upper left: the shade runs across the limb, away from it. */
  function limbShade(): CanvasGradient {
    const across = along + Math.PI / 2;
    const away = Math.cos(across) + Math.sin(across) >= 0 ? larger : -larger;
    const [x, y] = [(one.x + other.x) / 2, (one.y + other.y) / 2];
    const [dx, dy] = [away * Math.cos(across), away * Math.sin(across)];
    const shade = context.createLinearGradient(x - dx, y - dy, x + dx, y + dy);
    for (const [share, light] of SHADES) shade.addColorStop(share, darker(colour, light));
    return shade;
  }
}

/** The shade of a ball, lit from the upper left. */
function roundShade(context: CanvasRenderingContext2D, ball: Ball, colour: string): CanvasGradient {
  const { x, y, radius } = ball;
  const lit = radius / 3;
  const shade = context.createRadialGradient(x - lit, y - lit, 0, x, y, radius);
  shade.addColorStop(0, colour);
  shade.addColorStop(1, darker(colour, 0.5));
  return shade;
}

/** A colour like `#ffffff` with a share of its light. */
function darker(colour: string, light: number): string {
  const parts = [1, 3, 5].map((i) => Math.round(parseInt(colour.slice(i, i + 2), 16) * light));
  return `rgb(${parts.join(" ")})`;
}
