/** How large a pixel is, by a bank card held to the screen, and how far away the observer sits. */

import { make } from "../page/elements";
import type { Pages } from "./pages";

/** Of every bank card (ISO/IEC 7810, ID-1). */
const CARD_MM = { width: 85.6, height: 53.98 };
const FIRST_PX_PER_MM = 3.8;

export interface ScreenSize {
  readonly px_per_cm: number;
  readonly viewing_distance_mm: number;
  /** "card" and "told", or "assumed" where nothing was measured. */
  readonly size_method: "card" | "assumed";
  readonly distance_method: "told" | "assumed";
}

/** Ask for the width of a card, by a slider that keys, mouse and touch move, and for the distance. */
export async function measureScreen(pages: Pages, assumed: { px_per_cm: number; viewing_distance_mm: number }): Promise<ScreenSize> {
  const card = make("div", { class: "card", "aria-hidden": "true" });
  const slider = make("input", {
    type: "range",
    id: "card-width",
    min: 100,
    max: Math.max(Math.min(window.innerWidth - 32, 900), 200),
    step: 0.5,
    value: CARD_MM.width * FIRST_PX_PER_MM,
  });
  const draw = (): void => {
    card.style.width = `${slider.value}px`;
    card.style.height = `${(Number(slider.value) * CARD_MM.height) / CARD_MM.width}px`;
  };
  slider.addEventListener("input", draw);
  draw();
  const label = make("label", { for: "card-width" }, pages.text("card_label"));
  const measured = await pages.ask(
    [pages.title(), pages.paragraph("card"), label, slider, card],
    [["measured", "card_done"], ["none", "card_none"]],
  );
  const centimetres = make("input", { type: "number", id: "distance", min: 10, max: 500, step: 1, value: assumed.viewing_distance_mm / 10 });
  const distanceLabel = make("label", { for: "distance" }, pages.text("distance_label"));
  await pages.ask([pages.title(), pages.paragraph("distance"), distanceLabel, centimetres], [["continue", "continue"]]);
  const distance = Number(centimetres.value);
  const told = distance >= 10 && distance <= 500;
  return {
    px_per_cm: measured === "measured" ? (10 * Number(slider.value)) / CARD_MM.width : assumed.px_per_cm,
    viewing_distance_mm: told ? 10 * distance : assumed.viewing_distance_mm,
    size_method: measured === "measured" ? "card" : "assumed",
    distance_method: told ? "told" : "assumed",
  };
}

/** Factor of stimuli made for an assumed screen that keeps their visual angle on this one. */
export const scaleOf = (size: ScreenSize, assumed: { px_per_cm: number; viewing_distance_mm: number }): number =>
  (size.px_per_cm * size.viewing_distance_mm) / (assumed.px_per_cm * assumed.viewing_distance_mm);

/** What a design assumes where nothing is measured. */
export const assumedOf = ({ px_per_cm, viewing_distance_mm }: { px_per_cm: number; viewing_distance_mm: number }): ScreenSize => ({
  px_per_cm,
  viewing_distance_mm,
  size_method: "assumed",
  distance_method: "assumed",
});
