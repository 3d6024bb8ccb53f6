/** The layout size of a canvas, and whether it is visible. */

import type { Size } from "./arrangement";

/** A higher resolution does not look better, and heats a phone. */
const MAX_PIXEL_RATIO = 2;

/** Report the size now and on every change, until the signal is aborted. */
export function watchSize(
  canvas: HTMLCanvasElement,
  signal: AbortSignal,
  onSize: (size: Size, pixelRatio: number) => void,
): void {
  let last = "";
  const measure = (): void => {
    const { clientWidth: width_px, clientHeight: height_px } = canvas;
    const pixelRatio = Math.min(window.devicePixelRatio || 1, MAX_PIXEL_RATIO);
    const now = [width_px, height_px, pixelRatio].join();
    if (now === last) return;
    last = now;
    onSize({ width_px, height_px }, pixelRatio);
  };
  const observer = new ResizeObserver(measure);
  observer.observe(canvas);
  signal.addEventListener("abort", () => observer.disconnect());
  window.addEventListener("resize", measure, { signal });
  measure();
}

/** Report on every change whether an element is visible, until the signal is aborted. */
export function watchVisibility(element: HTMLElement, signal: AbortSignal, onChange: (visible: boolean) => void): void {
  let onScreen = true;
  const report = (): void => onChange(onScreen && !document.hidden);
  const observer = new IntersectionObserver((entries) => {
    onScreen = entries.at(-1)!.isIntersecting;
    report();
  });
  observer.observe(element);
  signal.addEventListener("abort", () => observer.disconnect());
  document.addEventListener("visibilitychange", report, { signal });
}
