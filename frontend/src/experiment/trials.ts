/** The trials of a session on the screen: shown, answered, kept, one after the other. */

import { initJsPsych, type JsPsych } from "jspsych";

import WalkerPlugin from "../../plugin-walker/src/index";
import { mannequinInPage, type MannequinPainter } from "../canvas/mannequinLoader";
import { find, make } from "../page/elements";
import AdjustmentPlugin from "./adjustmentPlugin";
import { itemOf, type Content, type Item } from "./answers";
import FiguresPlugin from "./figuresPlugin";
import type { Pages } from "./pages";
import { StageKeys } from "./printedKeys";
import { isRight, type TrialProgress } from "./progressOfTrials";
import type { ScreenWatch } from "./screenWatch";
import type { Block, SessionContent, StimulusFile, Trial } from "./session";
import StepPlugin from "./stepPlugin";
import type { StopControl } from "./stopControl";

type TrialDescription = Extract<Parameters<JsPsych["run"]>[0], readonly unknown[]>[number];

export interface TrialsOptions {
  readonly session: SessionContent;
  readonly stimuli: Readonly<Record<string, StimulusFile>>;
  readonly progress: TrialProgress;
  readonly pages: Pages;
  /** Factor of the size in the stimulus files. */
  readonly scale: () => number;
  readonly watch: ScreenWatch;
  readonly stopping: StopControl;
  /** Keeps an item; the promise is kept when it is safe. */
  readonly keep: (item: Item) => Promise<void>;
  /** Whether the observer asked to stop. */
  readonly stopped: () => boolean;
}

/** What plugins report, as far as this page reads it. */
interface Shown {
  readonly response: string | number | readonly number[] | null;
  readonly response_by: string | null;
  readonly rt: number | null;
}

/** Show all trials that are to be done; the promise is kept when there are none, or at a stop. */
export async function runTrials(options: TrialsOptions): Promise<void> {
  const { pages, progress, stopping, watch, keep } = options;
  const stage = pages.showTrials();
  const jsPsych = initJsPsych({ display_element: stage, override_safe_mode: true });
  const keys = new StageKeys(stage);
  const mannequin = await mannequinFor(options);
  const goOn = (text: string): Promise<string> =>
    pages.ask([pages.title(), pages.paragraphs(text)], [["continue", "continue"]]);
  let unanswered = 0;
  for (let trial = progress.next(); trial && !options.stopped(); ) {
    await watch.check();
    pages.showTrials();
    const results: Result[] = [];
    await jsPsych.run([blank(options), oneTrial(trial, options, { mannequin, keys }, (result) => results.push(result))]);
    jsPsych.data.reset(); // what was kept is in the outbox
    await stopping.answered;
    if (options.stopped()) return;
    const block = progress.block(trial);
    const [result] = results; // none of an interrupted trial
    if (block.feedback && result?.answered) await jsPsych.run([feedback(isRight(trial, result.response), options)]);
    if (result) unanswered = result.answered ? 0 : unanswered + 1;
    if (unanswered > 0 && unanswered >= (block.pause_after ?? (block.repeats ?? 0) + 1)) {
      unanswered = 0;
      await keep(itemOf("event", { event: "pause" }, trial.trial));
      await goOn("pause");
    }
    const next = progress.next();
    const isBetween = next !== null && next.block !== trial.block && block.break_after;
    if (isBetween || (next && next !== trial && trial.break_after)) await goOn("break");
    trial = next;
  }
  keys.stop();
}

interface Stage {
  readonly mannequin: MannequinPainter | null;
  readonly keys: StageKeys;
}

/** What became of a trial. */
interface Result {
  readonly answered: boolean;
  readonly response: unknown;
}

/** Black, or the number of trials that remain. */
function blank({ session, progress, pages }: TrialsOptions): TrialDescription {
  const count = progress.todo().length;
  const text = session.pace.count_remaining ? [make("p", { class: "remaining" }, pages.text("remaining", { count }))] : [];
  return step(text, session.pace.blank_s);
}

/** Whether the answer was right, in words, so that it is not told by colours alone. */
function feedback(right: boolean, { session, pages }: TrialsOptions): TrialDescription {
  const name = right ? "feedback_right" : "feedback_wrong";
  const text = make("p", { class: `feedback ${name}`, role: "status" }, pages.text(name));
  return step([text], session.pace.feedback_s ?? 1);
}

