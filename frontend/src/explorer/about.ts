/** What the page is about, and whose walks these are. */

import type { Model } from "../model/model";
import { make } from "../page/element";

const IDEA =
  "Fifteen points are enough to see who walks. Each walk here is a mean posture and four postures that " +
  "ride on sines; so walks can be added, averaged and pushed past the end.";
const SOURCES =
  "After Troje (2002), Decomposing biological motion, and Moler (2016), The eigenwalker model of the human gait.";

/** Where the report lies, if there is one: an address relative to the page. */
function reportLink(): HTMLElement[] {
  const said = document.querySelector('meta[name="eigenwalker-report"]')?.getAttribute("content") ?? "";
  if (!/^[\w.-]+(\/[\w.-]+)*$/.test(said)) return [];
  return [make("p", {}, make("a", { href: said }, "The report of this population"))];
}

/** One line: how many walkers, whether they exist, and out of what file. */
export function peopleIn({ n_walkers, simulated, source, captures }: Model): string {
  const people = `${n_walkers} ${simulated ? "simulated " : ""}${n_walkers === 1 ? "walker" : "walkers"}`;
  const from = captures ?? source;
  return from ? `${people} of ${from}` : people;
}

/** Walkers below this number say little about others. */
const FEW = 10;

/** What to mind of a population that is small, or of which nothing is known but how it walks. */
export function warnings({ n_walkers, traits }: Model): string[] {
  const few = `${n_walkers} walkers are few: sliders push what sets just these apart, and say little of others.`;
  const blank = "No trait tells these walkers apart, for want of a table of traits or of walkers: the large slider is what varies most among them.";
  return [...(n_walkers < FEW ? [few] : []), ...(traits.length === 0 ? [blank] : [])];
}

/** The ideas in four sentences, and where the model comes from. */
export function about(model: Model): HTMLElement {
  const facts = [
    ["walkers", String(model.n_walkers)],
    ...(model.n_flagged > 0 ? [["left out", `${model.n_flagged}, doubtful captures`]] : []),
    ...Object.entries(model.provenance).filter(([name]) => name !== "recipe"),
    ["program", model.program],
  ] as const;
  return make("details", { class: "section" },
    make("summary", {}, make("h2", {}, "About")),
    make("div", { class: "body" },
      make("p", {}, IDEA),
      ...(model.simulated ? [make("p", {}, "The walkers here are simulated: nobody was captured.")] : []),
      ...warnings(model).map((sentence) => make("p", {}, sentence)),
      make("p", { class: "note" }, SOURCES),
      ...reportLink(),
      make("dl", { class: "facts" },
        ...facts.flatMap(([term, said]) => [make("dt", {}, term!), make("dd", {}, said!)])),
    ),
  );
}
