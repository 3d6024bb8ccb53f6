/** Where a visit takes place: the page, this machine's outbox, and the observer's keys. */

import type { Outbox } from "./outbox";
import type { Pages } from "./pages";

export interface Place {
  readonly pages: Pages;
  readonly outbox: Outbox;
  /** The key in the address, and that of the observer, which are the same for personal links. */
  readonly link: string;
  readonly key: string;
}
