/** Which trials are done, from all that was reported: by this machine and by others. */

import type { Block, Reported, SessionContent, Trial } from "./session";
import { nextLevel } from "./staircase";

export interface TrialState {
  /** Times that the trial was begun. */
  attempts: number;
  done: boolean;
}

export class TrialProgress {
  private readonly states = new Map<number, TrialState>();
  private readonly responses = new Map<number, unknown>();
  private nTimeouts = 0;

  constructor(
    private readonly session: Pick<SessionContent, "trials" | "blocks">,
    reported: readonly Reported[],
  ) {
    for (const item of reported) this.note(item);
  }

  state(trial: number): TrialState {
    const state = this.states.get(trial) ?? { attempts: 0, done: false };
    this.states.set(trial, state);
    return state;
  }

  note({ kind, trial, attempt, outcome, response }: Reported): void {
    if (trial === null || (kind !== "begun" && kind !== "answer")) return;
    const state = this.state(trial);
    state.attempts = Math.max(state.attempts, attempt ?? 0);
    if (kind === "answer" && outcome === "timeout" && !state.done) this.nTimeouts += 1;
    if (kind === "answer" && outcome === "answered" && !state.done) this.responses.set(trial, response);
    if (kind === "answer" && (outcome === "answered" || outcome === "timeout")) state.done = true;
  }

  block(trial: Trial): Block {
    return this.session.blocks[trial.block - 1]!;
  }

  /** The place of the level of a trial of a staircase: from the answers to the trials before it. */
  level(trial: Trial): number {
    const { start = 0, down = 1 } = this.block(trial);
    const before = this.session.trials.filter((each) => each.block === trial.block && each.trial < trial.trial);
    const answered = before.filter((each) => this.responses.has(each.trial));
    const correct = answered.map((each) => isRight(each, this.responses.get(each.trial)));
    return nextLevel(correct, { start, down, nLevels: trial.levels!.length });
  }

  /** The first trial that is not done; spare ones count as far as they replace others. */
  next(): Trial | null {
    return this.todo()[0] ?? null;
  }

  /** Trials that are not done. */
  todo(): readonly Trial[] {
    const { trials } = this.session;
    const spare = trials.filter((trial) => trial.spare).slice(0, this.nTimeouts);
    const shown = new Set(spare);
    return trials.filter((trial) => (!trial.spare || shown.has(trial)) && !this.state(trial.trial).done);
  }

  /** Practice is shown again. */
  practiseAgain(): void {
    for (const { trial, practice } of this.session.trials) if (practice) this.state(trial).done = false;
  }

  get anyBegun(): boolean {
    return [...this.states.values()].some((state) => state.attempts > 0);
  }
}

/** Whether a response is the right one, or one of them. */
export const isRight = ({ correct }: Trial, response: unknown): boolean =>
  [correct].flat().some((each) => each !== undefined && String(each) === String(response));
