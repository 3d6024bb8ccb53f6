/** The measures of the walker, as numbers with small plots. */

import { capitalised, classOf, colourLegend } from "../model/labels";
import { positionOf, walkerOf } from "../model/features";
import { MEASURES, measuresOf, type Measures } from "../model/measures";
import { mixedVector } from "../model/mixing";
import type { Model, OwnWalker } from "../model/model";
import { clamped, initialState, RANGES, type State } from "../model/state";
import { draw, make, setAttributes, signed } from "../page/elements";
import type { Axis } from "./axis";
import { note } from "./parts";
import type { Now, Part, Store } from "./store";

const WIDTH = 160;
const HEIGHT = 56;
/** From the extremes of the plot to its edges. */
const MARGIN = 5;
/** Points of the line from one end of the slider to the other. */
const N_ALONG = 9;

/** Parts of the state that the line depends on, beside traits and eigenwalkers. */
const LINE_PARTS = ["kind", "part", "from", "bias", "strengths"] as const;

interface Spot {
  readonly measures: Measures;
  /** Standard deviations along the main axis. */
  readonly score: number;
}

/**
 * One small plot for each measure: across, the positions of walkers along the main axis; up, the measure.
 * Points are people, the line is the path of this walker along the large slider, the dot is this walker.
 */
export function measurePlots(store: Store): Part {
  const { model } = store;
  const [axis] = store.axes;
  const people = model.walkers.map(({ vector }) => spotOf(model, vector, axis));
  const initial = along(model, initialState(model), null, axis);
  const average = spotOf(model, model.average, axis);
  const plots = MEASURES.filter(({ name }) => Number.isFinite(average.measures[name])).map((measure) => {
    const values = [average, ...initial, ...people].map(({ measures }) => measures[measure.name]);
    const range = [Math.min(...values), Math.max(...values)] as const;
    return plot(model, axis, measure, people, average.measures[measure.name], range);
  });
  const legend = ["Small points: people", colourLegend(axis?.trait), axis ? "line: where the large slider leads this walker" : ""];
  let line = initial;
  let last: Now | undefined;
  const element = make("div", {},
    make("dl", { class: "measures" }, ...plots.map(({ element }) => element)),
    note(`${legend.filter(Boolean).join("; ")}.`));
  return {
    element,
    show(now) {
      element.hidden = now.state.scene !== "one";
      if (element.hidden) return;
      if (!last || !sameLine(last, now, axis)) line = along(model, now.state, now.own, axis);
      last = now;
      for (const one of plots) one.show(now, line);
    },
  };
}

/** Whether the line is the same as before: moving the main slider does not change it. */
function sameLine(before: Now, { state, own }: Now, axis: Axis | undefined): boolean {
  const others = (of: State): string => {
    const { traits, eigenwalkers } = { ...of, ...axis?.moved(of, 0) };
    return JSON.stringify([traits, eigenwalkers]);
  };
  const same = LINE_PARTS.every((part) => before.state[part] === state[part]);
  return same && before.own === own && others(before.state) === others(state);
}

const spotOf = (model: Model, vector: ArrayLike<number>, axis: Axis | undefined): Spot => ({
  measures: measuresOf(walkerOf(model, vector), model.speed_factor),
  score: axis?.at(positionOf(model, vector)) ?? 0,
});

interface Stop extends Spot {
  /** Value of the main slider. */
  readonly steps: number;
}

/** From one end of the main slider to the other, all else unchanged. */
function along(model: Model, state: State, own: OwnWalker | null, axis: Axis | undefined): Stop[] {
  const [low, high] = RANGES.trait;
  return Array.from({ length: axis ? N_ALONG : 0 }, (_, i) => {
    const steps = low + ((high - low) * i) / (N_ALONG - 1);
    return { steps, ...spotOf(model, mixedVector(model, { ...state, ...axis!.moved(state, steps) }, own), axis) };
  });
}

function plot(
  model: Model,
  axis: Axis | undefined,
  { name, label, unit, digits }: (typeof MEASURES)[number],
  people: readonly Spot[],
  average: number,
  [least, greatest]: readonly [number, number],
) {
  const [low, high] = RANGES.trait;
  const range = greatest - least || 1;
  const x = (sd: number): number => (WIDTH * (sd - low)) / (high - low);
  const y = (value: number): number => HEIGHT - MARGIN - ((HEIGHT - 2 * MARGIN) * (value - least)) / range;
  const dots = people.map(({ measures, score }, i) => {
    const at = { cx: x(score).toFixed(1), cy: y(measures[name]).toFixed(1) };
    return draw("circle", { class: `person ${classOf(model, i)}`, r: 1.4, ...at });
  });
  const line = draw("polyline", { class: "trail" });
  const here = draw("circle", { class: "now", r: 3.6 });
  const text = make("dd");
  const element = make("div", { class: "measure" },
    make("dt", {}, capitalised(label)),
    text,
    make("dd", { class: "plot", "aria-hidden": "true" },
      draw("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}` }, ...dots, line, here)),
  );
  const show = ({ state, measures, position }: Now, stops: readonly Stop[]): void => {
    const value = measures[name];
    const difference = signed(value - average, digits);
    const small = make("small", {}, difference === "0" ? "average" : difference);
    text.replaceChildren(make("b", {}, value.toFixed(digits)), ` ${unit}`, small);
    const now = { steps: axis?.value(state) ?? 0, measures, score: axis?.at(position) ?? 0 };
    const curve = [...stops, now].sort((a, b) => a.steps - b.steps);
    const points = curve.map(({ score, measures }) => `${x(score).toFixed(1)},${y(measures[name]).toFixed(1)}`);
    setAttributes(line, { points: points.join(" ") });
    const [h, v] = [x(now.score), y(value)];
    const [cx, cy] = [clamped([MARGIN, WIDTH - MARGIN], h), clamped([MARGIN, HEIGHT - MARGIN], v)];
    setAttributes(here, { cx: cx.toFixed(1), cy: cy.toFixed(1) });
    here.classList.toggle("beyond", Math.hypot(h - cx, v - cy) > MARGIN);
  };
  return { element, show };
}
