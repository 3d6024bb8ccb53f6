/** One visit: the model, what was chosen, and what follows from it, told to all parts of the page. */

import { castOf, type Cast } from "../model/figures";
import { measuresOf, type MeasureName } from "../model/measures";
import { vectorOf } from "../model/mixing";
import type { Model, Own } from "../model/model";
import { placeOf, type Place } from "../model/position";
import { initialState, type State } from "../model/state";
import { Store } from "./stateStore";
import { walkerOf } from "../model/features";
import type { Stage } from "../viewer/viewer";
import { axesOf, type Axis } from "./axis";

/** What is shown at this moment: the state, and what is computed from it once for all parts. */
export interface Now {
  readonly model: Model;
  readonly state: State;
  readonly own: Own | null;
  readonly vector: Float64Array;
  readonly cast: readonly Cast[];
  readonly place: Place;
  readonly measures: Readonly<Record<MeasureName, number>>;
}

/** What shows something of the moment. */
export interface Shown {
  show(now: Now): void;
  /** Be gone: another session takes over. */
  leave?(): void;
}

/** A piece of the page that does. */
export interface Part extends Shown {
  readonly element: HTMLElement;
}

/** Changes that follow one another within this time are undone together, and those of one drag. */
const TOGETHER_MS = 700;
const MOST_UNDONE = 100;
/** Not worth a step back. */
const PASSING: readonly (keyof State)[] = ["playing", "cycle", "dark"];

/** What walkers are made from; all else is how they are looked at. */
const WALKS: readonly (keyof State)[] = [
  "traits", "kind", "part", "from", "bias", "strengths", "eigenwalkers", "scene", "walkers",
];

export class Session {
  /** What draws it, and knows where in its stride the walker is while it walks. */
  stage: Pick<Stage, "cycle" | "mannequin"> | null = null;
  readonly store: Store;
  readonly axes: readonly Axis[];
  #own: Own | null = null;
  #past: State[] = [];
  #lastKept = -Infinity;
  #undoing = false;
  #held: "no" | "new" | "kept" = "no";
  #hears: ((now: Now) => void)[] = [];
  #request = 0;
  #last: Now | null = null;

  constructor(
    readonly model: Model,
    state: State = initialState(model),
    own: Own | null = null,
  ) {
    this.#own = own;
    this.store = new Store(state);
    this.axes = axesOf(model);
    this.store.listen((after, before) => {
      this.#keep(after, before);
      this.#soon();
    });
  }

  get state(): State {
    return this.store.state;
  }

  get own(): Own | null {
    return this.#own;
  }

  /** Let one's own walker walk. */
  take(own: Own): void {
    this.#own = own;
    this.store.change({ from: "own", scene: "one" });
    this.#soon();
  }

  change(part: Partial<State>): void {
    this.store.change(part);
  }

  /** Let it walk, or stand where it is. */
  play(playing: boolean): void {
    this.change(playing ? { playing } : { playing, cycle: this.stage?.cycle ?? 0 });
  }

  /** All as it was when the page was new, the view too; dark or light stays. */
  reset(): void {
    const { dark, playing, cycle } = this.state;
    this.change({ ...initialState(this.model), dark, playing, cycle });
  }

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  undo(): void {
    const before = this.#past.pop();
    if (!before) return;
    const { dark, playing, cycle } = this.state;
    this.#undoing = true;
    this.change({ ...before, dark, playing, cycle });
    this.#undoing = false;
    this.#lastKept = -Infinity;
  }

  /** A hand holds something, or lets it go: what changes meanwhile is undone together. */
  hold(holds: boolean): void {
    this.#held = holds ? "new" : "no";
  }

  /** Be told once for each frame of the screen in which something changed. */
  listen(hears: (now: Now) => void): void {
    this.#hears.push(hears);
  }

  now(): Now {
    const { model, state, own } = this;
    const last = this.#last;
    const same = last && last.own === own && WALKS.every((key) => last.state[key] === state[key]);
    if (same) this.#last = { ...last, state };
    else {
      const vector = vectorOf(model, state, own);
      const cast = castOf(model, state, own);
      const measures = measuresOf(walkerOf(model, vector));
      this.#last = { model, state, own, vector, cast, place: placeOf(model, vector), measures };
    }
    return this.#last!;
  }

  /** Tell all parts now. */
  tell(): void {
    cancelAnimationFrame(this.#request);
    this.#request = 0;
    const now = this.now();
    for (const hears of this.#hears) hears(now);
  }

  /** Be silent from now on: another session takes over. */
  end(): void {
    cancelAnimationFrame(this.#request);
    this.#hears = [];
  }

  #soon(): void {
    this.#request ||= requestAnimationFrame(() => this.tell());
  }

  #keep(after: State, before: State): void {
    if (this.#undoing) return;
    const keys = Object.keys(after) as (keyof State)[];
    if (keys.every((key) => PASSING.includes(key) || after[key] === before[key])) return;
    const time = performance.now();
    const together = this.#held === "no" ? time - this.#lastKept <= TOGETHER_MS : this.#held === "kept";
    if (this.#held === "new") this.#held = "kept";
    if (!together) this.#past = [...this.#past, before].slice(-MOST_UNDONE);
    this.#lastKept = time;
  }
}
