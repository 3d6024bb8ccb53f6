/** What is seen, in one sentence: for who does not see it, and for the names of files. */

import { AVERAGE, comparedIn, nameOf } from "./figures";
import { traitOf } from "./mixing";
import type { Model, Own } from "./model";
import { ends } from "./axisLabels";
import { MOST_IN_CROWD, MOST_SIDE_BY_SIDE, TRANSFORM_NAMES, type State, type TransformName } from "./state";

/** Moler's names of the components (M4). */
export const COMPONENTS = ["stride", "sway", "hop", "bounce"] as const;

export const componentName = (number: number): string => COMPONENTS[number] ?? `component ${number + 1}`;

const TRANSFORMED: Readonly<Record<TransformName, string>> = {
  arm_swing: "with another arm swing",
  conflict: "with widths against sway",
  ellipses: "with shoulders and hips on ellipses",
  reverse: "backwards in time",
  delay: "with joints that lag",
  phase_scramble: "with each dot on its own clock",
  mirror: "as its mirror image",
  invert: "upside down",
  occlude: "in part",
  scramble: "with dots out of place",
  limb_dots: "in dots that live for a moment",
  blur: "as a blob",
  mask: "among noise",
};

export function captionOf(model: Model, state: State, own: Own | null = null): string {
  const said = [whoIsSeen(model, state, own), ...changes(model, state), viewed(state)];
  const transformed = TRANSFORM_NAMES.filter((name) => name in state.transforms).map((name) => TRANSFORMED[name]);
  return `${[...said, ...transformed].join(", ")}.`;
}

function whoIsSeen(model: Model, state: State, own: Own | null): string {
  const [side, crowd] = [Math.min(state.walkers.length, MOST_SIDE_BY_SIDE), Math.min(model.walkers.length, MOST_IN_CROWD)];
  const trait = comparedIn(model, state);
  if (state.scene === "four" && trait) {
    return `The mean ${ends(trait).join(" and the mean ")}, and both with their difference tripled`;
  }
  if (state.scene === "side") return `${side} walkers at one tempo`;
  if (state.scene === "crowd") return `${crowd} walkers`;
  const name = nameOf(model, state, own);
  return name === AVERAGE ? `The ${name}` : name;
}

function changes(model: Model, state: State): string[] {
  const traits = Object.entries(state.traits).flatMap(([name, steps]) => {
    const trait = traitOf(model, name);
    if (!trait || steps === 0) return [];
    return [`${plain(Math.abs(steps))} SD towards ${ends(trait)[Number(steps > 0)]}`];
  });
  const strengths = state.strengths.flatMap((strength, i) =>
    strength === 1 ? [] : [`${componentName(i)} times ${plain(strength)}`],
  );
  return [...(state.scene === "four" ? [] : [...traits, ...biased(model, state)]), ...strengths];
}

function biased(model: Model, { bias }: State): string[] {
  const trait = bias ? traitOf(model, bias.trait) : undefined;
  if (!bias || !trait || bias.steps === 0) return [];
  return [`bias ${plain(Math.abs(bias.steps))} towards ${ends(trait)[Number(bias.steps > 0)]}`];
}

function viewed({ azimuth_deg, elevation_deg }: State): string {
  const around = Math.round(azimuth_deg);
  const from = around === 0 ? "the front" : Math.abs(around) === 90 ? "the side" : `${around} degrees`;
  const above = Math.round(elevation_deg);
  return above === 0 ? `from ${from}` : `from ${from}, ${Math.abs(above)} degrees ${above > 0 ? "above" : "below"}`;
}

const plain = (value: number): string => String(Math.round(value * 100) / 100);