const step = (content: readonly Node[], seconds: number): TrialDescription => ({
  type: StepPlugin,
  step: async (display: HTMLElement) => {
    display.replaceChildren(...content);
    await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
    display.replaceChildren();
  },
});

function oneTrial(
  trial: Trial,
  options: TrialsOptions,
  { mannequin, keys }: Stage,
  note: (result: Result) => void,
): TrialDescription {
  const { progress, keep, stopping } = options;
  const block = progress.block(trial);
  const attempt = progress.state(trial.trial).attempts + 1;
  const ofStaircase = trial.levels && trial.begins === undefined ? progress.level(trial) : null;
  const scale = options.scale();
  let watched: ReturnType<typeof watch>;
  let wasAsked = false;
  const onStop = (): void => void (wasAsked ||= stopping.isOpen);
  const stimuli = ofStaircase === null ? trial.stimuli : [trial.stimuli[ofStaircase]!];
  const parameters = shown({ ...trial, stimuli }, block, options, mannequin, scale);
  const choices = parameters["choices"] ?? parameters["keys"];
  return {
    ...parameters,
    on_start: () => {
      progress.note({ kind: "begun", trial: trial.trial, attempt, outcome: null });
      void keep(itemOf("begun", {}, trial.trial, attempt));
      keys.expect((choices ?? []) as readonly string[]);
      document.addEventListener("focusin", onStop);
      onStop();
      watched = watch();
    },
    // jsPsych waits for this before the next trial begins
    on_finish: async (data: Shown & Content) => {
      onStop();
      document.removeEventListener("focusin", onStop);
      const around = watched.end();
      if (wasAsked) return keep(itemOf("event", { event: "asked to stop" }, trial.trial, attempt)); // shown anew
      const outcome = data.response !== null ? "answered" : block.task === "similar_pair" ? "timeout" : "none";
      const response = meaning(data, trial, block, options.pages);
      const place = trial.begins === undefined ? ofStaircase : Number(data.response);
      const level = place === null ? {} : { level: trial.levels![place], stimulus: trial.stimuli[place] };
      const content = { ...factsOf(data, around), ...level, response, outcome, scale };
      await keep(itemOf("answer", content, trial.trial, attempt));
      progress.note({ kind: "answer", trial: trial.trial, attempt, outcome, response });
      note({ answered: outcome === "answered", response });
    },
  };
}

/** Plugin and parameters of a trial. */
function shown(
  trial: Trial,
  block: Block,
  { session, stimuli, pages }: TrialsOptions,
  mannequin: MannequinPainter | null,
  scale: number,
): TrialDescription & Record<string, unknown> {
  const files = trial.stimuli.map((name) => stimuli[name]);
  const fileS = (files[0] as { timing: { duration_s: number } }).timing.duration_s;
  const durationMs = 1000 * Math.max(session.picture.duration_s, fileS);
  const buttons = block.choices?.map((name) => pages.text(`button_${name}`)) ?? [];
  const choices = block.choices?.map((name) => keyOf(name, pages)) ?? [];
  const numbers = files.map((_, i) => String(i + 1));
  const figures = {
    type: FiguresPlugin,
    stimuli: files,
    starts: trial.starts ?? [],
    keys: numbers,
    labels: numbers.map((number) => pages.text("figure", { number })),
    trial_duration: block.limit_s ? 1000 * block.limit_s : durationMs,
    mannequin,
    scale,
  };
  switch (block.task) {
    case "similar_pair":
      return { ...figures, choose: 2 };
    case "odd_one_out":
      return { ...figures, choose: 1 };
    case "same_different":
      return { ...figures, keys: choices, buttons };
    case "adjustment":
      return {
        type: AdjustmentPlugin,
        stimuli: files,
        begins: trial.begins,
        label: pages.text("slider_label"),
        button: pages.text("slider_set"),
        mannequin,
        scale,
      };
    case "choice":
    case "detection":
      return { type: WalkerPlugin, stimulus: files[0], trial_duration: durationMs, scale, choices, buttons };
    case "rating": {
      const name = block.scale ?? session.group.scale ?? "";
      const steps = Array.from({ length: block.steps! }, (_, i) => String(i + 1));
      const ends = [pages.text(`${name}_first`), pages.text(`${name}_last`)] as const;
      const on_load = (): void => labelEnds(ends);
      const css_classes = ["above"];
      return { type: WalkerPlugin, stimulus: files[0], trial_duration: durationMs, scale, choices: steps, buttons: steps, css_classes, on_load };
    }
  }
}

