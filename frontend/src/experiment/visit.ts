/** One visit of an observer's page to a session: what is before the trials, the trials, and what is after them. */

import { refreshMeasured, screenRefresh } from "../canvas/showingLog";
import { make } from "../page/elements";
import { itemOf, type Item } from "./answers";
import { LastPage } from "./lastPage";
import type { Place } from "./place";
import { TrialProgress } from "./progressOfTrials";
import { askQuestions } from "./questions";
import { assumedOf, measureScreen, scaleOf, type ScreenSize } from "./screenSize";
import { enterFullScreen, ScreenWatch } from "./screenWatch";
import { Sender, sendLeft } from "./sender";
import * as server from "./server";
import { Refusal } from "./server";
import type { Reported, SessionContent } from "./session";
import { StopControl } from "./stopControl";
import { runTrials } from "./trials";

const SLOW_MS = 1500;

export class Visit {
  private readonly sender: Sender;
  private readonly stopping: StopControl;
  private readonly watch: ScreenWatch;
  private stopped = false;
  /** Whether the lab was told that this page can store nothing. */
  private marked = false;
  private size: ScreenSize;

  constructor(
    private readonly place: Place,
    private readonly session: SessionContent,
  ) {
    const { pages, outbox, key } = place;
    this.sender = new Sender(outbox, key, session.session, () => void this.deleted());
    this.stopping = new StopControl(pages, (how) => void this.stop(how));
    const { screen } = session;
    this.size = assumedOf(screen);
    this.watch = new ScreenWatch(pages, (item) => this.keep(item), screen.measure ? () => this.measure() : null);
  }

