/** How a stimulus was shown: its frames, how regular they were, and whether the page was seen meanwhile. */

import { frameTiming, RefreshClock } from "./frameClock";

/** The refresh of the screen, measured once while the page is read, and by each showing. */
export const screenRefresh = new RefreshClock();
/** Resolved once the refresh was measured; undefined where there is no screen. */
export const refreshMeasured: Promise<void> | undefined =
  typeof requestAnimationFrame === "function" ? screenRefresh.measure().then(() => void (known = true)) : undefined;
let known = false;
export const isRefreshKnown = (): boolean => known;

export interface Showing {
  /** On the clock of `performance.now()`; null where no frame was shown. */
  readonly first_frame: number | null;
  readonly frame_times: readonly number[];
  readonly frames_shown: number;
  readonly frames_planned: number | null;
  readonly frame_interval: number | null;
  readonly frame_interval_min: number | null;
  readonly frame_interval_max: number | null;
  readonly frames_dropped: number;
  readonly shown_for: number | null;
  readonly refresh_rate: number;
  readonly page_hidden: number;
  readonly focus_lost: number;
  readonly clock_isolated: boolean;
}

/** To microseconds, the resolution of browsers. */
export const rounded = (milliseconds: number): number => Math.round(milliseconds * 1000) / 1000;
const roundedOrNull = (milliseconds: number | null): number | null =>
  milliseconds === null ? null : rounded(milliseconds);

/** Notes the frames of one showing; a duration in frames is rounded to the screen's refreshes. */
export class ShowingLog {
  readonly refreshMs = screenRefresh.intervalMs;
  private readonly times: number[] = [];
  private readonly watch = watchPage();
  private firstMs: number | null = null;
  private clearedMs: number | undefined;

  /** A new picture is in this frame. */
  frame(elapsedMs: number, firstMs: number): void {
    this.firstMs ??= firstMs;
    this.times.push(elapsedMs);
  }

  /** This frame is the first without the stimulus. */
  cleared(elapsedMs: number): void {
    this.clearedMs ??= elapsedMs;
  }

  /** What is known of the showing once it is over. */
  end(planned: number | null): Showing {
    const { times, firstMs, refreshMs, clearedMs } = this;
    const timing = frameTiming(times, refreshMs, clearedMs);
    screenRefresh.add(times);
    return {
      first_frame: roundedOrNull(firstMs),
      frame_times: times.map(rounded),
      frames_shown: times.length,
      frames_planned: planned,
      frame_interval: roundedOrNull(timing.interval),
      frame_interval_min: roundedOrNull(timing.shortest),
      frame_interval_max: roundedOrNull(timing.longest),
      frames_dropped: timing.dropped,
      shown_for: roundedOrNull(clearedMs ?? (firstMs === null ? null : times.at(-1)! + refreshMs)),
      refresh_rate: rounded(1000 / refreshMs),
      ...this.watch.stop(),
      clock_isolated: globalThis.crossOriginIsolated ?? false,
    };
  }
}

/** What a showing tells where nothing was shown. */
export const notShown = (): Showing => ({
  first_frame: null,
  frame_times: [],
  frames_shown: 0,
  frames_planned: null,
  frame_interval: null,
  frame_interval_min: null,
  frame_interval_max: null,
  frames_dropped: 0,
  shown_for: null,
  refresh_rate: rounded(1000 / screenRefresh.intervalMs),
  page_hidden: 0,
  focus_lost: 0,
  clock_isolated: globalThis.crossOriginIsolated ?? false,
});

/** Count how often the page is hidden, or the window left, until `stop`. */
function watchPage(): { stop(): Pick<Showing, "page_hidden" | "focus_lost"> } {
  const ending = new AbortController();
  let [page_hidden, focus_lost] = [document.hidden ? 1 : 0, 0];
  document.addEventListener("visibilitychange", () => document.hidden && page_hidden++, { signal: ending.signal });
  window.addEventListener("blur", () => focus_lost++, { signal: ending.signal });
  return {
    stop() {
      ending.abort();
      return { page_hidden, focus_lost };
    },
  };
}

/** The time of an event on the clock of `performance.now()`; now, if its timestamp is of another clock. */
export function timeOf(event: Event): number {
  const now = performance.now();
  return event.timeStamp > 0 && event.timeStamp <= now ? event.timeStamp : now;
}

/** What a click was given with; one without a pointer comes from the keyboard. */
export const deviceOf = (event: MouseEvent): string =>
  ("pointerType" in event && String(event.pointerType)) || "keyboard";
