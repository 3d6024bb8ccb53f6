/** What is on the stage as a file: a stimulus, a picture, a film, a page of its own. */

import type { MannequinPainter } from "../canvas/mannequinLoader";
import { readStimulus } from "../core/readStimulus";
import type { Stimulus } from "../core/stimulus";
import type { Cast } from "../model/figures";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import { actOf, lead, type Act } from "./animation";
import { encodeFilm, type FilmWish } from "./filmEncoder";
import { DURATION_S, MOST_FIGURES, roomFor, stimulusOf } from "./viewedStimulus";
import { stagingOf, type Size } from "./arrangement";

/** What is to be kept. */
export interface Kept {
  readonly model: Model;
  readonly cast: readonly Cast[];
  readonly state: State;
  /** Where in its stride the first walker is, for pictures. */
  readonly cycle?: number;
  /** Of the picture; left out, a usual one. */
  readonly size?: Size;
  readonly mannequin?: MannequinPainter | null;
}

export interface SavedFile {
  readonly name: string;
  readonly blob: Blob;
  /** What a visitor should know of it; mostly nothing. */
  readonly told?: string;
}

const ONE: Size = { width_px: 720, height_px: 720 };
const SEVERAL: Size = { width_px: 1280, height_px: 720 };
const RATE_HZ = 60;
/** Pixels of a picture for one of the stage. */
const FINE = 2;
const HELD = '<script id="stimulus" type="application/json">null</script>';
const SCRIPTS = "script-src 'unsafe-inline'";

const sizeOf = ({ size, cast }: Kept): Size => size ?? (cast.length === 1 ? ONE : SEVERAL);

/** The stimulus, held against its schema: what is written can be read. */
export const keptStimulus = (kept: Kept): Stimulus =>
  readStimulus(stimulusOf(kept.model, kept.cast, kept.state, sizeOf(kept)));

/** The stimulus file, which `Stimulus.load` of Python takes. */
export function stimulusFile(kept: Kept): SavedFile {
  const blob = new Blob([`${jsonOf(keptStimulus(kept))}\n`], { type: "application/json" });
  const file = { name: `${nameFor(kept)}.json`, blob };
  const left = kept.cast.length - MOST_FIGURES;
  return left > 0 ? { ...file, told: `A stimulus holds ${MOST_FIGURES} walkers at most; the last ${left} are not in it.` } : file;
}

/** A page of its own that plays the stimulus, again and again, with nothing but itself. */
export function pageFile(kept: Kept): SavedFile {
  const player = heldText("player");
  if (!player?.includes(HELD)) throw new Error("This page does not hold the player; save the stimulus file instead.");
  const stimulus = keptStimulus(kept);
  const content = HELD.replace("null", () => jsonOf(stimulus).replaceAll("<", "\\u003c"));
  const page = player.replace(HELD, () => content + carved(stimulus));
  const whole = stimulus.display.style === "mannequin" ? page.replace(SCRIPTS, `${SCRIPTS} blob:`) : page;
  return { name: `${nameFor(kept)}.html`, blob: new Blob([whole], { type: "text/html" }) };
}

/** The module that draws the mannequin, where the stimulus asks for it. */
function carved({ display }: Stimulus): string {
  if (display.style !== "mannequin") return "";
  const module = document.querySelector("script#mannequin")?.textContent ?? "";
  if (module.trim().length < 10) throw new Error("This page does not hold the mannequin; choose points or sticks.");
  return `<script id="mannequin" type="text/plain">${module}</script>`;
}

/** A text that the page holds as JSON. */
function heldText(id: string): string | null {
  const content = document.querySelector(`script#${id}`)?.textContent?.trim() ?? "";
  const text: unknown = content === "" ? null : JSON.parse(content);
  return typeof text === "string" ? text : null;
}

/** The picture of this moment, twice as fine as the stage. */
export async function pictureFile(kept: Kept): Promise<SavedFile> {
  const { width_px, height_px } = sizeOf(kept);
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: Math.round(FINE * width_px), height: Math.round(FINE * height_px) });
  actFor(kept).draw(contextOf(canvas), 0, FINE);
  const blob = await new Promise<Blob | null>((take) => canvas.toBlob(take, "image/png"));
  if (!blob) throw new Error("This browser makes no picture of this size.");
  return { name: `${nameFor(kept)}.png`, blob };
}

/** A film; of one walker it lasts whole strides, so that it can be played again and again. */
export async function filmFile(
  kept: Kept,
  how: Pick<FilmWish, "progress" | "signal"> = {},
): Promise<SavedFile> {
  const { width_px, height_px } = sizeOf(kept);
  const even = (px: number): number => 2 * Math.max(Math.round(px / 2), 1);
  const [width, height] = [even(width_px), even(height_px)];
  const act = actFor({ ...kept, size: { width_px: width, height_px: height } });
  const frames = Math.round(durationOf(kept) * RATE_HZ);
  const draw = (context: CanvasRenderingContext2D, frame: number): void => act.draw(context, frame / RATE_HZ, 1);
  const { blob, suffix } = await encodeFilm({ width, height, frames, rateHz: RATE_HZ, draw, ...how });
  return { name: `${nameFor(kept)}.${suffix}`, blob };
}

/** Whole strides of some seconds, where all go at one tempo. */
function durationOf({ cast, state }: Kept): number {
  const rates = new Set(cast.map(({ walker }) => state.tempo * walker.frequency_hz));
  if (rates.size > 1) return DURATION_S;
  const [rate = 1] = rates;
  return Math.max(Math.round(DURATION_S * rate), 1) / rate;
}

/** The scene from its beginning, as the stage would draw it. */
function actFor(kept: Kept): Act {
  const { model, cast, state, cycle = 0, mannequin = null } = kept;
  const size = sizeOf(kept);
  const staging = stagingOf(cast.length, roomFor(model, cast), size, state.elevation_deg);
  const cycles = cast.map((_, i) => cycle + lead(state, i));
  return actOf({ model, cast, state, size, staging, cycles, time: 0, turned_deg: 0, mannequin });
}

function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext("2d", { alpha: false });
  if (!context) throw new Error("This browser gives no canvas to draw on.");
  return context;
}

/** JSON with one figure and one transform a line, as Python writes it. */
function jsonOf(stimulus: Stimulus): string {
  const lines = (items: readonly unknown[]): string =>
    items.length === 0 ? "[]" : `[\n${items.map((item) => `  ${JSON.stringify(item)}`).join(",\n")}\n ]`;
  const parts = Object.entries(stimulus).map(([name, value]) => {
    const several = name === "figures" || name === "transforms";
    return ` ${JSON.stringify(name)}: ${several ? lines(value as unknown[]) : JSON.stringify(value)}`;
  });
  return `{\n${parts.join(",\n")}\n}`;
}

/** A name that tells what it is, of letters that every disk takes: `average-walker_sex+3`. */
function nameFor({ cast, state }: Kept): string {
  const who = state.scene === "one" ? cast[0]!.name : { four: "four", side: "side-by-side", crowd: "crowd" }[state.scene];
  const traits = Object.entries(state.traits).flatMap(([name, steps]) =>
    steps === 0 ? [] : [`${name}${steps > 0 ? "+" : ""}${Math.round(steps * 100) / 100}`],
  );
  const whole = [who, ...traits, ...Object.keys(state.transforms)].join("_");
  return whole.replace(/[^\p{L}\p{N}+._-]+/gu, "-").slice(0, 80).replace(/^[-.]+/, "") || "walker";
}

/** Let the browser keep a file. */
export function download({ name, blob }: SavedFile): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
