/** A pointer that is dragged over an element, or taps it; mouse, pen and finger alike. */

export interface Gestures {
  /** By so many pixels to the right and down since the last time. */
  dragged(right: number, down: number): void;
  /** Let go while moving, at so many pixels a second. */
  thrown(rightPerS: number, downPerS: number): void;
  /** Without moving, at a place in pixels from the left and upper edge. */
  tapped(x: number, y: number): void;
  begun(): void;
}

/** A finger trembles. */
const TAP_PX = 6;
/** Only what was moved in so short a time before letting go counts as a throw. */
const THROW_MS = 80;

/** Tell of gestures until the returned function is called. */
export function watchGestures(element: HTMLElement, gestures: Gestures): () => void {
  const ending = new AbortController();
  const how = { signal: ending.signal };
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
    const lasted = first ? (event.timeStamp - first.time) / 1000 : 0;
    if (first && lasted > 0) gestures.thrown((x - first.x) / lasted, (y - first.y) / lasted);
  };
  const lost = (event: PointerEvent): void => {
    if (event.pointerId === held?.id) held = null;
  };
  element.addEventListener("pointerdown", down, how);
  element.addEventListener("pointermove", move, how);
  element.addEventListener("pointerup", up, how);
  element.addEventListener("pointercancel", lost, how);
  return () => ending.abort();
}
