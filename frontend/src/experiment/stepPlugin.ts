/** A jsPsych trial that does one step, and ends when the step's promise is kept. */

import { ParameterType, type JsPsych, type TrialType } from "jspsych";

const info = {
  name: "step",
  version: "1.0.0",
  parameters: {
    /** Gets the display element; returns the data of the trial. */
    step: { type: ParameterType.FUNCTION, default: undefined },
  },
  data: {},
} as const;

class StepPlugin {
  static readonly info = info;

  constructor(private readonly jsPsych: JsPsych) {}

  trial(display: HTMLElement, trial: TrialType<typeof info>): void {
    const step = trial.step as unknown as (display: HTMLElement) => Promise<object | void>;
    void step(display).then((data) => this.jsPsych.finishTrial(data ?? {}));
  }
}

export default StepPlugin;
