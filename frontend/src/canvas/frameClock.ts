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
  /** Median interval between frames in milliseconds; null for less than two frames. */
  readonly interval: number | null;
  /** Frames of the screen without a new picture. */
  readonly dropped: number;
}

export function frameTiming(times: readonly number[]): FrameTiming {
  const intervals = times.slice(1).map((time, i) => time - times[i]!);
  const interval = intervals.toSorted((a, b) => a - b)[Math.floor(intervals.length / 2)] ?? null;
  const dropped = (duration: number): number => Math.max(Math.round(duration / interval!) - 1, 0);
  return { times, interval, dropped: interval ? intervals.reduce((sum, each) => sum + dropped(each), 0) : 0 };
}
