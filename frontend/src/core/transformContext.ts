/** What a transform may know beside its figure. */

import type { Axes } from "./vector";

export interface Stage {
  /** The observer's axes in the figure's own frame. */
  readonly observer: Axes;
  /** Number of the figure, from 0: figures of one scene draw different random numbers. */
  readonly figure: number;
}