/** Write what the ends of a scale mean below its first and last button. */
function labelEnds([first, last]: readonly [string, string]): void {
  const row = find(".jspsych-walker-buttons", HTMLElement);
  const buttons = [...row.querySelectorAll("button")];
  for (const [each, label] of [[buttons[0]!, first], [buttons.at(-1)!, last]] as const) {
    each.setAttribute("aria-label", `${each.textContent}, ${label}`);
  }
  const half = Math.floor(buttons.length / 2);
  const end = (text: string, columns: string): HTMLElement =>
    make("span", { class: "end", "aria-hidden": "true", style: `grid-column: ${columns}` }, text);
  row.append(end(first, `1 / ${half + 1}`), end(last, `${half + 1} / ${buttons.length + 1}`));
}

const keyOf = (name: string, pages: Pages): string => pages.text(`key_${name}`).toLowerCase();

/** What the observer chose, in the words of the design: a class, a step from 1, places, or a level. */
function meaning({ response, response_by }: Shown, trial: Trial, block: Block, pages: Pages): unknown {
  if (response === null || block.task === "similar_pair" || block.task === "odd_one_out") return response;
  const byKey = response_by === "key";
  if (block.task === "adjustment") return trial.levels![Number(response)];
  if (block.task === "rating") return byKey ? Number(response) : Number(response) + 1;
  if (block.task === "same_different" || !byKey) return block.choices![Number(response)];
  return block.choices!.find((name) => keyOf(name, pages) === response);
}

/** Names of what a plugin measured, with their units. */
const WITH_UNITS: Readonly<Record<string, string>> = {
  rt: "rt_ms",
  frame_interval: "frame_interval_ms",
  frame_interval_min: "frame_interval_min_ms",
  frame_interval_max: "frame_interval_max_ms",
  shown_for: "shown_ms",
  refresh_rate: "refresh_hz",
};
const NOT_KEPT = ["trial_type", "trial_index", "plugin_version", "time_elapsed", "response", "stimulus", "first_frame"];

/** What the plugin measured and what was noted around it, without what jsPsych adds. */
function factsOf(data: Content, { started_ms, unfocused, ...around }: Noted): Content {
  const facts = Object.entries(data).filter(([name]) => !NOT_KEPT.includes(name));
  const first = data["first_frame"] as number | null;
  return {
    ...Object.fromEntries(facts.map(([name, value]) => [WITH_UNITS[name] ?? name, value])),
    first_frame_ms: first === null ? null : Math.round(1000 * (first - started_ms)) / 1000,
    focus_lost: Number(data["focus_lost"]) + Number(unfocused),
    ...around,
  };
}

interface Noted {
  readonly started_utc: string;
  /** On the clock of `performance.now()`. */
  readonly started_ms: number;
  /** Whether the window had no focus when the trial began. */
  readonly unfocused: boolean;
  readonly resized: boolean;
  readonly full_screen: boolean;
  readonly pixel_ratio: number;
}

/** Notes what happens around a trial, until it is asked. */
function watch(): { readonly end: () => Noted } {
  const started = { started_utc: new Date().toISOString(), started_ms: performance.now() };
  const unfocused = !document.hasFocus();
  let resized = false;
  const onResize = (): void => void (resized = true);
  window.addEventListener("resize", onResize);
  return {
    end: () => {
      window.removeEventListener("resize", onResize);
      const full_screen = document.fullscreenElement !== null;
      return { ...started, unfocused, resized, full_screen, pixel_ratio: window.devicePixelRatio };
    },
  };
}

/** The painter of mannequins, where any is shown. */
async function mannequinFor({ stimuli }: TrialsOptions): Promise<MannequinPainter | null> {
  const needed = Object.values(stimuli).some(
    (each) => (each as { display?: { style?: string } }).display?.style === "mannequin",
  );
  if (!needed) return null;
  return mannequinInPage();
}
