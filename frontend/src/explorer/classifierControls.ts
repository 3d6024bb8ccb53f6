/** What the classifier behind the sliders knows, and whether it tells a trait or shows it (J31, A13). */

import { partsOf } from "../model/mixing";
import type { Kind } from "../model/state";
import { choice, pick, type Option } from "./choice";
import { make } from "../page/element";
import type { Part, Session } from "./store";
import { capital } from "./labels";

const PARTS: Readonly<Record<string, Omit<Option<string>, "value">>> = {
  all: { label: "Everything", hint: "All that a walk consists of" },
  structure: { label: "Body only", hint: "The mean posture: how people are built" },
  dynamics: { label: "Motion only", hint: "How they move, whatever their build" },
  p1: { label: "Stride (p1)" },
  p2: { label: "Sway (p2)" },
  p3: { label: "Hop (p3)" },
  p4: { label: "Bounce (p4)" },
  frequency: { label: "Frequency" },
  phases: { label: "Phases" },
};
const COMMON = ["all", "structure", "dynamics"];

const KINDS: readonly Option<Kind>[] = [
  { value: "discriminant", label: "Tells best", hint: "The discriminant: what a classifier looks for (Troje)" },
  { value: "mean_difference", label: "Differs most", hint: "The difference between mean walkers (Moler)" },
];

/** Left out where there are no traits to change. */
export function classifier(session: Session): Part {
  const known = partsOf(session.model);
  const option = (value: string): Option<string> => ({ value, ...(PARTS[value] ?? { label: capital(value) }) });
  const choose = (part: string): void => session.change({ part });
  const common = known.filter((part) => COMMON.includes(part)).map(option);
  const parts = choice("What the sliders may change", common, choose);
  const rest = known.filter((part) => !COMMON.includes(part)).map(option);
  const single = pick<string>("or one part of the motion", [{ value: "", label: "\u2013" }, ...rest], (part) =>
    choose(part || "all"),
  );
  const kind = choice("Direction", KINDS, (value) => session.change({ kind: value }));
  const about = make("p", { class: "note" });
  return {
    element: make("div", {}, parts.element, ...(rest.length > 0 ? [single.element] : []), kind.element, about),
    show({ state }) {
      parts.show(state.part);
      single.show(COMMON.includes(state.part) ? "" : state.part);
      kind.show(state.kind);
      about.textContent =
        state.kind === "discriminant"
          ? "The direction that tells people apart best: one step is one standard deviation of the walkers."
          : "From the mean of one class to the mean of the other: shows best what goes along with a trait.";
    },
  };
}
