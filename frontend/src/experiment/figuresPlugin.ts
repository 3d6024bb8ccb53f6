/** A jsPsych trial that shows several walkers at once: some of them are chosen, or a question about all is answered. */

import { ParameterType, type JsPsych, type TrialType } from "jspsych";

import { everyFrame } from "../canvas/frameClock";
import type { MannequinPainter } from "../canvas/mannequinLoader";
import { painterOn } from "../canvas/painter";
import { deviceOf, rounded, ShowingLog, timeOf, type Showing } from "../canvas/showingLog";
import { readStimulus } from "../core/readStimulus";
import { button, make } from "../page/elements";

const info = {
  name: "walker-figures",
  version: "1.0.0",
  parameters: {
    /** The parsed contents of stimulus files: above left and right, below left and right. */
    stimuli: { type: ParameterType.COMPLEX, default: undefined },
    /** Shares of a stride after which the walkers begin; none where all begin alike. */
    starts: { type: ParameterType.FLOAT, array: true, default: [] as number[] },
    /** How many figures are chosen; 0 where buttons answer. */
    choose: { type: ParameterType.INT, default: 0 },
    /** Keys of the figures, or of the buttons, one each. */
    keys: { type: ParameterType.STRING, array: true, default: undefined },
    /** Labels of the figures. */
    labels: { type: ParameterType.STRING, array: true, default: undefined },
    /** Labels of buttons below the figures. */
    buttons: { type: ParameterType.STRING, array: true, default: [] as string[] },
    /** Milliseconds after which the figures are gone; null while the trial lasts. */
    stimulus_duration: { type: ParameterType.INT, default: null },
    /** Milliseconds after which the trial ends without an answer. */
    trial_duration: { type: ParameterType.INT, default: 10_000 },
    /** Draws mannequins; null where there are none. */
    mannequin: { type: ParameterType.COMPLEX, default: null },
    scale: { type: ParameterType.FLOAT, default: 1 },
  },
  data: {},
} as const;

export interface FiguresData extends Showing {
  /** Places of chosen figures or of the button, from 0; null for none. */
  readonly response: number | readonly number[] | null;
  readonly response_by: "key" | "button" | null;
  readonly response_device: string | null;
  readonly rt: number | null;
}

class FiguresPlugin {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: TrialType<typeof info>): void {
    const stimuli = (trial.stimuli as readonly unknown[]).map(readStimulus);
    const mannequin = (trial.mannequin as MannequinPainter | null) ?? undefined;
    const canvases = stimuli.map(() => make("canvas", { "aria-hidden": "true" }));
    const painters = stimuli.map((stimulus, i) => painterOn(canvases[i]!, stimulus, trial.scale!, mannequin));
    const beginnings = stimuli.map(({ figures }, i) => (trial.starts![i] ?? 0) / (figures[0]?.walker?.frequency_hz ?? 1));
    const isChoice = trial.choose! > 0;
    const figures = canvases.map((canvas, i) => {
      if (!isChoice) return make("div", { class: "figure", role: "img", "aria-label": trial.labels![i]! }, canvas);
      const label = make("span", { class: "figure-key", "aria-hidden": "true" }, trial.keys![i]!);
      return make("button", { type: "button", class: "figure", "aria-pressed": "false", "aria-label": trial.labels![i]! }, canvas, label);
    });
    const buttons = trial.buttons!.map((label) => button(label, () => {}, { disabled: true }));
    display.replaceChildren(
      make("div", { class: `square of-${stimuli.length}` }, ...figures),
      make("div", { class: "jspsych-walker-buttons" }, ...buttons),
    );

    const stage = this.jsPsych.getDisplayContainerElement();
    const log = new ShowingLog();
    const half = log.refreshMs / 2;
    const shownMs = trial.stimulus_duration ?? trial.trial_duration!;
    const chosen: number[] = [];
    let firstMs = Number.NaN;
    let isShown = true;
    const ending = new AbortController();
    const end = (by: FiguresData["response_by"], device: string | null, timeMs: number | null): void => {
      stop();
      ending.abort();
      display.replaceChildren();
      const places = chosen.toSorted((a, b) => a - b);
      this.jsPsych.finishTrial({
        response: timeMs === null ? null : trial.choose! > 1 ? places : places[0]!,
        response_by: by,
        response_device: device,
        rt: timeMs === null ? null : rounded(timeMs - firstMs),
        ...log.end(Math.round(shownMs / log.refreshMs)),
      } satisfies FiguresData);
    };
    const choose = (place: number, by: "key" | "button", device: string, timeMs: number): void => {
      if (Number.isNaN(firstMs)) return;
      const at = chosen.indexOf(place);
      if (at >= 0) chosen.splice(at, 1);
      else chosen.push(place);
      if (isChoice) figures.forEach((figure, i) => figure.setAttribute("aria-pressed", String(chosen.includes(i))));
      if (chosen.length === Math.max(trial.choose!, 1)) end(by, device, timeMs);
    };
    const onKey = (event: KeyboardEvent): void => {
      const place = trial.keys!.indexOf(event.key.toLowerCase());
      if (place >= 0 && !event.repeat) choose(place, "key", "keyboard", timeOf(event));
    };
    stage.addEventListener("keydown", onKey, { signal: ending.signal });
    (isChoice ? (figures as HTMLButtonElement[]) : buttons).forEach((each, i) => {
      each.onclick = (event) => choose(i, "button", deviceOf(event), timeOf(event));
    });
    painters.forEach((painter) => painter.paint(0)); // the first drawing is the slowest
    painters.forEach((painter) => painter.clear());
    const stop = everyFrame((elapsedMs, first) => {
      firstMs = first;
      if (elapsedMs > trial.trial_duration! - half) {
        log.cleared(elapsedMs);
        end(null, null, null);
        return false;
      }
      if (elapsedMs < shownMs - half) {
        painters.forEach((painter, i) => painter.paint(elapsedMs / 1000 + beginnings[i]!));
        log.frame(elapsedMs, first);
      } else if (isShown) {
        isShown = false;
        painters.forEach((painter) => painter.clear());
        log.cleared(elapsedMs);
      }
      for (const each of buttons) each.disabled = false;
      return true;
    });
  }
}

export default FiguresPlugin;
