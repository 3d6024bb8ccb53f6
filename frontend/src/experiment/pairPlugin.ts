/** A jsPsych trial that shows four walkers in a square, of which two are chosen. */

import { ParameterType, type JsPsych, type TrialType } from "jspsych";

import { everyFrame } from "../canvas/frameClock";
import type { MannequinPainter } from "../canvas/mannequinLoader";
import { painterOn } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import { make } from "../page/elements";

const info = {
  name: "walker-pair",
  version: "1.0.0",
  parameters: {
    /** The parsed contents of four stimulus files: above left and right, below left and right. */
    stimuli: { type: ParameterType.COMPLEX, default: undefined },
    /** Labels of the figures. */
    labels: { type: ParameterType.STRING, array: true, default: undefined },
    /** Milliseconds after which the trial ends without an answer. */
    trial_duration: { type: ParameterType.INT, default: 10_000 },
    /** Draws mannequins; null where there are none. */
    mannequin: { type: ParameterType.COMPLEX, default: null },
    scale: { type: ParameterType.FLOAT, default: 1 },
  },
  data: {},
} as const;

export interface PairData {
  /** Places of the two, from 0; null for none. */
  readonly response: readonly [number, number] | null;
  readonly response_by: "key" | "button" | null;
  readonly rt: number | null;
  /** On the clock of `performance.now()`. */
  readonly first_frame: number | null;
  readonly frame_times: readonly number[];
  readonly frame_interval: number | null;
  readonly frames_dropped: number;
}

const rounded = (milliseconds: number): number => Math.round(milliseconds * 1000) / 1000;

/** The median interval of frames, and how many frames of the screen had no new picture. */
function intervalsOf(times: readonly number[]): Pick<PairData, "frame_interval" | "frames_dropped"> {
  const intervals = times.slice(1).map((time, i) => time - times[i]!);
  const median = intervals.toSorted((a, b) => a - b)[Math.floor(intervals.length / 2)];
  if (!median) return { frame_interval: null, frames_dropped: 0 };
  const dropped = intervals.reduce((sum, each) => sum + Math.max(Math.round(each / median) - 1, 0), 0);
  return { frame_interval: rounded(median), frames_dropped: dropped };
}

class PairPlugin {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: TrialType<typeof info>): void {
    const stimuli = (trial.stimuli as readonly unknown[]).map(readStimulus);
    const mannequin = (trial.mannequin as MannequinPainter | null) ?? undefined;
    const canvases = stimuli.map(() => make("canvas", { "aria-hidden": "true" }));
    const painters = stimuli.map((stimulus, i) => painterOn(canvases[i]!, stimulus, trial.scale!, mannequin));
    const figures = canvases.map((canvas, i) =>
      make("button", { type: "button", class: "figure", "aria-pressed": "false", "aria-label": trial.labels![i]! }, canvas),
    );
    display.replaceChildren(make("div", { class: "square" }, ...figures));

    const times: number[] = [];
    const chosen: number[] = [];
    let firstMs = Number.NaN;
    const end = (by: PairData["response_by"], timeMs: number | null): void => {
      stop();
      document.removeEventListener("keydown", onKey);
      display.replaceChildren();
      this.jsPsych.finishTrial({
        response: timeMs === null ? null : [Math.min(...chosen), Math.max(...chosen)],
        response_by: by,
        rt: timeMs === null ? null : rounded(timeMs - firstMs),
        frame_times: times.map(rounded),
        first_frame: Number.isNaN(firstMs) ? null : rounded(firstMs),
        ...intervalsOf(times),
      } satisfies PairData);
    };
    const choose = (place: number, by: "key" | "button", timeMs: number): void => {
      if (Number.isNaN(firstMs)) return;
      const at = chosen.indexOf(place);
      if (at >= 0) chosen.splice(at, 1);
      else chosen.push(place);
      figures.forEach((figure, i) => figure.setAttribute("aria-pressed", String(chosen.includes(i))));
      if (chosen.length === 2) end(by, timeMs);
    };
    const onKey = (event: KeyboardEvent): void => {
      const place = ["1", "2", "3", "4"].indexOf(event.key);
      if (place >= 0 && !event.repeat) choose(place, "key", event.timeStamp);
    };
    document.addEventListener("keydown", onKey);
    figures.forEach((figure, i) => (figure.onclick = (event) => choose(i, "button", event.timeStamp)));
    const stop = everyFrame((elapsedMs, first) => {
      firstMs = first;
      if (elapsedMs >= trial.trial_duration!) {
        end(null, null);
        return false;
      }
      stimuli.forEach((stimulus, i) => painters[i]!.paint((elapsedMs / 1000) % stimulus.timing.duration_s));
      times.push(elapsedMs);
      return true;
    });
  }
}

export default PairPlugin;
