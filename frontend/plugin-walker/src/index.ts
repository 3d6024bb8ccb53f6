/** A jsPsych trial that shows a stimulus file and waits for a key or a button. */

import type { JsPsych, JsPsychPlugin, TrialType } from "jspsych";
import { everyFrame } from "../../src/canvas/frameClock";
import { mannequinInPage, type MannequinPainter } from "../../src/canvas/mannequinLoader";
import { painterOn, type Painter } from "../../src/canvas/painter";
import { deviceOf, isRefreshKnown, notShown, refreshMeasured, rounded, ShowingLog, timeOf, type Showing } from "../../src/canvas/showingLog";
import { readStimulus } from "../../src/core/readStimulus";
import { make } from "../../src/page/elements";
import { info } from "./info";

type Info = typeof info;
type Trial = TrialType<Info>;
type Simulation = Parameters<NonNullable<JsPsychPlugin<Info>["simulate"]>>;

export interface WalkerData extends Showing {
  readonly response: string | number | null;
  readonly response_by: "key" | "button" | null;
  readonly rt: number | null;
  /** What it was given with: "keyboard", "mouse", "touch" or "pen". */
  readonly response_device: string | null;
}

class WalkerPlugin implements JsPsychPlugin<Info> {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: Trial, load: () => void = () => {}): void | Promise<never> {
    let waiting: Promise<never> | undefined;
    waiting = this.begin(display, trial, () => {
      if (waiting) load(); // for a trial that begins at once, jsPsych reports the loading itself
    });
    return waiting;
  }

  /** Show the stimulus, a mannequin once its module is loaded; the returned promise can only fail. */
  private begin(display: HTMLElement, trial: Trial, begun: () => void): Promise<never> | undefined {
    const stimulus = readStimulus(trial.stimulus);
    const { canvas, buttons } = build(display, trial);
    const start = (mannequin?: MannequinPainter): void => {
      const painter = painterOn(canvas, stimulus, trial.scale, mannequin);
      const fileMs = 1000 * stimulus.timing.duration_s;
      this.show(display, trial, painter, trial.stimulus_duration ?? fileMs, buttons);
      begun();
    };
    const solid = stimulus.display.style === "mannequin";
    if (!solid && isRefreshKnown()) {
      start();
      return undefined;
    }
    const ready = Promise.all([solid ? mannequinPainter() : undefined, refreshMeasured]);
    return new Promise((_, fail) => ready.then(([mannequin]) => start(mannequin)).catch(fail));
  }

  private show(
    display: HTMLElement,
    trial: Trial,
    painter: Painter,
    durationMs: number,
    buttons: readonly HTMLButtonElement[],
  ): void {
    const log = new ShowingLog();
    const { refreshMs } = log;
    const half = refreshMs / 2;
    const planned = Math.max(Math.round(durationMs / refreshMs), 1);
    const shownMs = planned * refreshMs; // a duration is a whole number of frames
    let isCleared = false;
    let answer: (Answer & { readonly rt: number }) | undefined;
    let stopListening = (): void => {};
    painter.paint(0); // the first drawing is the slowest, so it is done before the first frame
    painter.clear();

    const end = (): void => {
      stop();
      stopListening();
      display.replaceChildren();
      this.jsPsych.finishTrial({
        response: answer?.response ?? null,
        response_by: answer?.by ?? null,
        rt: answer?.rt ?? null,
        response_device: answer?.device ?? null,
        ...log.end(trial.repeat ? null : planned),
      } satisfies WalkerData);
    };
    const onAnswer = (firstMs: number) => (given: Answer) => {
      if (answer) return;
      answer = { ...given, rt: rounded(given.timeMs - firstMs) };
      if (trial.response_ends_trial) end();
    };
    const stop = everyFrame((elapsedMs, firstMs) => {
      if (trial.trial_duration !== null && elapsedMs > trial.trial_duration! - half) {
        log.cleared(elapsedMs);
        end();
        return false;
      }
      if (trial.repeat || elapsedMs < shownMs - half) {
        const moment = ((elapsedMs + half) % shownMs) - half;
        painter.paint(Math.max(moment, 0) / 1000);
        log.frame(elapsedMs, firstMs);
      } else if (!isCleared) {
        isCleared = true;
        painter.clear();
        log.cleared(elapsedMs);
      }
      if (elapsedMs === 0) stopListening = listen(this.jsPsych, trial.choices!, buttons, onAnswer(firstMs));
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

  private simulated(trial: Trial, options: Simulation[2]): WalkerData {
    const { pluginAPI, randomization } = this.jsPsych;
    const byKey = trial.choices !== "NO_KEYS";
    const initial = {
      response: byKey
        ? pluginAPI.getValidKey(trial.choices as string[] | "ALL_KEYS")
        : randomization.randomInt(0, Math.max(trial.buttons!.length - 1, 0)),
      response_by: byKey ? "key" : "button",
      response_device: byKey ? "keyboard" : "mouse",
      rt: randomization.sampleExGaussian(500, 50, 1 / 150, true),
      ...notShown(),
    };
    return pluginAPI.mergeSimulationData(initial, options) as WalkerData;
  }
}

/**
 * The mannequin painter, from the page if that holds it, as one opened from the disk must; or from the file
 * beside this one, fetched for the first mannequin.
 */
async function mannequinPainter(): Promise<MannequinPainter> {
  if (document.querySelector("script#mannequin")) return mannequinInPage();
  return (await import("../../src/mannequin/mannequin")).mannequinPainter();
}

/** The canvas, the prompt and the buttons, which are disabled until the first frame. */
function build(
  display: HTMLElement,
  trial: Trial,
): { canvas: HTMLCanvasElement; buttons: HTMLButtonElement[] } {
  const canvas = make("canvas", { class: "jspsych-walker-canvas", style: "display: block; margin: auto" });
  const buttons = trial.buttons!.map((label) =>
    make("button", { type: "button", class: "jspsych-btn", disabled: true }, label),
  );
  display.replaceChildren(canvas, make("div", { class: "jspsych-walker-buttons" }, ...buttons));
  if (trial.prompt !== null) {
    const prompt = make("div");
    prompt.innerHTML = trial.prompt!; // markup by the experimenter, as in every jsPsych plugin
    display.append(prompt);
  }
  return { canvas, buttons };
}

export default WalkerPlugin;

interface Answer {
  readonly response: string | number;
  readonly by: "key" | "button";
  readonly device: string;
  /** On the clock of `performance.now()`. */
  readonly timeMs: number;
}

type Keys = readonly string[] | "ALL_KEYS" | "NO_KEYS";

/** Report each answer until the returned function is called. */
function listen(
  jsPsych: JsPsych,
  keys: Keys,
  buttons: readonly HTMLButtonElement[],
  onAnswer: (answer: Answer) => void,
): () => void {
  let pressedMs = 0;
  // jsPsych reports which keys count, but not the time of the event, so it is noted before.
  const note = (event: KeyboardEvent): void => {
    pressedMs = timeOf(event);
  };
  document.addEventListener("keydown", note, { capture: true });
  const listener =
    keys === "NO_KEYS"
      ? undefined
      : jsPsych.pluginAPI.getKeyboardResponse({
          valid_responses: keys === "ALL_KEYS" ? keys : [...keys],
          persist: true,
          allow_held_key: false,
          callback_function: ({ key }: { key: string }) => onAnswer({ response: key, by: "key", device: "keyboard", timeMs: pressedMs }),
        });
  buttons.forEach((button, number) => {
    button.disabled = false;
    button.onclick = (event) =>
      onAnswer({ response: number, by: "button", device: deviceOf(event), timeMs: timeOf(event) });
  });
  return () => {
    document.removeEventListener("keydown", note, { capture: true });
    if (listener) jsPsych.pluginAPI.cancelKeyboardResponse(listener);
    for (const button of buttons) button.disabled = true;
  };
}
