/** How fast a walk in place is: the ground goes backwards as fast as the feet that stand on it. */

/** Share of the cycle in which an ankle is lowest. */
const STANCE_SHARE = 0.35;
/** A low ankle stands while it goes with the ground at this share of the usual speed or more. */
const STANDING_BEYOND = 0.7;

/** One ankle over time. */
export interface Path {
  readonly x: Float64Array;
  readonly y: Float64Array;
  readonly z: Float64Array;
}

/** The speed along +x in mm/s that the standing feet tell, as Python's `stance_speed` has it. */
export function stanceSpeed(ankles: readonly Path[], rateHz: number): number {
  return -mean(ankles.map((ankle) => whileStanding(ankle, rateHz)));
}

/** How fast an ankle moves along x while it stands. */
function whileStanding({ x, y, z }: Path, rateHz: number): number {
  const velocity = { x: gradient(x, rateHz), y: gradient(y, rateHz) };
  const limit = quantile([...z], STANCE_SHARE);
  const low = [...z.keys()].filter((moment) => z[moment]! <= limit);
  const usual = [mean(low.map((m) => velocity.x[m]!)), mean(low.map((m) => velocity.y[m]!))] as const;
  const length = Math.max(Math.hypot(...usual), 1e-9);
  const along = low.map((m) => (velocity.x[m]! * usual[0] + velocity.y[m]! * usual[1]) / length);
  const least = STANDING_BEYOND * quantile(along, 0.5);
  return mean(low.filter((_, i) => along[i]! >= least).map((m) => velocity.x[m]!));
}

/** Change per second: over two samples, over one at the ends. */
function gradient(path: Float64Array, rateHz: number): Float64Array {
  const last = path.length - 1;
  return path.map((_, i) => {
    const [before, after] = [Math.max(i - 1, 0), Math.min(i + 1, last)];
    return ((path[after]! - path[before]!) * rateHz) / (after - before);
  });
}

/** The value below which a share of the values lies, a straight line between neighbours. */
function quantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const below = Math.floor(place);
  const [low, high] = [sorted[below]!, sorted[Math.min(below + 1, sorted.length - 1)]!];
  return low + (place - below) * (high - low);
}

const mean = (values: readonly number[]): number =>
  values.reduce((sum, value) => sum + value, 0) / values.length;
