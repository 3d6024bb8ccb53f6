/** The part of the features that traits change, and the kind of their direction. */

import { capitalised } from "../model/axisLabels";
import { partsOf } from "../model/mixing";
import type { Kind } from "../model/model";
import { make } from "../page/elements";
import { choice, pick, type Option } from "./choice";
import { note } from "./section";
import type { Part, Store } from "./store";

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

export function classifierControls(store: Store): Part {
  const options = partsOf(store.model).map((value): Option<string> => ({ value, ...(PARTS[value] ?? { label: capitalised(value) }) }));
  const [common, rest] = [true, false].map((is) => options.filter(({ value }) => COMMON.includes(value) === is));
  const choose = (part: string): void => store.change({ part: part || "all" });
  const parts = choice("What the sliders may change", common!, choose);
  const single = pick("or one part of the motion", [{ value: "", label: "\u2013" }, ...rest!], choose);
  const kind = choice("Direction", KINDS, (value) => store.change({ kind: value }));
  const about = note("");
  return {
    element: make("div", {}, parts.element, ...(rest!.length > 0 ? [single.element] : []), kind.element, about),
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
