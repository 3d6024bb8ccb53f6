/** All controls and plots beside the stage, in their places. */

import { about } from "./about";
import { changes } from "./measurePlots";
import { classifier } from "./classifierControls";
import { cloud } from "./cloud";
import { find } from "../page/element";
import { look, transforms } from "./viewControls";
import { bias, strengths } from "./componentControls";
import type { Notices } from "./notices";
import { plausible } from "./plausibility";
import { scenes } from "./sceneSelect";
import { section, words, type Fold } from "./section";
import type { Session, Shown } from "./store";
import { share } from "./share";
import { eigenwalkerSliders, otherTraits } from "./traitSliders";
import { who } from "./walkerSelect";

/** There is room for a panel on the left as well, and for more that is unfolded. */
const WIDE = window.matchMedia("(min-width: 100rem)");

/** `open` lets the visitor choose files. */
export function panels(session: Session, notices: Notices, open: () => void): Shown {
  const plots = plotsOf(session);
  const controls = controlsOf(session, notices, open);
  const said = about(session.model);
  const place = (): void => {
    const left = find("#insight", HTMLElement);
    const [first, ...others] = controls.map(({ element }) => element);
    const shown = plots.map(({ element }) => element);
    left.hidden = !WIDE.matches;
    left.replaceChildren(...(WIDE.matches ? shown : []));
    find("#panel", HTMLElement).replaceChildren(first!, ...(WIDE.matches ? [] : shown), ...others, said);
  };
  place();
  WIDE.addEventListener("change", place);
  return {
    show: (now) => [...plots, ...controls].forEach((fold) => fold.show(now)),
    leave: () => WIDE.removeEventListener("change", place),
  };
}

/** On the left where there is room, else after the first of the controls. */
const plotsOf = (session: Session): Fold[] => [
  section("What changes", [plausible(session), changes(session)], true),
  section("Among the others", [cloud(session)], WIDE.matches),
];

function controlsOf(session: Session, notices: Notices, open: () => void): Fold[] {
  const { traits } = session.model;
  const some = (wanted: boolean, ...folds: Fold[]): Fold[] => (wanted ? folds : []);
  const varies = words("What varies most from walker to walker, whatever it means.");
  return [
    ...some(traits.length > 1, section("More traits", [otherTraits(session)], true)),
    section("Who walks", [who(session, open)], WIDE.matches),
    section("Several at once", [scenes(session)], WIDE.matches),
    ...some(traits.length > 0, section("Body or motion", [classifier(session)], WIDE.matches)),
    section("Stride, sway, hop, bounce", [strengths(session), bias(session)]),
    section("Eigenwalkers", [varies, eigenwalkerSliders(session)]),
    section("Look", [look(session), transforms(session)]),
    section("Keep and share", [share(session, notices)]),
  ];
}
