/** Dragging, throwing and tapping an element with mouse, pen or finger. */

export interface Gestures {
  begun(): void;
  /** By a number of pixels to the right and down since the last call. */
  dragged(right: number, down: number): void;
  /** Released while moving, in pixels a second. */
  thrown(rightPerS: number, downPerS: number): void;
  /** Released without moving, at a place in pixels from the left and upper edge. */
  tapped(x: number, y: number): void;
}

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
  element.addEventListener("pointerdown", down, { signal });
  element.addEventListener("pointermove", move, { signal });
  element.addEventListener("pointerup", up, { signal });
  element.addEventListener("pointercancel", cancel, { signal });
}
