/** The frames of the screen: a function that is called for each of them, and how regular they were. */

/**
 * Call `draw` for each frame of the screen until it returns false or the returned function is
 * called. It gets the milliseconds since the first frame, and that frame's timestamp.
 */
export function everyFrame(draw: (elapsedMs: number, firstMs: number) => boolean): () => void {
  let first: number | undefined;
  let request = 0;
  const frame = (timestamp: number): void => {
    first ??= timestamp;
    if (draw(timestamp - first, first)) request = requestAnimationFrame(frame);
  };
  request = requestAnimationFrame(frame);
  return () => cancelAnimationFrame(request);
}

/** Play from a time in seconds, again and again, until the returned function is called. */
export const playLoop = (from: number, durationS: number, show: (time: number) => void): (() => void) =>
  everyFrame((elapsedMs) => {
    show((from + elapsedMs / 1000) % durationS);
    return true;
  });

export interface FrameTiming {
  /** Milliseconds from the first frame to each frame. */
  readonly times: readonly number[];
  /** Median, shortest and longest interval between frames in milliseconds; null for less than two frames. */
  readonly interval: number | null;
  readonly shortest: number | null;
  readonly longest: number | null;
  /** Frames of the screen without a new picture. */
  readonly dropped: number;
}

/**
 * How regular frames were, on a screen that is refreshed every `refreshMs` milliseconds.
 *
 * `endMs` is the first frame that does not belong to them: frames missed before it are dropped too.
 */
export function frameTiming(times: readonly number[], refreshMs: number, endMs?: number): FrameTiming {
  const intervals = intervalsOf(times);
  const sorted = intervals.toSorted((a, b) => a - b);
  const missed = (duration: number): number => Math.max(Math.round(duration / refreshMs) - 1, 0);
  return {
    times,
    interval: sorted[Math.floor(sorted.length / 2)] ?? null,
    shortest: sorted[0] ?? null,
    longest: sorted.at(-1) ?? null,
    dropped: intervalsOf(endMs === undefined ? times : [...times, endMs]).reduce((sum, each) => sum + missed(each), 0),
  };
}

const intervalsOf = (times: readonly number[]): number[] => times.slice(1).map((time, i) => time - times[i]!);

/** Frames from which the interval of the screen is measured at first, and those that are kept later. */
const FIRST_FRAMES = 30;
const KEPT_FRAMES = 600;
const USUAL_MS = 1000 / 60;

/** Measures how often the screen is refreshed, from the intervals between frames. */
export class RefreshClock {
  readonly #intervals: number[] = [];

  /** Take in the times of successive frames. */
  add(times: readonly number[]): void {
    this.#intervals.push(...intervalsOf(times).filter((interval) => interval > 1));
    this.#intervals.splice(0, this.#intervals.length - KEPT_FRAMES);
  }

  /**
   * Milliseconds from refresh to refresh.
   *
   * Where frames are dropped an interval is a multiple of it, so it is the mean of those near the lower
   * quartile.
   */
  get intervalMs(): number {
    const sorted = this.#intervals.toSorted((a, b) => a - b);
    const low = sorted[Math.floor(sorted.length / 4)];
    if (low === undefined) return USUAL_MS;
    const single = sorted.filter((interval) => interval > 0.75 * low && interval < 1.25 * low);
    return single.reduce((sum, interval) => sum + interval, 0) / single.length;
  }

  /** Watch the first frames of the page; resolved once they were measured. */
  measure(): Promise<void> {
    const times: number[] = [];
    return new Promise((resolve) => {
      everyFrame((elapsedMs) => {
        times.push(elapsedMs);
        if (times.length <= FIRST_FRAMES) return true;
        this.add(times);
        resolve();
        return false;
      });
    });
  }
}
