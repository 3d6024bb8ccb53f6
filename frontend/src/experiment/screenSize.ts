/** How large a pixel is, by a bank card held to the screen, and how large stimuli are drawn for that. */

import { button, make } from "../page/elements";
import type { Pages } from "./pages";
import { assumedDistance, askDistance, type ViewingDistance } from "./viewingDistance";

/** Of every bank card (ISO/IEC 7810, ID-1). */
const CARD_MM = { long: 85.6, short: 53.98 };
const FIRST_PX_PER_MM = 3.8;
const FIRST_PX_PER_MM_OF_PHONES = 6.2;
const STEP_PX = 0.5;

export interface ScreenSize extends ViewingDistance {
  readonly px_per_cm: number;
  readonly size_method: "card" | "assumed";
  /** What the frame was set with: "keyboard", "mouse", "touch" or "pen". */
  readonly size_device: string | null;
  /** Within which the frame can be set. */
  readonly px_per_cm_step: number | null;
}

interface Assumed {
  readonly px_per_cm: number;
  readonly viewing_distance_mm: number;
}

/** Ask for the size of a card, then for the distance. */
export async function measureScreen(pages: Pages, assumed: Assumed): Promise<ScreenSize> {
  const size = await askCard(pages, assumed);
  return { ...size, ...(await askDistance(pages, size.px_per_cm, assumed.viewing_distance_mm)) };
}

/** A frame is made as large as a card: by keys, by a slider, by its corner, or by buttons. */
async function askCard(pages: Pages, assumed: Assumed): Promise<Omit<ScreenSize, keyof ViewingDistance>> {
  const upright = window.innerWidth < 600; // the long side has room in the height alone
  const room = upright ? window.innerHeight : window.innerWidth - 48;
  const max = Math.max(Math.min(room, 1400), 200);
  const first = CARD_MM.long * (upright ? FIRST_PX_PER_MM_OF_PHONES : FIRST_PX_PER_MM);
  let device: string | null = null;
  const slider = make("input", { type: "range", id: "card-size", min: 100, max, step: STEP_PX, value: Math.min(first, max) });
  const grip = make("div", { class: "grip" });
  const card = make("div", { class: upright ? "card upright" : "card", "aria-hidden": "true" }, grip);
  const draw = (): void => {
    const long = Number(slider.value);
    const short = (long * CARD_MM.short) / CARD_MM.long;
    card.style.inlineSize = `${upright ? short : long}px`;
    card.style.blockSize = `${upright ? long : short}px`;
  };
  const set = (value: number, by: string): void => {
    slider.value = String(value);
    device = by;
    draw();
  };
  slider.addEventListener("keydown", () => void (device = "keyboard"));
  slider.addEventListener("pointerdown", (event) => void (device = event.pointerType));
  slider.addEventListener("input", draw);
  grip.addEventListener("pointerdown", (event) => {
    const from = { value: Number(slider.value), x: event.clientX, y: event.clientY };
    const way = document.documentElement.dir === "rtl" ? -1 : 1;
    grip.setPointerCapture(event.pointerId);
    event.preventDefault();
    grip.onpointermove = ({ clientX, clientY, pointerType }) =>
      set(from.value + (upright ? clientY - from.y : way * (clientX - from.x)), pointerType);
    grip.onpointerup = grip.onpointercancel = () => void (grip.onpointermove = null);
  });
  const step = (by: number, name: string, sign: string): HTMLElement =>
    button(sign, () => set(Number(slider.value) + by, "button"), { "aria-label": pages.text(name), class: "step" });
  draw();
  const label = make("label", { for: "card-size" }, pages.text("card_label"));
  const row = make("div", { class: "slider" }, step(-STEP_PX, "smaller", "−"), slider, step(STEP_PX, "larger", "+"));
  const asked = pages.ask(
    [pages.title(), pages.paragraph("card"), label, row, card],
    [["measured", "card_done"], ["none", "card_none"]],
  );
  if (upright) card.parentElement!.append(card); // the buttons stay in sight
  const answer = await asked;
  return answer === "measured"
    ? { px_per_cm: (10 * Number(slider.value)) / CARD_MM.long, size_method: "card", size_device: device, px_per_cm_step: (10 * STEP_PX) / CARD_MM.long }
    : { px_per_cm: assumed.px_per_cm, size_method: "assumed", size_device: null, px_per_cm_step: null };
}

/** Factor of stimuli made for an assumed screen that keeps their visual angle on this one. */
export const scaleOf = (size: ScreenSize, assumed: Assumed): number =>
  (size.px_per_cm * size.viewing_distance_mm) / (assumed.px_per_cm * assumed.viewing_distance_mm);

/** What a design assumes where nothing is measured. */
export const assumedOf = (assumed: Assumed): ScreenSize => ({
  px_per_cm: assumed.px_per_cm,
  size_method: "assumed",
  size_device: null,
  px_per_cm_step: null,
  ...assumedDistance(assumed.viewing_distance_mm),
});
