/** The address of the page follows the state, and the state follows an address. */

import { addressOf, stateOf } from "../model/address";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import type { View } from "./store";

/** The address changes after a pause of this length. */
const PAUSE_MS = 250;

/** The state in an address; paused for visitors who prefer reduced motion. */
export function stateAt(address: string, model: Model): State {
  const state = stateOf(address, model);
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  return { ...state, playing: state.playing && !calm };
}

export function addressBar(): View {
  let timer = 0;
  return {
    show({ state, model }) {
      clearTimeout(timer);
      timer = window.setTimeout(() => {
        const address = addressOf(state, model);
        history.replaceState(null, "", address ? `#${address}` : location.pathname + location.search);
      }, PAUSE_MS);
    },
    remove: () => clearTimeout(timer),
  };
}
