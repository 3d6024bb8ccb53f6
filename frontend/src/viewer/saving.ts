/** The present picture as a file: a stimulus, a picture, a film, a page of its own. */

import type { MannequinPainter } from "../canvas/mannequinLoader";
import { contextOf, setResolution } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import type { Stimulus } from "../core/stimulus";
import type { Scene } from "../model/figures";
import { animationOf, phaseOffset, type ViewerAnimation } from "./animation";
import type { Size } from "./arrangement";
import { encodeFilm, type FilmSpec } from "./filmEncoder";
import { arrangementFor, DURATION_S, MAX_FIGURES, stimulusOf } from "./viewedStimulus";

export interface Snapshot extends Scene {
  /** Phase of the first walker, for pictures. */
  readonly phase?: number;
  readonly size?: Size;
  readonly mannequin?: MannequinPainter | null;
}

export interface SavedFile {
  readonly name: string;
  readonly blob: Blob;
  /** A message about the file, if there is one. */
  readonly note?: string;
}

const SIZE_OF_ONE: Size = { width_px: 720, height_px: 720 };
const SIZE_OF_SEVERAL: Size = { width_px: 1280, height_px: 720 };
const RATE_HZ = 60;
/** Resolution of a picture relative to the viewer. */
const PIXEL_RATIO = 2;
const STIMULUS_SCRIPT = '<script id="stimulus" type="application/json">null</script>';
const SCRIPT_POLICY = "script-src 'unsafe-inline'";

const sizeOf = ({ size, figures }: Snapshot): Size => size ?? (figures.length === 1 ? SIZE_OF_ONE : SIZE_OF_SEVERAL);

/** The stimulus, checked against its schema: files that are written can be read. */
const checkedStimulus = (snapshot: Snapshot): Stimulus =>
  readStimulus(stimulusOf(snapshot, sizeOf(snapshot)));

/** The stimulus file, which Python's `Stimulus.load` reads. */
export function stimulusFile(snapshot: Snapshot): SavedFile {
  const blob = new Blob([`${jsonOf(checkedStimulus(snapshot))}\n`], { type: "application/json" });
  const file = { name: `${fileName(snapshot)}.json`, blob };
  const left = snapshot.figures.length - MAX_FIGURES;
  if (left <= 0) return file;
  return { ...file, note: `A stimulus holds ${MAX_FIGURES} walkers at most; the last ${left} are not in it.` };
}

/** A page of its own that plays the stimulus again and again, without other files. */
export function pageFile(snapshot: Snapshot): SavedFile {
  const player = textInPage("player");
  if (!player?.includes(STIMULUS_SCRIPT)) throw new Error("This page does not hold the player; save the stimulus file instead.");
  const stimulus = checkedStimulus(snapshot);
  const content = STIMULUS_SCRIPT.replace("null", () => jsonOf(stimulus).replaceAll("<", "\\u003c"));
  const page = player.replace(STIMULUS_SCRIPT, () => content + mannequinScript(stimulus));
  const solid = stimulus.display.style === "mannequin";
  const whole = solid ? page.replace(SCRIPT_POLICY, `${SCRIPT_POLICY} blob:`) : page;
  return { name: `${fileName(snapshot)}.html`, blob: new Blob([whole], { type: "text/html" }) };
}

/** The module that draws the mannequin, if the stimulus needs it. */
function mannequinScript({ display }: Stimulus): string {
  if (display.style !== "mannequin") return "";
  const module = document.querySelector("script#mannequin")?.textContent ?? "";
  if (module.trim().length < 10) throw new Error("This page does not hold the mannequin; choose points or sticks.");
  return `<script id="mannequin" type="text/plain">${module}</script>`;
}

function textInPage(id: string): string | null {
  const content = document.querySelector(`script#${id}`)?.textContent?.trim() ?? "";
  const text: unknown = content === "" ? null : JSON.parse(content);
  return typeof text === "string" ? text : null;
}

/** The picture of this moment, at twice the resolution of the viewer. */
export async function pictureFile(snapshot: Snapshot): Promise<SavedFile> {
  const { width_px, height_px } = sizeOf(snapshot);
  const canvas = document.createElement("canvas");
  setResolution(canvas, width_px, height_px, PIXEL_RATIO);
  animationFor(snapshot).draw(contextOf(canvas, { alpha: false }), 0, PIXEL_RATIO);
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!blob) throw new Error("This browser makes no picture of this size.");
  return { name: `${fileName(snapshot)}.png`, blob };
}

/** A film; a film of one walker lasts whole strides, so that it can be repeated. */
export async function filmFile(
  snapshot: Snapshot,
  options: Pick<FilmSpec, "progress" | "signal"> = {},
): Promise<SavedFile> {
  const { width_px, height_px } = sizeOf(snapshot);
  const even = (px: number): number => 2 * Math.max(Math.round(px / 2), 1);
  const [width, height] = [even(width_px), even(height_px)];
  const animation = animationFor({ ...snapshot, size: { width_px: width, height_px: height } });
  const frames = Math.round(durationOf(snapshot) * RATE_HZ);
  const draw: FilmSpec["draw"] = (context, frame) => animation.draw(context, frame / RATE_HZ, 1);
  const { blob, suffix } = await encodeFilm({ width, height, frames, rateHz: RATE_HZ, draw, ...options });
  return { name: `${fileName(snapshot)}.${suffix}`, blob };
}

/** Whole strides, if all walkers have one frequency. */
function durationOf({ figures, state }: Snapshot): number {
  const rates = new Set(figures.map(({ walker }) => state.tempo * walker.frequency_hz));
  if (rates.size > 1) return DURATION_S;
  const [rate = 1] = rates;
  return Math.max(Math.round(DURATION_S * rate), 1) / rate;
}

/** The animation from its beginning, as in the viewer. */
function animationFor(snapshot: Snapshot): ViewerAnimation {
  const { figures, state, phase = 0, mannequin = null } = snapshot;
  const size = sizeOf(snapshot);
  const phases = figures.map((_, i) => phase + phaseOffset(state, i));
  const arrangement = arrangementFor(snapshot, size);
  return animationOf({ ...snapshot, size, arrangement, phases, time: 0, turned_deg: 0, mannequin });
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

/** A descriptive name that is valid on every disk: `average-walker_sex+3`. */
function fileName({ figures, state }: Snapshot): string {
  const who = { one: figures[0]!.name, four: "four", side: "side-by-side", crowd: "crowd" }[state.scene];
  const traits = Object.entries(state.traits).flatMap(([name, steps]) =>
    steps === 0 ? [] : [`${name}${steps > 0 ? "+" : ""}${Math.round(steps * 100) / 100}`],
  );
  const whole = [who, ...traits, ...Object.keys(state.transforms)].join("_");
  return whole.replace(/[^\p{L}\p{N}+._-]+/gu, "-").slice(0, 80).replace(/^[-.]+/, "") || "walker";
}

export function download({ name, blob }: SavedFile): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
