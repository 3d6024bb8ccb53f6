/** What a stage shows, and whether it needs another act for something new. */

import type { Cast } from "../model/figures";
import type { Model } from "../model/model";
import { RANGES, within, wrappedDegrees, type State } from "../model/state";

/** Who is to be seen, and how. */
export interface Shown {
  readonly model: Model;
  readonly cast: readonly Cast[];
  readonly state: State;
}

/** What the act was made of, and when. */
export interface Built extends Shown {
  readonly time: number;
  readonly turned_deg: number;
}

/** Parts of the state that an act is made of, but for the view and who is seen. */
const ACTED = ["perspective", "turning_deg_s", "style", "trails", "dark", "scene", "tempo", "transforms"] as const;

export const sameAct = (one: Shown, other: Shown): boolean =>
  one.model === other.model &&
  one.cast === other.cast &&
  ACTED.every((part) => one.state[part] === other.state[part]);

/** From where it is seen. */
export type Seen = Pick<State, "azimuth_deg" | "elevation_deg">;

export const seenAlike = (one: Seen, other: Seen): boolean =>
  one.azimuth_deg === other.azimuth_deg && one.elevation_deg === other.elevation_deg;

export const seenFrom = (azimuth: number, elevation: number): Seen => ({
  azimuth_deg: wrappedDegrees(azimuth),
  elevation_deg: within(RANGES.elevation_deg, elevation),
});
