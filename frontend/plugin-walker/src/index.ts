/** A jsPsych trial that shows a stimulus file and waits for a key or a button. */

import type { JsPsych, JsPsychPlugin, TrialType } from "jspsych";
import { everyFrame, frameTiming, RefreshClock } from "../../src/canvas/frameClock";
import { mannequinInPage, type MannequinPainter } from "../../src/canvas/mannequinLoader";
import { painterOn, type Painter } from "../../src/canvas/painter";
import { readStimulus } from "../../src/core/readStimulus";
import { make } from "../../src/page/elements";
import { info } from "./info";

type Info = typeof info;
type Trial = TrialType<Info>;
type Simulation = Parameters<NonNullable<JsPsychPlugin<Info>["simulate"]>>;

export interface WalkerData {
  readonly response: string | number | null;
  readonly response_by: "key" | "button" | null;
  readonly rt: number | null;
  /** What it was given with: "keyboard", "mouse", "touch" or "pen". */
  readonly response_device: string | null;
  readonly first_frame: number | null;
  readonly frame_times: readonly number[];
  readonly frames_shown: number;
  readonly frames_planned: number | null;
  readonly frame_interval: number | null;
  readonly frame_interval_min: number | null;
  readonly frame_interval_max: number | null;
  readonly frames_dropped: number;
  readonly shown_for: number | null;
  readonly refresh_rate: number;
  readonly page_hidden: number;
  readonly focus_lost: number;
  readonly clock_isolated: boolean;
}

/** The refresh of the screen is measured once, while the page is read, and by each trial. */
const refresh = new RefreshClock();
let measured: Promise<void> | undefined;
let isMeasured = false;
if (typeof requestAnimationFrame === "function") measured = refresh.measure().then(() => void (isMeasured = true));

/** To microseconds, the resolution of browsers. */
const rounded = (milliseconds: number): number => Math.round(milliseconds * 1000) / 1000;
const roundedOrNull = (milliseconds: number | null): number | null =>
  milliseconds === null ? null : rounded(milliseconds);

/** Count how often the page is hidden, or the window left, until `stop`. */
function watchPage(): { stop(): { page_hidden: number; focus_lost: number } } {
  const ending = new AbortController();
  let [page_hidden, focus_lost] = [document.hidden ? 1 : 0, 0];
  document.addEventListener("visibilitychange", () => document.hidden && page_hidden++, { signal: ending.signal });
  window.addEventListener("blur", () => focus_lost++, { signal: ending.signal });
  return {
    stop() {
      ending.abort();
      return { page_hidden, focus_lost };
    },
  };
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
    if (!solid && isMeasured) {
      start();
      return undefined;
    }
    const ready = Promise.all([solid ? mannequinPainter() : undefined, measured]);
    return new Promise((_, fail) => ready.then(([mannequin]) => start(mannequin)).catch(fail));
  }

  private show(
    display: HTMLElement,
    trial: Trial,
    painter: Painter,
    durationMs: number,
    buttons: readonly HTMLButtonElement[],
  ): void {
    const times: number[] = [];
    const refreshMs = refresh.intervalMs;
    const half = refreshMs / 2;
    const planned = Math.max(Math.round(durationMs / refreshMs), 1);
    const shownMs = planned * refreshMs; // a duration is a whole number of frames
    const watch = watchPage();
    let first: number | undefined;
    let cleared: number | undefined;
    let last = 0;
    let answer: (Answer & { readonly rt: number }) | undefined;
    let stopListening = (): void => {};
    painter.paint(0); // the first drawing is the slowest, so it is done before the first frame
    painter.clear();

    const end = (): void => {
      stop();
      stopListening();
      const timing = frameTiming(times, refreshMs, cleared);
      const lost = watch.stop();
      refresh.add(times);
      display.replaceChildren();
      this.jsPsych.finishTrial({
        response: answer?.response ?? null,
        response_by: answer?.by ?? null,
        rt: answer?.rt ?? null,
        response_device: answer?.device ?? null,
        first_frame: first === undefined ? null : rounded(first),
        frame_times: times.map(rounded),
        frames_shown: times.length,
        frames_planned: trial.repeat ? null : planned,
        frame_interval: roundedOrNull(timing.interval),
        frame_interval_min: roundedOrNull(timing.shortest),
        frame_interval_max: roundedOrNull(timing.longest),
        frames_dropped: timing.dropped,
        shown_for: roundedOrNull(cleared ?? (first === undefined ? null : last + refreshMs)),
        refresh_rate: rounded(1000 / refreshMs),
        ...lost,
        clock_isolated: globalThis.crossOriginIsolated ?? false,
      } satisfies WalkerData);
    };
    const onAnswer = (firstMs: number) => (given: Answer) => {
      if (answer) return;
      answer = { ...given, rt: rounded(given.timeMs - firstMs) };
      if (trial.response_ends_trial) end();
    };
    const stop = everyFrame((elapsedMs, firstMs) => {
      first ??= firstMs;
      if (trial.trial_duration !== null && elapsedMs > trial.trial_duration! - half) {
        if (cleared === undefined) cleared = elapsedMs;
        end();
        return false;
      }
      if (trial.repeat || elapsedMs < shownMs - half) {
        const moment = ((elapsedMs + half) % shownMs) - half;
        painter.paint(Math.max(moment, 0) / 1000);
        times.push((last = elapsedMs));
      } else if (cleared === undefined) {
        painter.clear();
        cleared = elapsedMs;
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
      first_frame: null,
      frame_times: [],
      frames_shown: 0,
      frames_planned: null,
      frame_interval: null,
      frame_interval_min: null,
      frame_interval_max: null,
      frames_dropped: 0,
      shown_for: null,
      refresh_rate: rounded(1000 / refresh.intervalMs),
      page_hidden: 0,
      focus_lost: 0,
      clock_isolated: globalThis.crossOriginIsolated ?? false,
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

/** The time of an event; now, if its timestamp is of another clock. */
function timeOf(event: Event): number {
  const now = performance.now();
  return event.timeStamp > 0 && event.timeStamp <= now ? event.timeStamp : now;
}

/** A click without a pointer comes from the keyboard. */
const deviceOf = (event: MouseEvent): string => ("pointerType" in event && String(event.pointerType)) || "keyboard";

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
