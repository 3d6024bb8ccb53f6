/** All plots and controls beside the viewer. */

import { find } from "../page/elements";
import { about } from "./about";
import { classifierControls, eigenwalkerSliders, otherTraits } from "./traitSliders";
import { cloud } from "./cloud";
import { biasControls, strengthControls } from "./componentControls";
import { measurePlots } from "./measurePlots";
import type { Notices } from "./notices";
import { plausibility } from "./plausibility";
import { sceneSelect, walkerSelect } from "./walkerSelect";
import { note, section } from "./parts";
import { share } from "./share";
import type { Part, Store, View } from "./store";
import { transformControls, viewControls } from "./viewControls";

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
