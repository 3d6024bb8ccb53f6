/** The trials of a session on the screen: shown, answered, kept, one after the other. */

import { initJsPsych, type JsPsych } from "jspsych";

import WalkerPlugin from "../../plugin-walker/src/index";
import { mannequinInPage, type MannequinPainter } from "../canvas/mannequinLoader";
import { make } from "../page/elements";
import { itemOf, type Content, type Item } from "./answers";
import FiguresPlugin from "./figuresPlugin";
import type { Pages } from "./pages";
import type { TrialProgress } from "./progressOfTrials";
import type { Block, SessionContent, StimulusFile, Trial } from "./session";
import StepPlugin from "./stepPlugin";

type TrialDescription = Extract<Parameters<JsPsych["run"]>[0], readonly unknown[]>[number];

export interface TrialsOptions {
  readonly session: SessionContent;
  readonly stimuli: Readonly<Record<string, StimulusFile>>;
  readonly progress: TrialProgress;
  readonly pages: Pages;
  /** Factor of the size in the stimulus files. */
  readonly scale: number;
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
  const { pages, progress } = options;
  const jsPsych = initJsPsych({ display_element: pages.showTrials(), override_safe_mode: true });
  const mannequin = await mannequinFor(options);
  let unanswered = 0;
  for (let trial = progress.next(); trial && !options.stopped(); ) {
    pages.showTrials();
    await jsPsych.run([blank(options), oneTrial(trial, options, mannequin)]);
    if (options.stopped()) return;
    const block = progress.block(trial);
    unanswered = progress.state(trial.trial).done && !lastTimedOut(jsPsych) ? 0 : unanswered + 1;
    if (unanswered > 0 && unanswered >= (block.pause_after ?? (block.repeats ?? 0) + 1)) {
      unanswered = 0;
      await options.keep(itemOf("event", { event: "pause" }, trial.trial));
      await pages.ask([pages.title(), pages.paragraphs("pause")], [["continue", "continue"]]);
    }
    const next = progress.next();
    if (next && next.block !== trial.block && block.break_after) {
      await pages.ask([pages.title(), pages.paragraphs("break")], [["continue", "continue"]]);
    }
    trial = next;
  }
}

const lastTimedOut = (jsPsych: JsPsych): boolean =>
  (jsPsych.data.getLastTrialData().values()[0] as Shown | undefined)?.response === null;

/** Black, or the number of trials that remain. */
function blank({ session, progress, pages }: TrialsOptions): TrialDescription {
  const count = progress.todo().length;
  return {
    type: StepPlugin,
    step: async (display: HTMLElement) => {
      const text = session.pace.count_remaining ? [make("p", { class: "remaining" }, pages.text("remaining", { count }))] : [];
      display.replaceChildren(...text);
      await new Promise((resolve) => setTimeout(resolve, 1000 * session.pace.blank_s));
      display.replaceChildren();
    },
  };
}

function oneTrial(trial: Trial, options: TrialsOptions, mannequin: MannequinPainter | null): TrialDescription {
  const { progress, keep } = options;
  const block = progress.block(trial);
  const attempt = progress.state(trial.trial).attempts + 1;
  const place = trial.levels ? progress.level(trial) : null;
  const level = place === null ? {} : { level: trial.levels![place], stimulus: trial.stimuli[place] };
  let watched: ReturnType<typeof watch>;
  return {
    ...shown(place === null ? trial : { ...trial, stimuli: [trial.stimuli[place]!] }, block, options, mannequin),
    on_start: () => {
      const item = itemOf("begun", {}, trial.trial, attempt);
      progress.note({ kind: "begun", trial: trial.trial, attempt, outcome: null });
      void keep(item);
      watched = watch();
    },
    // jsPsych waits for this before the next trial begins
    on_finish: async (data: Shown & Content) => {
      const outcome = data.response !== null ? "answered" : block.task === "similar_pair" ? "timeout" : "none";
      const response = meaning(data, block, options.pages);
      const content = { ...factsOf(data, watched.end()), ...level, response, outcome, scale: options.scale };
      await keep(itemOf("answer", content, trial.trial, attempt));
      progress.note({ kind: "answer", trial: trial.trial, attempt, outcome, response });
    },
  };
}

/** Plugin and parameters of a trial. */
function shown(
  trial: Trial,
  block: Block,
  { session, stimuli, pages, scale }: TrialsOptions,
  mannequin: MannequinPainter | null,
): TrialDescription {
  const files = trial.stimuli.map((name) => stimuli[name]);
  const fileS = (files[0] as { timing: { duration_s: number } }).timing.duration_s;
  const durationMs = 1000 * Math.max(session.picture.duration_s, fileS);
  if (block.task === "similar_pair") {
    const keys = files.map((_, i) => String(i + 1));
    const labels = keys.map((number) => pages.text("figure", { number }));
    return { type: FiguresPlugin, stimuli: files, choose: 2, keys, labels, trial_duration: 1000 * block.limit_s!, mannequin, scale };
  }
  const single = { type: WalkerPlugin, stimulus: files[0], trial_duration: durationMs, scale };
  if (block.task === "choice" || block.task === "detection") {
    return {
      ...single,
      choices: block.choices!.map((name) => pages.text(`key_${name}`).toLowerCase()),
      buttons: block.choices!.map((name) => pages.text(`button_${name}`)),
    };
  }
  const scaleName = block.scale ?? session.group.scale ?? "";
  const steps = Array.from({ length: block.steps! }, (_, i) => String(i + 1));
  const buttons = steps.map((step, i) =>
    i === 0 ? pages.text(`${scaleName}_first`) : i === steps.length - 1 ? pages.text(`${scaleName}_last`) : step,
  );
  return { ...single, choices: steps, buttons, css_classes: ["above"] };
}

/** What the observer chose, in the words of the design: a class, a step from 1, two places. */
function meaning({ response, response_by }: Shown, block: Block, pages: Pages): unknown {
  if (response === null || block.task === "similar_pair") return response;
  const byKey = response_by === "key";
  if (block.task === "rating") return byKey ? Number(response) : Number(response) + 1;
  const names = block.choices!;
  return byKey ? names.find((name) => pages.text(`key_${name}`).toLowerCase() === response) : names[Number(response)];
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
