/** Which of some points is meant: the nearest to a place, or the next one that way. */

export interface Place {
  readonly x: number;
  readonly y: number;
}

/** Right and down. */
export type Way = readonly [number, number];

/** The number of the nearest point, -1 where none is within a distance. */
export function nearest(points: readonly Place[], { x, y }: Place, within: number): number {
  const far = points.map((point) => Math.hypot(point.x - x, point.y - y));
  const best = far.indexOf(Math.min(...far));
  return best >= 0 && far[best]! < within ? best : -1;
}

/** The nearest point that lies more that way than aside; the same where there is none. */
export function towards(points: readonly Place[], from: number, [right, below]: Way): number {
  const here = points[from];
  if (!here) return 0;
  let [best, least] = [from, Infinity];
  points.forEach((point, number) => {
    const [h, v] = [point.x - here.x, point.y - here.y];
    const ahead = h * right + v * below;
    const aside = Math.abs(h * below) + Math.abs(v * right);
    const cost = ahead + 2 * aside;
    if (ahead > 0 && aside <= 2 * ahead && cost < least) [best, least] = [number, cost];
  });
  return best;
}
