/** About the page, and about the population. */

import type { Model } from "../model/model";
import { make } from "../page/elements";
import { note, section } from "./parts";

const IDEA =
  "Fifteen points are enough to see who walks. Each walk here is a mean posture and four postures that " +
  "ride on sines; so walks can be added, averaged and pushed past the end.";
const SOURCES =
  "After Troje (2002), Decomposing biological motion, and Moler (2016), The eigenwalker model of the human gait.";
/** Populations below this number are small. */
const FEW = 10;

/** A link to the report, if the page names its relative address. */
function reportLink(): HTMLElement[] {
  const href = document.querySelector('meta[name="eigenwalker-report"]')?.getAttribute("content") ?? "";
  if (!/^[\w.-]+(\/[\w.-]+)*$/.test(href)) return [];
  return [make("p", {}, make("a", { href }, "The report of this population"))];
}

/** One line: the number of walkers, whether they are simulated, and their file. */
export function populationLabel({ n_walkers, simulated, source, captures }: Model): string {
  const people = `${n_walkers} ${simulated ? "simulated " : ""}${n_walkers === 1 ? "walker" : "walkers"}`;
  const from = captures ?? source;
  return from ? `${people} of ${from}` : people;
}

/** Warnings about a population that is small, or that has no traits. */
export function warnings({ n_walkers, traits }: Model): string[] {
  const few = `${n_walkers} walkers are few: sliders push what sets just these apart, and say little of others.`;
  const blank = "No trait tells these walkers apart, for want of a table of traits or of walkers: the large slider is what varies most among them.";
  return [...(n_walkers < FEW ? [few] : []), ...(traits.length === 0 ? [blank] : [])];
}

export function about(model: Model): HTMLElement {
  const facts = [
    ["walkers", String(model.n_walkers)],
    ...(model.n_flagged > 0 ? [["left out", `${model.n_flagged}, doubtful captures`]] : []),
    ...Object.entries(model.provenance).filter(([name]) => name !== "recipe"),
    ["program", model.program],
  ] as const;
  const idea = [IDEA, ...(model.simulated ? ["The walkers here are simulated: nobody was captured."] : []), ...warnings(model)];
  return section("About", [
    ...idea.map((text) => make("p", {}, text)),
    note(SOURCES),
    ...reportLink(),
    make("dl", { class: "facts" }, ...facts.flatMap(([term, fact]) => [make("dt", {}, term!), make("dd", {}, fact!)])),
  ]).element;
}
