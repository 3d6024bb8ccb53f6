/** How large a canvas is laid out, and whether anybody sees it. */

import type { Size } from "./arrangement";

/** Finer than this no dot looks better, and a phone gets warm. */
const MOST_FINE = 2;

/** Tell the size now and whenever it changes, until the returned function is called. */
export function watchSize(canvas: HTMLCanvasElement, told: (size: Size, fine: number) => void): () => void {
  const ending = new AbortController();
  let known = "";
  const measure = (): void => {
    const { clientWidth: width_px, clientHeight: height_px } = canvas;
    const fine = Math.min(window.devicePixelRatio || 1, MOST_FINE);
    const found = [width_px, height_px, fine].join();
    if (found === known) return;
    known = found;
    told({ width_px, height_px }, fine);
  };
  const observer = new ResizeObserver(measure);
  observer.observe(canvas);
  window.addEventListener("resize", measure, { signal: ending.signal });
  measure();
  return () => {
    observer.disconnect();
    ending.abort();
  };
}

/** Tell whether an element is in sight, whenever that changes, until the returned function is called. */
export function watchSight(element: HTMLElement, told: (inSight: boolean) => void): () => void {
  const ending = new AbortController();
  let onScreen = true;
  const tell = (): void => told(onScreen && !document.hidden);
  const observer = new IntersectionObserver((entries) => {
    onScreen = entries.at(-1)!.isIntersecting;
    tell();
  });
  observer.observe(element);
  document.addEventListener("visibilitychange", tell, { signal: ending.signal });
  return () => {
    observer.disconnect();
    ending.abort();
  };
}
