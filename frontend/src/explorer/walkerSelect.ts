/** Who walks: the average, someone of the population, or one's own capture. */

import type { State } from "../model/state";
import { button, pick, type Option } from "./choice";
import { make } from "../page/element";
import type { Part, Session } from "./store";
import { aboutWalker } from "./labels";

/** `open` lets the visitor choose files. */
export function who(session: Session, open: () => void): Part {
  const { walkers } = session.model;
  const options: Option<State["from"]>[] = [
    { value: "average", label: "The average walker" },
    ...walkers.map((walker, value) => ({ value, label: aboutWalker(walker, session.model) })),
  ];
  const walk = (from: State["from"]): void => session.change({ from, scene: "one" });
  const holder = make("div", {});
  let shown: string | null | undefined;
  let picked = pick("Walker", options, walk);
  /** One's own is in the list once there is one. */
  const list = (own: string | null): void => {
    if (own === shown) return;
    shown = own;
    const all = own === null ? options : [...options, { value: "own" as const, label: `${own} (yours)` }];
    picked = pick("Walker", all, walk);
    holder.replaceChildren(picked.element);
  };
  list(null);
  const next = (by: number): void => {
    const { from } = session.state;
    const at = typeof from === "number" ? from + by : by > 0 ? 0 : walkers.length - 1;
    walk((at + walkers.length) % walkers.length);
  };
  const steps = make("div", { class: "row" },
    button("Previous", () => next(-1)),
    button("Next", () => next(1)),
    button("Random walker", () => walk(Math.floor(Math.random() * walkers.length))),
  );
  const bring = make("p", { class: "note" },
    "Your own: drop a capture anywhere on this page, or ",
    button("choose a file", open, "link"),
    ".",
  );
  return {
    element: make("div", {}, holder, ...(walkers.length > 0 ? [steps] : []), bring),
    show({ state, own }) {
      list(own?.name ?? null);
      picked.show(state.from);
    },
  };
}
