/** A jsPsych trial that shows a stimulus file and waits for a key or a button. */

import type { JsPsych, JsPsychPlugin, TrialType } from "jspsych";

import { everyFrame, frameTiming } from "../../src/canvas/frameClock";
import type { MannequinPainter } from "../../src/canvas/mannequinLoader";
import { painterOn, type Painter } from "../../src/canvas/painter";
import { readStimulus } from "../../src/core/readStimulus";
import { listen, type Answer } from "./answers";
import { info } from "./info";

type Info = typeof info;
type Trial = TrialType<Info>;
type Simulation = Parameters<NonNullable<JsPsychPlugin<Info>["simulate"]>>;

export interface WalkerData {
  readonly response: string | number | null;
  readonly response_by: "key" | "button" | null;
  readonly rt: number | null;
  readonly frame_times: readonly number[];
  readonly frame_interval: number | null;
  readonly frames_dropped: number;
}

/** Browsers know no less than microseconds. */
const rounded = (milliseconds: number): number => Math.round(milliseconds * 1000) / 1000;

class WalkerPlugin implements JsPsychPlugin<Info> {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: Trial, load: () => void = () => {}): void | Promise<never> {
    let waiting: Promise<never> | undefined;
    waiting = this.begin(display, trial, () => {
      if (waiting) load(); // of a trial that begins at once, jsPsych says itself that it is loaded
    });
    return waiting;
  }

  /** Show the stimulus, of a mannequin once its module is there; what is returned may only fail. */
  private begin(display: HTMLElement, trial: Trial, begun: () => void): Promise<never> | undefined {
    const stimulus = readStimulus(trial.stimulus);
    const { canvas, buttons } = build(display, trial);
    const start = (mannequin?: MannequinPainter): void => {
      const painter = painterOn(canvas, stimulus, trial.scale, mannequin);
      const usualMs = 1000 * stimulus.timing.duration_s;
      this.show(display, trial, painter, trial.stimulus_duration ?? usualMs, buttons);
      begun();
    };
    if (stimulus.display.style === "mannequin") {
      return new Promise((_, fail) => mannequinPainter().then(start).catch(fail));
    }
    start();
    return undefined;
  }

  private show(
    display: HTMLElement,
    trial: Trial,
    painter: Painter,
    durationMs: number,
    buttons: readonly HTMLButtonElement[],
  ): void {
    const times: number[] = [];
    let answer: (Answer & { readonly rt: number }) | undefined;
    let silence = (): void => {};
    painter.paint(0); // the first drawing takes longest, so it is done before it is seen
    painter.clear();

    const end = (): void => {
      stop();
      silence();
      const timing = frameTiming(times);
      display.replaceChildren();
      this.jsPsych.finishTrial({
        response: answer?.response ?? null,
        response_by: answer?.by ?? null,
        rt: answer?.rt ?? null,
        frame_times: times.map(rounded),
        frame_interval: timing.interval === null ? null : rounded(timing.interval),
        frames_dropped: timing.dropped,
      } satisfies WalkerData);
    };
    const answered = (firstMs: number) => (came: Answer) => {
      if (answer) return;
      answer = { ...came, rt: rounded(came.timeMs - firstMs) };
      if (trial.response_ends_trial) end();
    };
    const stop = everyFrame((elapsedMs, firstMs) => {
      if (trial.trial_duration !== null && elapsedMs >= trial.trial_duration!) {
        end();
        return false;
      }
      if (trial.repeat || elapsedMs < durationMs) {
        painter.paint((elapsedMs % durationMs) / 1000);
        times.push(elapsedMs);
      } else {
        painter.clear();
      }
      if (elapsedMs === 0) silence = listen(this.jsPsych, trial.choices!, buttons, answered(firstMs));
      return true;
    });
  }

  simulate(
    trial: Trial,
    mode: Simulation[1],
    options: Simulation[2],
    load: () => void = () => {},
  ): void | Promise<never> {
    const data = this.simulated(trial, options);
    if (mode === "data-only") {
      load();
      this.jsPsych.finishTrial(data);
      return undefined;
    }
    const display = this.jsPsych.getDisplayElement();
    return this.begin(display, trial, () => {
      load();
      if (data.rt === null) return;
      if (data.response_by === "key") {
        this.jsPsych.pluginAPI.pressKey(String(data.response), data.rt);
      } else {
        const button = display.querySelectorAll(".jspsych-walker-buttons button")[Number(data.response)];
        if (button) this.jsPsych.pluginAPI.clickTarget(button, data.rt);
      }
    });
  }

  /** What an observer might have done. */
  private simulated(trial: Trial, options: Simulation[2]): WalkerData {
    const { pluginAPI, randomization } = this.jsPsych;
    const byKey = trial.choices !== "NO_KEYS";
    const usual = {
      response: byKey
        ? pluginAPI.getValidKey(trial.choices as string[] | "ALL_KEYS")
        : randomization.randomInt(0, Math.max(trial.buttons!.length - 1, 0)),
      response_by: byKey ? "key" : "button",
      rt: randomization.sampleExGaussian(500, 50, 1 / 150, true),
      frame_times: [],
      frame_interval: null,
      frames_dropped: 0,
    };
    return pluginAPI.mergeSimulationData(usual, options) as WalkerData;
  }
}

/** What draws mannequins: a file of its own beside this one, fetched for the first of them. */
async function mannequinPainter(): Promise<MannequinPainter> {
  return (await import("../../src/mannequin/mannequin")).mannequinPainter();
}

/** The canvas, the prompt and the buttons, which wait for the first frame. */
function build(
  display: HTMLElement,
  trial: Trial,
): { canvas: HTMLCanvasElement; buttons: HTMLButtonElement[] } {
  const canvas = document.createElement("canvas");
  canvas.className = "jspsych-walker-canvas";
  canvas.style.display = "block";
  canvas.style.margin = "auto";
  const row = document.createElement("div");
  row.className = "jspsych-walker-buttons";
  const buttons = trial.buttons!.map((label) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "jspsych-btn";
    button.textContent = label;
    button.disabled = true;
    return button;
  });
  row.append(...buttons);
  display.replaceChildren(canvas, row);
  if (trial.prompt !== null) {
    const prompt = document.createElement("div");
    prompt.innerHTML = trial.prompt!; // markup by the experimenter, as in every jsPsych plugin
    display.append(prompt);
  }
  return { canvas, buttons };
}

export default WalkerPlugin;
