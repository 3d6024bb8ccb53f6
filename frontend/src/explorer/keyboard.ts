/** Keys that work anywhere on the page, and those of the stage. */

import { RANGES, within, wrappedDegrees } from "../model/state";
import type { Session } from "./store";

/** Degrees for one press of an arrow. */
const TURN = 5;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [TURN, 0],
  ArrowRight: [-TURN, 0],
  ArrowUp: [0, TURN],
  ArrowDown: [0, -TURN],
};
/** What takes the space bar for itself. */
const TAKES_SPACE = "button, select, summary, textarea, a, [role=listbox], input:not([type=range])";

/** Space lets it walk or stand; Ctrl+Z goes a step back. */
export function pageKeys(session: Session): (event: KeyboardEvent) => void {
  return (event) => {
    if (event.defaultPrevented || !(event.target instanceof Element)) return;
    const undoes = (event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "z";
    if (undoes) session.undo();
    else if (event.key !== " " || event.target.closest(TAKES_SPACE)) return;
    else session.play(!session.state.playing);
    event.preventDefault();
  };
}

/** Arrows turn what has the focus; Home is the front. */
export function stageKeys(session: Session): (event: KeyboardEvent) => void {
  return (event) => {
    const { azimuth_deg, elevation_deg } = session.state;
    const arrow = ARROWS[event.key];
    if (arrow) {
      session.change({
        azimuth_deg: wrappedDegrees(azimuth_deg + arrow[0]),
        elevation_deg: within(RANGES.elevation_deg, elevation_deg + arrow[1]),
      });
    } else if (event.key === "Home") session.change({ azimuth_deg: 0, elevation_deg: 0 });
    else return;
    event.preventDefault();
  };
}
