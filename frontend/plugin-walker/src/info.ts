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
    /** Milliseconds the stimulus is shown; null for the duration in the file. */
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
    /** Milliseconds from the first frame to each frame that showed the stimulus. */
    frame_times: { type: ParameterType.FLOAT, array: true },
    /** Median milliseconds from frame to frame. */
    frame_interval: { type: ParameterType.FLOAT },
    /** Frames of the screen without a new picture. */
    frames_dropped: { type: ParameterType.INT },
  },
  citations: {
    apa: "Troje, N. F. (2002). Decomposing biological motion: A framework for analysis and synthesis of human gait patterns. Journal of Vision, 2(5), 371-387. https://doi.org/10.1167/2.5.2",
  },
} as const;
