/** What changes in the body, as numbers with small plots. */

import { MEASURES, measuresOf, type MeasureName } from "../model/measures";
import { vectorOf } from "../model/mixing";
import type { Model } from "../model/model";
import { placeOf } from "../model/position";
import { initialState, RANGES, type State } from "../model/state";
import { walkerOf } from "../model/features";
import type { Axis } from "./axis";
import { draw, make, put } from "../page/element";
import type { Now, Part, Session } from "./store";
import { capital, classOf, colours } from "./labels";

const WIDTH = 160;
const HEIGHT = 56;
/** Between the greatest and least of the plot and its edges. */
const MARGIN = 5;
/** Points of the curve from one end of the slider to the other. */
const N_ALONG = 9;

/** What the line depends on, beside traits and eigenwalkers. */
const LINED = ["kind", "part", "from", "bias", "strengths"] as const;

type Measures = Readonly<Record<MeasureName, number>>;

const at = (vector: ArrayLike<number>, model: Model): Measures =>
  measuresOf(walkerOf(model, Float64Array.from(vector)));

/**
 * One small plot for each measure: across, where walkers lie along the main trait; up, the measure.
 * Points are people, the line is where the main slider would lead this walker, the dot is where it is.
 */
export function changes(session: Session): Part {
  const { model } = session;
  const [axis] = session.axes;
  const people = model.walkers.map(({ vector }) => spotOf(model, vector, axis));
  const usual = along(model, initialState(model), null, axis);
  const average = at(model.average, model);
  const known = MEASURES.filter(({ name }) => Number.isFinite(average[name]));
  const plots = known.map((measure) => {
    const all = [average, ...[...usual, ...people].map(({ measures }) => measures)];
    const values = all.map((of) => of[measure.name]);
    return plot(model, axis, measure, people, [Math.min(...values), Math.max(...values)]);
  });
  const legend = ["Small points: people", colours(axis?.trait), axis ? "line: where the large slider leads this walker" : ""];
  let line = usual;
  let last: Now | undefined;
  const element = make("div", {},
    make("dl", { class: "measures" }, ...plots.map(({ element }) => element)),
    make("p", { class: "note" }, `${legend.filter(Boolean).join("; ")}.`));
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

/** Whether the main slider leads through the same walkers as before: it may have moved itself. */
function sameLine(before: Now, { state, own }: Now, axis: Axis | undefined): boolean {
  const others = (of: State): string => {
    const { traits, eigenwalkers } = { ...of, ...axis?.moved(of, 0) };
    return JSON.stringify([traits, eigenwalkers]);
  };
  const same = LINED.every((key) => before.state[key] === state[key]);
  return same && before.own === own && others(before.state) === others(state);
}

/** A walker in the plots. */
interface Spot {
  readonly measures: Measures;
  /** Standard deviations along the main trait. */
  readonly score: number;
}

const spotOf = (model: Model, vector: ArrayLike<number>, axis: Axis | undefined): Spot => ({
  measures: at(vector, model),
  score: axis?.at(placeOf(model, vector)) ?? 0,
});

/** On the line to which the main slider leads, where it stands so. */
interface Stop extends Spot {
  readonly steps: number;
}

/** From one end of the main slider to the other, all else as it is. */
export function along(model: Model, state: State, own: Now["own"], axis: Axis | undefined): Stop[] {
  const [low, high] = RANGES.trait;
  return Array.from({ length: axis ? N_ALONG : 0 }, (_, i) => {
    const steps = low + ((high - low) * i) / (N_ALONG - 1);
    return { steps, ...spotOf(model, vectorOf(model, { ...state, ...axis!.moved(state, steps) }, own), axis) };
  });
}

/** The line with the walker itself as one of its points. */
function through(line: readonly Stop[], { state, measures, place }: Now, axis: Axis | undefined): Stop[] {
  const here = { steps: axis?.value(state) ?? 0, measures, score: axis?.at(place) ?? 0 };
  return [...line, here].sort((a, b) => a.steps - b.steps);
}

function plot(
  model: Model,
  axis: Axis | undefined,
  { name, label, unit, digits }: (typeof MEASURES)[number],
  people: readonly Spot[],
  [least, greatest]: readonly [number, number],
) {
  const [low, high] = RANGES.trait;
  const over = greatest - least || 1;
  const inside = (place: number, most: number): number => Math.min(Math.max(place, MARGIN), most - MARGIN);
  const x = (sd: number): number => (WIDTH * (sd - low)) / (high - low);
  const y = (value: number): number => HEIGHT - MARGIN - ((HEIGHT - 2 * MARGIN) * (value - least)) / over;
  const dots = people.map(({ measures, score }, i) => {
    const at = { cx: x(score).toFixed(1), cy: y(measures[name]).toFixed(1) };
    return draw("circle", { class: `person ${classOf(model, i)}`, r: 1.4, ...at });
  });
  const line = draw("polyline", { class: "trail" });
  const here = draw("circle", { class: "now", r: 3.6 });
  const said = make("dd", {});
  const average = at(model.average, model)[name];
  const element = make("div", { class: "measure" },
    make("dt", {}, capital(label)),
    said,
    make("dd", { class: "plot", "aria-hidden": "true" },
      draw("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}` }, ...dots, line, here)),
  );
  const show = (now: Now, stops: readonly Stop[]): void => {
    const value = now.measures[name];
    const more = make("small", {}, difference(value - average, digits));
    said.replaceChildren(make("b", {}, value.toFixed(digits)), ` ${unit}`, more);
    const curve = through(stops, now, axis).map(({ score, measures }) => [x(score), y(measures[name])]);
    put(line, { points: curve.map((point) => point.map((at) => at.toFixed(1)).join()).join(" ") });
    const [h, v] = [x(axis?.at(now.place) ?? 0), y(value)];
    const [heldH, heldV] = [inside(h, WIDTH), inside(v, HEIGHT)];
    put(here, { cx: heldH.toFixed(1), cy: heldV.toFixed(1) });
    here.classList.toggle("beyond", Math.hypot(h - heldH, v - heldV) > MARGIN);
  };
  return { element, show };
}

function difference(by: number, digits: number): string {
  const size = Math.abs(by).toFixed(digits);
  if (Number(size) === 0) return "average";
  return `${by < 0 ? "\u2212" : "+"}${size}`;
}
