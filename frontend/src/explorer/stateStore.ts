/** The state of a page, and who is told when it changes: the one way that data go. */

import type { State } from "../model/state";

export type Heard = (state: State, before: State) => void;

export class Store {
  #state: State;
  readonly #heard = new Set<Heard>();

  constructor(state: State) {
    this.#state = state;
  }

  get state(): State {
    return this.#state;
  }

  /** Take over what is new, and tell all who listen, where anything is. */
  change(part: Partial<State>): void {
    const before = this.#state;
    const changed = Object.entries(part).some(([name, value]) => before[name as keyof State] !== value);
    if (!changed) return;
    this.#state = { ...before, ...part };
    for (const heard of this.#heard) heard(this.#state, before);
  }

  /** Be told of changes until the returned function is called. */
  listen(heard: Heard): () => void {
    this.#heard.add(heard);
    return () => this.#heard.delete(heard);
  }
}
