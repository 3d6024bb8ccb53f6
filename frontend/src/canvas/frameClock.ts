/** The screen's own clock: something is done once for each of its frames. */

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

/** How regular the frames of the screen were. */
export interface FrameTiming {
  /** Milliseconds from the first frame to each frame. */
  readonly times: readonly number[];
  /** Median interval between frames, in milliseconds; null for less than two. */
  readonly interval: number | null;
  /** Frames of the screen that came and went without a new picture. */
  readonly dropped: number;
}

export function frameTiming(times: readonly number[]): FrameTiming {
  const intervals = times.slice(1).map((time, i) => time - times[i]!);
  const sorted = [...intervals].sort((a, b) => a - b);
  const interval = sorted[Math.floor(sorted.length / 2)] ?? null;
  const lost = (lasts: number): number => Math.max(Math.round(lasts / interval!) - 1, 0);
  const dropped = interval ? intervals.reduce((sum, lasts) => sum + lost(lasts), 0) : 0;
  return { times, interval, dropped };
}
