/** Sends what is in the outbox, in order, and again until each item is confirmed or refused for good. */

import { itemOf } from "./answers";
import type { Kept, Outbox } from "./outbox";
import { Refusal, sendItems, type Outcome } from "./server";

/** So few that making a request takes no frame. */
const MAX_ITEMS = 25;
const LONGEST_WAIT_MS = 20_000;

export class Sender {
  private running: Promise<void> | null = null;
  private wake = (): void => {};
  private wait = 500;
  private ended = false;
  /** Whether the last request was answered. */
  reached = true;

  constructor(
    private readonly outbox: Outbox,
    private readonly key: string,
    private readonly session: number,
    private readonly onGone: () => void,
  ) {
    window.addEventListener("online", () => this.hurry());
  }

  /** Items that are neither confirmed nor refused. */
  unsent(): readonly Kept[] {
    return this.outbox.items(this.key, this.session).filter((kept) => kept.refused === null);
  }

  /** Send in the background whatever there is; where the server was not reached, when it is time to try again. */
  offer(): void {
    this.running ??= this.run().finally(() => (this.running = null));
  }

  /** Send now. */
  hurry(): void {
    this.wait = 500;
    this.wake();
    this.offer();
  }

  /** Send until nothing is left. */
  async drain(): Promise<void> {
    while (!this.ended && this.unsent().length > 0) {
      this.hurry();
      await this.running;
    }
  }

  stop(): void {
    this.ended = true;
    this.wake();
  }

  private async run(): Promise<void> {
    for (let items = this.unsent(); items.length > 0 && !this.ended; items = this.unsent()) {
      try {
        await this.send(items.slice(0, MAX_ITEMS));
        this.reached = true;
        this.wait = 500;
      } catch (error) {
        if (error instanceof Refusal && error.status === 410) {
          this.stop();
          this.onGone();
          return;
        }
        this.reached = false;
        const wait = error instanceof Refusal && error.retryAfterS ? 1000 * error.retryAfterS : this.wait;
        this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
        await new Promise<void>((resolve) => {
          this.wake = resolve;
          setTimeout(resolve, wait * (0.75 + 0.5 * Math.random()));
        });
      }
    }
  }

  /** Send items together; where the server takes them not so, in halves, down to the one it refuses. */
  private async send(items: readonly Kept[]): Promise<void> {
    let outcome: Outcome;
    try {
      outcome = await sendItems(this.key, this.session, items.map((kept) => kept.item));
    } catch (error) {
      if (!(error instanceof Refusal) || ![400, 413, 422].includes(error.status)) throw error;
      if (items.length > 1) {
        const half = Math.ceil(items.length / 2);
        await this.send(items.slice(0, half));
        await this.send(items.slice(half));
      } else {
        await this.setAside(items[0]!, `${error.status} ${error.detail}`);
      }
      return;
    }
    await this.outbox.remove(outcome.confirmed);
    for (const { answer, outcome: reason } of outcome.refused) {
      const kept = items.find((each) => each.item.answer === answer);
      if (kept) await this.setAside(kept, reason);
    }
  }

  /** Keep an item that is refused for good, tell the lab, and go on with those behind it. */
  private async setAside(kept: Kept, reason: string): Promise<void> {
    await this.outbox.setAside(kept, reason);
    const { answer, kind } = kept.item;
    if (kind !== "event") await this.outbox.put(itemOf("event", { event: "refused", answer, reason }), this.key, this.session);
  }
}

/** Try once to send what earlier observers, or sessions, left on this machine. */
export async function sendLeft(outbox: Outbox, key: string, session: number): Promise<void> {
  for (const left of outbox.others(key, session)) {
    for (let from = 0; from < left.length; from += MAX_ITEMS) {
      const some = left.slice(from, from + MAX_ITEMS);
      try {
        await outbox.remove((await sendItems(some[0]!.key, some[0]!.session, some.map(({ item }) => item))).confirmed);
      } catch (error) {
        const isGone = error instanceof Refusal && error.status === 410; // deleted as the observer asked
        if (isGone) await outbox.remove(left.map(({ item }) => item.answer));
        break;
      }
    }
  }
}
