/** How far the observer's eyes are from the screen: told, or measured by the blind spot. */

import { everyFrame } from "../canvas/frameClock";
import { timeOf } from "../canvas/showingLog";
import { make } from "../page/elements";
import type { Pages } from "./pages";

/** Where the blind spot begins, from the line of sight (Li, Joo, Yeatman and Reinecke, 2020). */
const BLIND_SPOT_DEG = 13.5;
const N_SETTINGS = 5;
const DOT_MM = 7;
const SPEED_MM_S = 20;
/** Room that is needed: for a distance of 60 cm, and the dot. */
const NEEDED_MM = 600 * Math.tan((BLIND_SPOT_DEG * Math.PI) / 180) + 4 * DOT_MM;
const RANGE_CM = { min: 10, max: 500 };

export interface ViewingDistance {
  readonly viewing_distance_mm: number;
  readonly distance_method: "told" | "blind_spot" | "assumed";
  /** Standard deviation over settings. */
  readonly distance_sd_mm: number | null;
  /** The distance by each setting. */
  readonly distance_settings_mm: readonly number[];
}

export const assumedDistance = (viewing_distance_mm: number): ViewingDistance => ({
  viewing_distance_mm,
  distance_method: "assumed",
  distance_sd_mm: null,
  distance_settings_mm: [],
});

/** Ask for the distance; where the screen is wide enough it can be measured. */
export async function askDistance(pages: Pages, pxPerCm: number, assumedMm: number): Promise<ViewingDistance> {
  const centimetres = make("input", {
    type: "number",
    id: "distance",
    inputmode: "decimal",
    ...RANGE_CM,
    step: "any",
  });
  const label = make("label", { for: "distance" }, pages.text("distance_label"));
  const wrong = make("p", { role: "alert", class: "wrong" });
  const canMeasure = (10 * window.innerWidth) / pxPerCm >= NEEDED_MM;
  centimetres.onkeydown = (event) => {
    if (event.key === "Enter") centimetres.closest("main")?.querySelector<HTMLButtonElement>(".first")?.click();
  };
  for (;;) {
    const answer = await pages.ask(
      [pages.title(), pages.paragraph("distance"), make("p", {}, label, centimetres), wrong],
      [
        ["told", "continue"],
        ...(canMeasure ? ([["measure", "distance_measure"]] as const) : []),
        ["unknown", "distance_unknown"],
      ],
    );
    if (answer === "unknown") return assumedDistance(assumedMm);
    if (answer === "measure") {
      const settings = await blindSpot(pages, pxPerCm);
      if (settings) return ofSettings(settings);
    } else {
      const told = Number(centimetres.value);
      if (told >= RANGE_CM.min && told <= RANGE_CM.max) {
        return { ...assumedDistance(10 * told), distance_method: "told" };
      }
      wrong.textContent = pages.text("distance_wrong", RANGE_CM);
      centimetres.setAttribute("aria-invalid", "true");
    }
  }
}

/** The median of the distances by several settings, and their spread. */
export function ofSettings(settings: readonly number[]): ViewingDistance {
  const sorted = settings.toSorted((a, b) => a - b);
  const mean = sorted.reduce((sum, each) => sum + each, 0) / sorted.length;
  const variance = sorted.reduce((sum, each) => sum + (each - mean) ** 2, 0) / (sorted.length - 1);
  return {
    viewing_distance_mm: sorted[Math.floor(sorted.length / 2)]!,
    distance_method: "blind_spot",
    distance_sd_mm: Math.sqrt(variance),
    distance_settings_mm: settings,
  };
}

/**
 * The left eye looks at a square; a dot moves away from it to the left, and a key or a button is pressed when it is
 * gone. Returns a distance for each setting, or null where the observer gives up.
 */
async function blindSpot(pages: Pages, pxPerCm: number): Promise<readonly number[] | null> {
  const pxPerMm = pxPerCm / 10;
  const begin = await pages.ask([pages.title(), pages.paragraphs("blind_spot")], [["begin", "begin"], ["back", "back"]]);
  if (begin === "back") return null;
  const settings: number[] = [];
  while (settings.length < N_SETTINGS) {
    const eccentricity = await oneSetting(pages, pxPerMm, settings.length);
    if (eccentricity === null) return null;
    settings.push(eccentricity / pxPerMm / Math.tan((BLIND_SPOT_DEG * Math.PI) / 180));
  }
  return settings;
}

/** Pixels from the square to where the dot was gone. */
function oneSetting(pages: Pages, pxPerMm: number, number: number): Promise<number | null> {
  const size = DOT_MM * pxPerMm;
  const square = make("div", { class: "fixation", style: `inline-size: ${size}px; block-size: ${size}px` });
  const dot = make("div", { class: "blind-dot", style: `inline-size: ${size}px; block-size: ${size}px` });
  const strip = make("div", { class: "blind-spot", "aria-hidden": "true" }, square, dot);
  const count = pages.paragraph("blind_spot_count", { number: number + 1, total: N_SETTINGS });
  return new Promise((resolve) => {
    const ending = new AbortController();
    const end = (result: number | null): void => {
      ending.abort();
      stop();
      resolve(result);
    };
    let at = { ms: 0, px: 0 };
    const gone = (event: Event): void => {
      if (at.px > 0) end(at.px + ((timeOf(event) - at.ms) / 1000) * SPEED_MM_S * pxPerMm);
    };
    const asked = pages.ask([strip, count], [["gone", "blind_spot_gone"], ["back", "back"]]);
    strip.parentElement?.classList.add("wide");
    const buttons = strip.parentElement!.querySelectorAll("button");
    buttons[0]!.addEventListener("click", gone, { signal: ending.signal });
    void asked.then((answer) => answer === "back" && end(null));
    document.addEventListener(
      "keydown",
      (event) => {
        if (event.key !== " " || event.repeat) return;
        event.preventDefault();
        gone(event);
      },
      { signal: ending.signal },
    );
    const width = strip.clientWidth - size;
    const stop = everyFrame((elapsedMs, firstMs) => {
      const px = (2 * size + (elapsedMs / 1000) * SPEED_MM_S * pxPerMm) % width;
      at = { ms: firstMs + elapsedMs, px };
      dot.style.transform = `translateX(${-px}px)`;
      return true;
    });
  });
}
