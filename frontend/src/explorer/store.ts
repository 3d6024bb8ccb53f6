/** The store of the page: the model, the state, its history, and all values that follow from the state. */

import { positionOf, walkerOf, type Position } from "../model/features";
import { figuresOf, type Scene } from "../model/figures";
import { measuresOf, type Measures } from "../model/measures";
import { mixedVector } from "../model/mixing";
import type { Model, OwnWalker } from "../model/model";
import { initialState, type State } from "../model/state";
import type { Viewer } from "../viewer/viewer";
import { axesOf, type Axis } from "./axis";

/** The state at one moment, with the values that are computed from it once for all parts of the page. */
export interface Now extends Scene {
  readonly own: OwnWalker | null;
  readonly position: Position;
  readonly measures: Measures;
}

export interface View {
  show(now: Now): void;
  /** End: another store takes over. */
  remove?(): void;
}

export interface Part extends View {
  readonly element: HTMLElement;
}

/** Changes that follow one another within this time are one step of undo, and so is one drag. */
const TOGETHER_MS = 700;
const MAX_STEPS = 100;
/** Changes of these parts alone are no step of undo, and undo keeps them. */
const PASSING = ["playing", "cycle", "dark"] as const satisfies readonly (keyof State)[];

export class Store {
  /** The viewer, which knows the phase of the walker during playback. */
  viewer: Pick<Viewer, "phase" | "mannequin"> | null = null;
  readonly axes: readonly Axis[];
  #state: State;
  #own: OwnWalker | null;
  #past: State[] = [];
  #lastStep = -Infinity;
  /** Whether a pointer is down, and whether the drag has its step of undo already. */
  #drag: "none" | "new" | "recorded" = "none";
  #listeners: ((now: Now) => void)[] = [];
  #request = 0;
  #now: Now | null = null;

  constructor(
    readonly model: Model,
    state: State = initialState(model),
    own: OwnWalker | null = null,
  ) {
    this.#state = state;
    this.#own = own;
    this.axes = axesOf(model);
  }

  get state(): State {
    return this.#state;
  }

  get own(): OwnWalker | null {
    return this.#own;
  }

  setOwn(own: OwnWalker): void {
    this.#own = own;
    this.change({ from: "own", scene: "one" });
    this.#publishSoon();
  }

  change(part: Partial<State>): void {
    const changed = (Object.keys(part) as (keyof State)[]).filter((name) => part[name] !== this.#state[name]);
    if (changed.length === 0) return;
    if (changed.some((name) => !(PASSING as readonly string[]).includes(name))) this.#record();
    this.#state = { ...this.#state, ...part };
    this.#publishSoon();
  }

  /** Play, or pause at the present phase. */
  play(playing: boolean): void {
    this.change(playing ? { playing } : { playing, cycle: this.viewer?.phase ?? 0 });
  }

  /** Go back to the initial state, but for playback and theme. */
  reset(): void {
    this.change({ ...initialState(this.model), ...this.#passing() });
  }

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  undo(): void {
    const before = this.#past.pop();
    if (!before) return;
    this.#state = { ...before, ...this.#passing() };
    this.#lastStep = -Infinity;
    this.#publishSoon();
  }

  /** A pointer is down or up: changes during a drag are one step of undo. */
  setDragging(dragging: boolean): void {
    this.#drag = dragging ? "new" : "none";
  }

  /** Call a function once for each frame of the screen in which something changed. */
  listen(listener: (now: Now) => void): void {
    this.#listeners.push(listener);
  }

  now(): Now {
    const { model, state, own } = this;
    const figures = figuresOf(model, state, own);
    if (this.#now?.figures === figures) return (this.#now = { ...this.#now, own, state });
    const vector = mixedVector(model, state, own);
    const measures = measuresOf(walkerOf(model, vector), model.speed_factor);
    return (this.#now = { model, state, own, figures, position: positionOf(model, vector), measures });
  }

  publish(): void {
    cancelAnimationFrame(this.#request);
    this.#request = 0;
    const now = this.now();
    for (const listener of this.#listeners) listener(now);
  }

  /** Call no listeners any more: another store takes over. */
  end(): void {
    cancelAnimationFrame(this.#request);
    this.#listeners = [];
  }

  #passing(): Pick<State, (typeof PASSING)[number]> {
    const { playing, cycle, dark } = this.#state;
    return { playing, cycle, dark };
  }

  #publishSoon(): void {
    this.#request ||= requestAnimationFrame(() => this.publish());
  }

  /** Keep the present state as a step of undo, unless the change belongs to the last step. */
  #record(): void {
    const time = performance.now();
    const together = this.#drag === "none" ? time - this.#lastStep <= TOGETHER_MS : this.#drag === "recorded";
    if (this.#drag === "new") this.#drag = "recorded";
    if (!together) this.#past = [...this.#past, this.#state].slice(-MAX_STEPS);
    this.#lastStep = time;
  }
}
