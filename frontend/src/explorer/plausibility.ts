/** The plausibility of the walker: how far it is from the people, as a sentence and as a bar. */

import type { Model } from "../model/model";
import type { Position } from "../model/features";
import { make } from "../page/elements";
import type { Axis } from "./axis";
import type { Part, Store } from "./store";

/** Right end of the bar, in distances of the farthest walker. */
const BAR_END = 4;
/** A tolerance for the rounded numbers of the farthest walker. */
const FARTHEST = 1.005;
/** Limits of the sentences, in distances of the farthest walker. */
const RARE = 1.5;
const CARICATURE = 3;
/** Directions in which the population reaches less far than this are ignored. */
const MIN_REACH_SD = 0.1;

const SEVERAL = "Several walk: numbers are shown where one walks alone.";

/** How far a population reaches in each direction. */
export interface Reach {
  readonly distance: number;
  readonly directions: readonly Direction[];
}

/** Towards an end of a trait, or along an eigenwalker. */
interface Direction {
  readonly name: string;
  readonly farthest: number;
  at(position: Position): number;
}

export function reachOf(model: Model, axes: readonly Axis[]): Reach {
  const directions = axes.flatMap(({ label, ends, trait, points, at }) =>
    [-1, 1].map((sign, i): Direction => ({
      name: trait ? `towards ${ends[i]}` : `along ${label.toLowerCase()}`,
      farthest: Math.max(...points.map((sd) => sign * sd)),
      at: (position) => sign * at(position),
    })),
  );
  return {
    distance: Math.max(...model.spread.distances),
    directions: directions.filter(({ farthest }) => farthest > MIN_REACH_SD),
  };
}

/** The distance of a walker relative to the farthest of all, in the direction where that is greatest. */
function extreme({ distance, directions }: Reach, position: Position): { times: number; direction: Direction | null } {
  const whole = { times: distance > 0 ? position.distance / distance : 0, direction: null as Direction | null };
  return directions.reduce((most, direction) => {
    const times = direction.at(position) / direction.farthest;
    return times > Math.max(most.times, FARTHEST) ? { times, direction } : most;
  }, whole);
}

/** A sentence about the plausibility of a walker; a visitor's own walk is never called a caricature. */
export function plausibilityText(reach: Reach, position: Position, own = false): string {
  const { times, direction } = extreme(reach, position);
  if (times <= FARTHEST) {
    if (position.distance < 0.05) return "Nobody and everybody: the average walker.";
    if (position.percentile < 1) return "Plausible: nearer to the average than anyone.";
    return `Plausible: ${Math.round(position.percentile)} % of the walkers are nearer to the average.`;
  }
  const far = direction
    ? `${direction.at(position).toFixed(1)} SD ${direction.name}; the farthest walker is at ${direction.farthest.toFixed(1)}`
    : `${times.toFixed(1)} times as far from the average as the farthest walker`;
  if (own) return `Unlike anyone here: ${far}.`;
  if (times < RARE) return `Rare: ${far}.`;
  return times < CARICATURE ? `A caricature: ${far}.` : `Nobody walks so: ${far}.`;
}

export function plausibility(store: Store): Part {
  const reach = reachOf(store.model, store.axes);
  const bar = make("div", { class: "far", "aria-hidden": "true" }, make("i"));
  bar.style.setProperty("--real", `${100 / BAR_END}%`);
  const text = make("p", { class: "verdict" });
  return {
    element: make("div", { class: "plausible" }, text, bar),
    show({ position, state }) {
      bar.hidden = state.scene !== "one";
      text.textContent = bar.hidden ? SEVERAL : plausibilityText(reach, position, state.from === "own");
      const { times } = extreme(reach, position);
      bar.style.setProperty("--now", `${Math.min(times / BAR_END, 1) * 100}%`);
    },
  };
}
