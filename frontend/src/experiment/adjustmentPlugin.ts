/** A jsPsych trial in which a slider changes a walker until it is as asked. */

import { ParameterType, type JsPsych, type TrialType } from "jspsych";

import { everyFrame } from "../canvas/frameClock";
import type { MannequinPainter } from "../canvas/mannequinLoader";
import { contextOf, drawingOf, painterOn, type Drawing } from "../canvas/painter";
import { deviceOf, rounded, ShowingLog, timeOf, type Showing } from "../canvas/showingLog";
import { readStimulus } from "../core/readStimulus";
import { button, make } from "../page/elements";

const info = {
  name: "walker-adjustment",
  version: "1.0.0",
  parameters: {
    /** The parsed contents of stimulus files, one a place of the slider. */
    stimuli: { type: ParameterType.COMPLEX, default: undefined },
    /** The place at which the slider begins, from 0. */
    begins: { type: ParameterType.INT, default: 0 },
    label: { type: ParameterType.STRING, default: undefined },
    button: { type: ParameterType.STRING, default: undefined },
    mannequin: { type: ParameterType.COMPLEX, default: null },
    scale: { type: ParameterType.FLOAT, default: 1 },
  },
  data: {},
} as const;

export interface AdjustmentData extends Showing {
  /** The place of the slider. */
  readonly response: number;
  readonly response_by: "key" | "button";
  readonly response_device: string;
  readonly rt: number;
  /** How often the slider came to another place. */
  readonly moves: number;
}

class AdjustmentPlugin {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: TrialType<typeof info>): void {
    const files = trial.stimuli as readonly unknown[];
    const mannequin = (trial.mannequin as MannequinPainter | null) ?? undefined;
    const canvas = make("canvas", { "aria-hidden": "true" });
    const first = readStimulus(files[trial.begins!]);
    painterOn(canvas, first, trial.scale!, mannequin);
    const context = contextOf(canvas, { alpha: false });
    const ratio = trial.scale! * (window.devicePixelRatio || 1);
    const drawings: (readonly [Drawing, number] | undefined)[] = [];
    const made = (place: number): readonly [Drawing, number] => {
      const stimulus = readStimulus(files[place]);
      return [drawingOf(stimulus, mannequin), stimulus.figures[0]?.walker?.frequency_hz ?? 1];
    };
    const drawingAt = (place: number): readonly [Drawing, number] => (drawings[place] ??= made(place));
    const id = "adjustment";
    const slider = make("input", { type: "range", id, min: 0, max: files.length - 1, step: 1, value: trial.begins!, disabled: true });
    const done = button(trial.button!, () => {}, { disabled: true });
    display.replaceChildren(
      canvas,
      make("div", { class: "adjustment" }, make("label", { for: id }, trial.label!), slider, done),
    );

    const log = new ShowingLog();
    let firstMs = 0;
    let moves = 0;
    let strides = 0;
    let lastMs = 0;
    slider.oninput = () => void (moves += 1);
    const end = (by: AdjustmentData["response_by"], device: string, timeMs: number): void => {
      stop();
      display.replaceChildren();
      this.jsPsych.finishTrial({
        response: Number(slider.value),
        response_by: by,
        response_device: device,
        rt: rounded(timeMs - firstMs),
        moves,
        ...log.end(null),
      } satisfies AdjustmentData);
    };
    done.onclick = (event) => end("button", deviceOf(event), timeOf(event));
    slider.onkeydown = (event) => {
      if (event.key === "Enter" && !event.repeat) end("key", "keyboard", timeOf(event));
    };
    const stop = everyFrame((elapsedMs, startMs) => {
      const [draw, frequency] = drawingAt(Number(slider.value));
      strides += ((elapsedMs - lastMs) / 1000) * frequency; // the walk goes on where it is, whatever its speed
      lastMs = elapsedMs;
      draw(context, strides / frequency, ratio);
      log.frame(elapsedMs, startMs);
      if (slider.disabled) {
        firstMs = startMs;
        slider.disabled = done.disabled = false;
        slider.focus();
      }
      return true;
    });
  }
}

export default AdjustmentPlugin;
