/** The walker that the changes start from: the average, one of the population, or the visitor's own. */

import { walkerLabel } from "../model/axisLabels";
import type { State } from "../model/state";
import { button, make } from "../page/elements";
import { pick, type Option } from "./choice";
import type { Part, Store } from "./store";

/** `open` lets the visitor choose files. */
export function walkerSelect(store: Store, open: () => void): Part {
  const { walkers } = store.model;
  const options: Option<State["from"]>[] = [
    { value: "average", label: "The average walker" },
    ...walkers.map((walker, value) => ({ value, label: walkerLabel(walker, store.model) })),
  ];
  const select = (from: State["from"]): void => store.change({ from, scene: "one" });
  const holder = make("div");
  let shown: string | null | undefined;
  let list = pick("Walker", options, select);
  /** The list contains the visitor's own walker once there is one. */
  const update = (own: string | null): void => {
    if (own === shown) return;
    shown = own;
    list = pick("Walker", own === null ? options : [...options, { value: "own", label: `${own} (yours)` }], select);
    holder.replaceChildren(list.element);
  };
  const next = (by: number): void => {
    const { from } = store.state;
    const number = typeof from === "number" ? from + by : by > 0 ? 0 : walkers.length - 1;
    select((number + walkers.length) % walkers.length);
  };
  const steps = make("div", { class: "row" },
    button("Previous", () => next(-1)),
    button("Next", () => next(1)),
    button("Random walker", () => select(Math.floor(Math.random() * walkers.length))),
  );
  const bring = make("p", { class: "note" },
    "Your own: drop a capture anywhere on this page, or ",
    button("choose a file", open, { class: "link" }),
    ".",
  );
  return {
    element: make("div", {}, holder, ...(walkers.length > 0 ? [steps] : []), bring),
    show({ state, own }) {
      update(own?.name ?? null);
      list.show(state.from);
    },
  };
}
