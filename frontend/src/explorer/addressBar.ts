/** The address of the page tells what is shown, and what an address tells is shown. */

import { addressOf, stateOf } from "../model/address";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import type { Shown } from "./store";

/** The address follows after so long a rest. */
const REST_MS = 250;

/** What an address tells; who asked for little motion gets a walker that stands. */
export function stateAt(address: string, model: Model): State {
  const state = stateOf(address, model);
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  return { ...state, playing: state.playing && !calm };
}

/** Writes the address, a moment later. */
export function address(): Shown {
  let timer = 0;
  return {
    show({ state, model }) {
      clearTimeout(timer);
      timer = window.setTimeout(() => {
        const said = addressOf(state, model);
        history.replaceState(null, "", said ? `#${said}` : location.pathname + location.search);
      }, REST_MS);
    },
    leave: () => clearTimeout(timer),
  };
}
