/** All plots and controls beside the viewer, and the text about the population. */

import { warnings } from "../model/labels";
import type { Model } from "../model/model";
import { find, make } from "../page/elements";
import { cloud } from "./cloud";
import { measurePlots } from "./measurePlots";
import type { Notices } from "./notices";
import { note, section } from "./parts";
import { plausibility } from "./plausibility";
import { share } from "./share";
import type { Part, Store, View } from "./store";
import { biasControls, classifierControls, eigenwalkerSliders, otherTraits, strengthControls } from "./traitSliders";
import { transformControls, viewControls } from "./viewControls";
import { sceneSelect, walkerSelect } from "./walkerSelect";

/** Wide windows have a panel on the left as well, and more sections open. */
const WIDE = window.matchMedia("(min-width: 100rem)");

/** `open` lets the visitor choose files. */
export function panels(store: Store, notices: Notices, open: () => void): View {
  const plots = plotSections(store);
  const controls = controlSections(store, notices, open);
  const last = about(store.model);
  const place = (): void => {
    const left = find("#insight", HTMLElement);
    const [first, ...others] = controls.map(({ element }) => element);
    const shown = plots.map(({ element }) => element);
    left.hidden = !WIDE.matches;
    left.replaceChildren(...(WIDE.matches ? shown : []));
    find("#panel", HTMLElement).replaceChildren(first!, ...(WIDE.matches ? [] : shown), ...others, last);
  };
  place();
  WIDE.addEventListener("change", place);
  return {
    show: (now) => [...plots, ...controls].forEach((each) => each.show(now)),
    remove: () => WIDE.removeEventListener("change", place),
  };
}

/** On the left of wide windows, else after the first section of controls. */
const plotSections = (store: Store): Part[] => [
  section("What changes", [plausibility(store), measurePlots(store)], true),
  section("Among the others", [cloud(store)], WIDE.matches),
];

function controlSections(store: Store, notices: Notices, open: () => void): Part[] {
  const { length } = store.model.traits;
  const varies = note("What varies most from walker to walker, whatever it means.");
  return [
    ...(length > 1 ? [section("More traits", [otherTraits(store)], true)] : []),
    section("Who walks", [walkerSelect(store, open)], WIDE.matches),
    section("Several at once", [sceneSelect(store)], WIDE.matches),
    ...(length > 0 ? [section("Body or motion", [classifierControls(store)], WIDE.matches)] : []),
    section("Stride, sway, hop, bounce", [strengthControls(store), biasControls(store)]),
    section("Eigenwalkers", [varies, eigenwalkerSliders(store)]),
    section("Look", [viewControls(store), transformControls(store)]),
    section("Keep and share", [share(store, notices)]),
  ];
}

const IDEA =
  "Fifteen points are enough to see who walks. Each walk here is a mean posture and four postures that " +
  "ride on sines; so walks can be added, averaged and pushed past the end.";
const SOURCES =
  "After Troje (2002), Decomposing biological motion, and Moler (2016), The eigenwalker model of the human gait.";

/** A link to the report, if the page names its relative address. */
function reportLink(): HTMLElement[] {
  const href = document.querySelector('meta[name="eigenwalker-report"]')?.getAttribute("content") ?? "";
  if (!/^[\w.-]+(\/[\w.-]+)*$/.test(href)) return [];
  return [make("p", {}, make("a", { href }, "The report of this population"))];
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
