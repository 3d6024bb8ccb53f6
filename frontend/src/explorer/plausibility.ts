/** How far from anyone the walker is: in a sentence and on a bar. */

import type { Model } from "../model/model";
import type { Place } from "../model/position";
import type { Axis } from "./axis";
import { make } from "../page/element";
import type { Part, Session } from "./store";

/** Right end of the bar: so many times as far as the farthest of all. */
const FARTHEST = 4;
/** As far as the farthest, whose numbers the page has rounded. */
const ALL = 1.005;
/** What ends a sentence, up to so many times as far as the farthest of all. */
const RARE = 1.5;
const CARICATURE = 3;

/** Nobody goes that way, so nobody can be said to go too far. */
const LEAST = 0.1;

/** Numbers are of one walker. */
const SEVERAL = "Several walk: numbers are shown where one walks alone.";

/** How far the walkers of a population go, each way. */
export interface Reach {
  readonly distance: number;
  readonly ways: readonly Way[];
}

/** One way out of the population: towards an end of a trait, or along an eigenwalker. */
interface Way {
  readonly name: string;
  readonly farthest: number;
  at(place: Place): number;
}

/** Where the farthest of a population are. */
export function reachOf(model: Model, axes: readonly Axis[]): Reach {
  const ways = axes.flatMap(({ label, ends, trait, points, at }): Way[] => {
    const names = trait ? ends.map((end) => `towards ${end}`) : [0, 1].map(() => `along ${label.toLowerCase()}`);
    return [
      { name: names[0]!, farthest: Math.max(...points.map((sd) => -sd)), at: (place) => -at(place) },
      { name: names[1]!, farthest: Math.max(...points), at },
    ];
  });
  return {
    distance: Math.max(...model.spread.distances),
    ways: ways.filter(({ farthest }) => farthest > LEAST),
  };
}

/** How many times as far as the farthest of all a walker is, and on which way most. */
function extreme({ distance, ways }: Reach, place: Place): { times: number; way: Way | null } {
  const whole = { times: distance > 0 ? place.distance / distance : 0, way: null as Way | null };
  return ways.reduce((most, way) => {
    const times = way.at(place) / way.farthest;
    return times > Math.max(most.times, ALL) ? { times, way } : most;
  }, whole);
}

/** A sentence on how plausible it is that somebody walks like this; one's own walk is what it is. */
export function howPlausible(reach: Reach, place: Place, own = false): string {
  const { times, way } = extreme(reach, place);
  if (times <= ALL) {
    if (place.distance < 0.05) return "Nobody and everybody: the average walker.";
    if (place.percentile < 1) return "Plausible: nearer to the average than anyone.";
    return `Plausible: ${Math.round(place.percentile)} % of the walkers are nearer to the average.`;
  }
  const far = way
    ? `${way.at(place).toFixed(1)} SD ${way.name}; the farthest walker is at ${way.farthest.toFixed(1)}`
    : `${times.toFixed(1)} times as far from the average as the farthest walker`;
  if (own) return `Unlike anyone here: ${far}.`;
  if (times < RARE) return `Rare: ${far}.`;
  return times < CARICATURE ? `A caricature: ${far}.` : `Nobody walks so: ${far}.`;
}

export function plausible(session: Session): Part {
  const reach = reachOf(session.model, session.axes);
  const bar = make("div", { class: "far", "aria-hidden": "true" }, make("i"));
  bar.style.setProperty("--real", `${100 / FARTHEST}%`);
  const words = make("p", { class: "verdict" });
  return {
    element: make("div", { class: "plausible" }, words, bar),
    show({ place, state }) {
      bar.hidden = state.scene !== "one";
      words.textContent = bar.hidden ? SEVERAL : howPlausible(reach, place, state.from === "own");
      const { times } = extreme(reach, place);
      bar.style.setProperty("--now", `${Math.min(times / FARTHEST, 1) * 100}%`);
    },
  };
}
