/** Events of the viewer's canvas: its size, whether it is visible, dragging, throwing and tapping. */

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

export interface Gestures {
  begun(): void;
  /** By a number of pixels to the right and down since the last call. */
  dragged(right: number, down: number): void;
  /** Released while moving, in pixels a second. */
  thrown(rightPerS: number, downPerS: number): void;
  /** Released without moving, at a place in pixels from the left and upper edge. */
  tapped(x: number, y: number): void;
  /** The wheel was turned, or two fingers moved apart on a touchpad: by this factor nearer. */
  zoomed(factor: number): void;
}

/** Pixels of the wheel that make everything e times as large; lines of 16 pixels. */
const WHEEL_PX = 600;
const LINE_PX = 16;
/** Movements of a tap are no longer than this. */
const TAP_PX = 6;
/** The speed of a throw is measured over this time before the release. */
const THROW_MS = 80;

/** Report gestures until the signal is aborted. */
export function watchGestures(element: HTMLElement, signal: AbortSignal, gestures: Gestures): void {
  let held: { id: number; x: number; y: number; far: number } | null = null;
  let trail: { time: number; x: number; y: number }[] = [];

  const down = (event: PointerEvent): void => {
    if (held || event.button !== 0) return;
    held = { id: event.pointerId, x: event.clientX, y: event.clientY, far: 0 };
    trail = [];
    element.setPointerCapture(event.pointerId);
    gestures.begun();
  };
  const move = (event: PointerEvent): void => {
    if (event.pointerId !== held?.id) return;
    const [right, below] = [event.clientX - held.x, event.clientY - held.y];
    held = { ...held, x: event.clientX, y: event.clientY, far: held.far + Math.hypot(right, below) };
    trail = [...trail, { time: event.timeStamp, x: held.x, y: held.y }].filter(
      ({ time }) => event.timeStamp - time < THROW_MS,
    );
    if (held.far > TAP_PX) gestures.dragged(right, below);
  };
  const up = (event: PointerEvent): void => {
    if (event.pointerId !== held?.id) return;
    const { far, x, y } = held;
    held = null;
    if (far <= TAP_PX) {
      const box = element.getBoundingClientRect();
      gestures.tapped(x - box.left, y - box.top);
      return;
    }
    const first = trail.find(({ time }) => event.timeStamp - time < THROW_MS);
    const seconds = first ? (event.timeStamp - first.time) / 1000 : 0;
    if (first && seconds > 0) gestures.thrown((x - first.x) / seconds, (y - first.y) / seconds);
  };
  const cancel = (event: PointerEvent): void => {
    if (event.pointerId === held?.id) held = null;
  };
  const wheel = (event: WheelEvent): void => {
    event.preventDefault();
    const px = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE_PX : 1);
    gestures.zoomed(Math.exp(-px / WHEEL_PX));
  };
  element.addEventListener("wheel", wheel, { signal, passive: false });
  element.addEventListener("pointerdown", down, { signal });
  element.addEventListener("pointermove", move, { signal });
  element.addEventListener("pointerup", up, { signal });
  element.addEventListener("pointercancel", cancel, { signal });
}