  async run({ again, wantsStop }: { again: boolean; wantsStop: boolean }): Promise<void> {
    const { pages, outbox, key } = this.place;
    const { screen, pace, blocks } = this.session;
    // read before anything is sent: what is confirmed from now on is in neither list otherwise
    const kept = outbox.items(key, this.session.session).map(({ item }) => asReported(item));
    this.sender.hurry();
    void sendLeft(outbox, key, this.session.session);
    if (wantsStop) {
      pages.show(pages.title(), pages.paragraphs("welcome_back"));
      this.stopping.open();
      await this.stopping.answered;
      if (this.stopped) return;
    }
    const stimuli = await this.load();
    if (this.stopped) return;
    const reported = [...this.session.answered, ...kept];
    const progress = new TrialProgress(this.session, reported);
    if (screen.measure) this.size = (await this.knownSize()) ?? (await this.measured());
    await this.keepSize();
    if (!outbox.durable) await pages.ask([pages.title(), pages.paragraph("not_stored")], [["go", "continue"]]);
    await this.ask("before", reported);
    const wasLongAway = this.awayMinutes() > pace.refresh_after_min;
    if (!again || !progress.anyBegun || wasLongAway) {
      if (wasLongAway) progress.practiseAgain();
      const limit = blocks[0]?.limit_s ?? 0;
      await pages.ask([pages.title(), pages.paragraphs("instructions", { limit })], [["begin", "begin"]]);
    }
    if (screen.full_screen && progress.next() && !this.stopped) await this.fullScreen();
    this.watch.accept();
    await runTrials({
      session: this.session,
      stimuli,
      progress,
      pages,
      scale: () => scaleOf(this.size, screen),
      watch: this.watch,
      stopping: this.stopping,
      keep: (item) => this.keep(item),
      stopped: () => this.stopped,
    });
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => undefined);
    if (!this.stopped) await this.ask("after", reported);
    if (!this.stopped) await this.finish("finished");
  }

  private async load(): Promise<Awaited<ReturnType<typeof server.stimuli>>> {
    const { pages, key } = this.place;
    const bar = make("progress", { "aria-label": pages.text("loading"), max: 1, value: 0 });
    pages.show(pages.title(), pages.paragraph("loading"), bar);
    const note = make("p", { role: "status" });
    bar.after(note);
    return server.persist(
      () => server.stimuli(key, this.session.session, (share) => void (bar.value = share)),
      () => void (note.textContent = pages.text("no_server")),
    );
  }

  // ------------------------------------------------------------------------------------ the screen

  /** The size of this screen, as it was measured in an earlier visit of the session. */
  private async knownSize(): Promise<ScreenSize | null> {
    const known = await this.place.outbox.note(this.place.link, screenName());
    return known ? (JSON.parse(known) as ScreenSize) : null;
  }

  private async measured(): Promise<ScreenSize> {
    const { pages, outbox, link } = this.place;
    const size = await measureScreen(pages, this.session.screen);
    await outbox.setNote(link, screenName(), JSON.stringify(size));
    return size;
  }

  private async measure(): Promise<void> {
    this.size = await this.measured();
    await this.keepSize();
  }

  private async keepSize(): Promise<void> {
    await refreshMeasured;
    await this.keep(itemOf("screen", { ...screenFacts(this.place.outbox.durable), ...this.size }));
  }

  private async fullScreen(): Promise<void> {
    const { pages } = this.place;
    await enterFullScreen();
    if (document.fullscreenElement || !document.fullscreenEnabled) return;
    await pages.ask([pages.title(), pages.paragraph("full_screen")], [["continue", "continue"]]);
    await enterFullScreen(); // browsers want a click before it
  }

  // ------------------------------------------------------------------------------ questions, items

  /** Ask the questions before or after the trials, once a session. */
  private async ask(when: "before" | "after", reported: readonly Reported[]): Promise<void> {
    const questions = this.session.questions.filter((each) => each.when === when);
    const known = reported.some((item) => item.kind === "questions" && item.when === when);
    if (questions.length === 0 || known || this.stopped) return;
    await this.keep(itemOf("questions", { when, answers: await askQuestions(this.place.pages, questions) }));
  }

  /** Keep an item: on disk here, or else at the server, before the promise is kept. */
  private async keep(item: Item): Promise<void> {
    if (this.stopped) return; // the trial that was on the screen then
    const { pages, outbox, key } = this.place;
    await outbox.put(item, key, this.session.session);
    if (outbox.durable) return this.sender.offer();
    if (!this.marked) {
      this.marked = true;
      await outbox.put(itemOf("event", { event: "not stored" }), key, this.session.session);
    }
    const slow = setTimeout(() => pages.say(pages.text("no_server")), SLOW_MS);
    await this.sender.drain();
    clearTimeout(slow);
    pages.say("");
  }

  private awayMinutes(): number {
    const last = this.session.answered.at(-1)?.at;
    return last ? (server.serverTimeMs() - Date.parse(last)) / 60_000 : 0;
  }

  // --------------------------------------------------------------------------------------- the end

  private async stop(how: "stopped" | "deleted"): Promise<void> {
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => undefined);
    const { pages, key } = this.place;
    this.stopped = true;
    if (how === "stopped") return this.finish(how);
    this.sender.stop();
    const waiting = make("p", { role: "status" }, pages.text("deleting"));
    pages.show(pages.title(), waiting);
    await server
      .persist(() => server.end(key, this.session.session, "deleted"), () => void (waiting.textContent = pages.text("no_server")))
      .catch((error: unknown) => {
        if (!(error instanceof Refusal && error.status === 410)) throw error;
      });
    return this.deleted();
  }

  private async deleted(): Promise<void> {
    const { pages, outbox, link, key } = this.place;
    this.stopped = true;
    this.stopping.remove();
    await outbox.clear(link, key);
    pages.show(pages.title(), pages.paragraph("stopped_deleted"));
  }

  private finish(how: "finished" | "stopped"): Promise<void> {
    this.stopping.remove();
    return new LastPage(this.place, this.session, this.sender).finish(how);
  }
}

const asReported = ({ kind, trial, attempt, content }: Item): Reported => ({
  kind,
  trial,
  attempt,
  outcome: (content["outcome"] as string | undefined) ?? null,
  response: content["response"],
  when: content["when"],
});

/** A size that was measured holds for one screen and zoom. */
const screenName = (): string => `screen ${screen.width} ${screen.height} ${window.devicePixelRatio}`;

const screenFacts = (durable: boolean): Record<string, unknown> => ({
  width_px: screen.width,
  height_px: screen.height,
  window_px: [window.innerWidth, window.innerHeight],
  pixel_ratio: window.devicePixelRatio,
  touch: matchMedia("(pointer: coarse)").matches,
  clock_isolated: window.crossOriginIsolated,
  refresh_hz: Math.round(1e6 / screenRefresh.intervalMs) / 1000,
  stored: durable,
  language: navigator.language,
  browser: navigator.userAgent,
});
