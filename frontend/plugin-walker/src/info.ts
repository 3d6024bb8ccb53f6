/** The parameters and the data of the trial. */

import { ParameterType } from "jspsych";

import { version } from "../package.json";

export const info = {
  name: "walker",
  version,
  parameters: {
    /** The parsed content of a stimulus file. */
    stimulus: { type: ParameterType.OBJECT, default: undefined },
    /** Keys that count as a response. */
    choices: { type: ParameterType.KEYS, default: "ALL_KEYS" },
    /** Labels of buttons below the stimulus; their numbers, from 0, are the responses. */
    buttons: { type: ParameterType.STRING, array: true, default: [] as string[] },
    /** Shown below the stimulus. */
    prompt: { type: ParameterType.HTML_STRING, default: null },
    /** Milliseconds the stimulus is shown, as the nearest number of whole frames; null for the duration in the file. */
    stimulus_duration: { type: ParameterType.INT, default: null },
    /** Whether the stimulus repeats until the trial ends. */
    repeat: { type: ParameterType.BOOL, default: false },
    /** Milliseconds after which the trial ends without a response; null for never. */
    trial_duration: { type: ParameterType.INT, default: null },
    /** Whether a response ends the trial. */
    response_ends_trial: { type: ParameterType.BOOL, default: true },
    /** Factor of the size in the file, whose pixels are CSS pixels. */
    scale: { type: ParameterType.FLOAT, default: 1 },
  },
  data: {
    /** The key, or the number of the button; null for none. */
    response: { type: ParameterType.STRING },
    /** "key", "button", or null. */
    response_by: { type: ParameterType.STRING },
    /** Milliseconds from the first frame that showed the stimulus to the response. */
    rt: { type: ParameterType.FLOAT },
    /** "keyboard", "mouse", "touch" or "pen"; null for none. */
    response_device: { type: ParameterType.STRING },
    /** The first frame that showed the stimulus, in milliseconds on the clock of `performance.now()`. */
    first_frame: { type: ParameterType.FLOAT },
    /** Milliseconds from the first frame to each frame that showed the stimulus. */
    frame_times: { type: ParameterType.FLOAT, array: true },
    /** How many frames showed the stimulus, and how many its duration is; null where it repeats. */
    frames_shown: { type: ParameterType.INT },
    frames_planned: { type: ParameterType.INT },
    /** Median, shortest and longest milliseconds from frame to frame. */
    frame_interval: { type: ParameterType.FLOAT },
    frame_interval_min: { type: ParameterType.FLOAT },
    frame_interval_max: { type: ParameterType.FLOAT },
    /** Refreshes of the screen without a new picture while the stimulus was shown. */
    frames_dropped: { type: ParameterType.INT },
    /** Milliseconds from the first frame to the first without the stimulus. */
    shown_for: { type: ParameterType.FLOAT },
    /** Refreshes of the screen a second, as measured. */
    refresh_rate: { type: ParameterType.FLOAT },
    /** How often the page was hidden, and the window lost the focus, during the trial. */
    page_hidden: { type: ParameterType.INT },
    focus_lost: { type: ParameterType.INT },
    /** Whether the page is cross-origin isolated, so that clocks are fine. */
    clock_isolated: { type: ParameterType.BOOL },
  },
  citations: {
    apa: "Troje, N. F. (2002). Decomposing biological motion: A framework for analysis and synthesis of human gait patterns. Journal of Vision, 2(5), 371-387. https://doi.org/10.1167/2.5.2",
  },
} as const;
