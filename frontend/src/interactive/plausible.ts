/** How far from anyone the walker is: in a sentence and on a bar. */

import type { Model, Numbers } from "../model/model";
import { positionsInCloud, type Place } from "../model/place";
import { make } from "./element";
import type { Part, Session } from "./session";
import { ends } from "./words";

/** Right end of the bar: so many times as far as the farthest of all. */
const FARTHEST = 4;
/** As far as the farthest, whose numbers the page has rounded. */
const ALL = 1.005;
/** What ends a sentence, up to so many times as far as the farthest of all. */
const RARE = 1.5;
const CARICATURE = 3;

/** Nobody goes that way, so nobody can be said to go too far. */
const LEAST = 0.1;

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
export function reachOf(model: Model): Reach {
  const both = (names: readonly [string, string], known: Numbers, at: (place: Place) => number): Way[] => [
    { name: names[0], farthest: Math.max(...known.map((sd) => -sd)), at: (place) => -at(place) },
    { name: names[1], farthest: Math.max(...known), at },
  ];
  const ways = [
    ...model.traits.flatMap((trait) => {
      const [low, high] = ends(trait);
      const known = positionsInCloud(model, trait);
      return both([`towards ${low}`, `towards ${high}`], known, ({ positions }) => positions[trait.name]!);
    }),
    ...model.eigenwalkers.flatMap((_, i) => {
      const name = `along eigenwalker ${i + 1}`;
      return both([name, name], model.cloud.scores.map((scores) => scores[i]!), ({ scores }) => scores[i]!);
    }),
  ];
  return {
    distance: Math.max(...model.spread.distances),
    ways: ways.filter(({ farthest }) => farthest > LEAST),
  };
}

/** How many times as far as the farthest of all a walker is, and on which way most. */
function extreme({ distance, ways }: Reach, place: Place): { times: number; way: Way | null } {
  const whole = { times: place.distance / distance, way: null as Way | null };
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
  const reach = reachOf(session.model);
  const bar = make("div", { class: "far", "aria-hidden": "true" }, make("i"));
  bar.style.setProperty("--real", `${100 / FARTHEST}%`);
  const words = make("p", { class: "verdict" });
  return {
    element: make("div", { class: "plausible" }, words, bar),
    show({ place, state }) {
      words.textContent = howPlausible(reach, place, state.from === "own");
      const { times } = extreme(reach, place);
      bar.style.setProperty("--now", `${Math.min(times / FARTHEST, 1) * 100}%`);
    },
  };
}
