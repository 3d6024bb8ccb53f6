/** The page of an observer: welcome, consent, instructions, trials, and the end. */

import { refreshMeasured, screenRefresh } from "../canvas/showingLog";
import { button, find, make, messageOf } from "../page/elements";
import { checksum, itemOf, randomName, type Item } from "./answers";
import { Outbox } from "./outbox";
import { Pages } from "./pages";
import { TrialProgress } from "./progressOfTrials";
import { assumedOf, measureScreen, scaleOf, type ScreenSize } from "./screenSize";
import { askQuestions } from "./questions";
import { Sender } from "./sender";
import * as server from "./server";
import { Refusal, type Site } from "./server";
import type { SessionContent, Welcome } from "./session";
import { runTrials } from "./trials";

const RESCUE_AFTER_MS = 120_000;
const LINK = "eigenwalker-link";

const pages = new Pages({
  unknown_link: "This link is not known. Please ask the experimenter for a new one.",
  no_server: "The experiment cannot be reached right now. The page tries again by itself.",
  stopped_deleted: "Everything you gave was deleted.",
  other_tab: "The experiment is open in another tab of this browser. Please go on there, or close it and reload this page.",
});

/** The key of the link: of the address at first, then of this tab. */
function linkKey(): string | null {
  const found = /^\/s\/([A-Za-z0-9_-]+)$/.exec(location.pathname)?.[1] ?? null;
  try {
    if (found) sessionStorage.setItem(LINK, JSON.stringify({ key: found, site: siteParameters() }));
    return found ?? (JSON.parse(sessionStorage.getItem(LINK) ?? "null") as { key: string } | null)?.key ?? null;
  } catch {
    return found;
  }
}

function siteParameters(): Site {
  const all = [...new URLSearchParams(location.search)].slice(0, 10);
  if (all.length > 0) return Object.fromEntries(all);
  try {
    return (JSON.parse(sessionStorage.getItem(LINK) ?? "{}") as { site?: Site }).site ?? {};
  } catch {
    return {};
  }
}

/** Take the key out of the address bar, where a reload still finds it in this tab. */
function hideKey(): void {
  try {
    if (sessionStorage.getItem(LINK)) history.replaceState(null, "", "/");
  } catch {
    // without storage a reload needs the address
  }
}

/** Whether no other tab of this browser works on this link; the lock is held as long as the tab lives. */
function onlyTab(key: string): Promise<boolean> {
  if (!navigator.locks) return Promise.resolve(true);
  return new Promise((resolve) => {
    void navigator.locks.request(`eigenwalker ${key}`, { ifAvailable: true }, (lock) => {
      resolve(lock !== null);
      return lock ? new Promise(() => {}) : undefined;
    });
  });
}

async function main(): Promise<void> {
  const link = linkKey();
  const site = siteParameters();
  if (!link) return pages.show(pages.paragraph("unknown_link"));
  hideKey();
  const outbox = await Outbox.open();
  const own = await outbox.key(link);
  const waiting = (): void => pages.show(pages.paragraph("no_server"));
  const welcome = await server.persist(() => server.welcome(own ?? link, site), waiting);
  const language = languageOf(welcome);
  pages.texts = welcome.languages[language]!;
  document.title = pages.text("title");
  document.documentElement.lang = language;
  document.documentElement.dir = pages.text("direction");
  find("#mark", HTMLElement).textContent = pages.text("test_mark");
  find("#mark", HTMLElement).hidden = !welcome.test;
  if (!(await onlyTab(own ?? link))) return pages.show(pages.title(), pages.paragraph("other_tab"));
  if (!(await mayBegin(welcome))) return undefined;

  const key = own ?? (welcome.personal ? link : randomName());
  if (key !== link) await outbox.setKey(link, key);
  const asked = { consent: welcome.consent[language]!, language, own_key: key, site };
  const session = await server.persist(() => server.start(own ?? link, asked), waiting);
  await new Visit(outbox, key, session).run(welcome.state.name === "under_way");
}

function languageOf({ languages }: Welcome): string {
  const known = Object.keys(languages);
  const wanted = navigator.languages.map((each) => each.slice(0, 2).toLowerCase());
  return wanted.find((each) => known.includes(each)) ?? known[0]!;
}

/** Show why no session can begin, or ask for consent; a session under way goes on at a click. */
async function mayBegin({ state, phones }: Welcome): Promise<boolean> {
  if (state.name === "finished" || state.name === "closed") {
    pages.show(pages.title(), pages.paragraph(state.name));
    return false;
  }
  if (state.name === "not_due") {
    const time = new Date(state.due_utc!).toLocaleString(document.documentElement.lang);
    pages.show(pages.title(), pages.paragraph("not_due", { time }));
    return false;
  }
  if (!phones && Math.min(screen.width, screen.height) < 500) {
    pages.show(pages.title(), pages.paragraph("no_phone"));
    return false;
  }
  if (state.name === "under_way") {
    await pages.ask([pages.title(), pages.paragraphs("welcome_back")], [["go", "continue"]]);
    return true;
  }
  const content = [pages.title(), pages.paragraphs("consent"), pages.paragraphs("warning")];
  const answer = await pages.ask(content, [["agree", "agree"], ["decline", "decline"]]);
  if (answer === "decline") pages.show(pages.title(), pages.paragraph("declined"));
  return answer === "agree";
}

/** One visit of a page to a session. */
class Visit {
  private readonly sender: Sender;
  private stopped = false;
  /** Whether the lab was told that this page can store nothing. */
  private marked = false;

  constructor(
    private readonly outbox: Outbox,
    private readonly key: string,
    private readonly session: SessionContent,
  ) {
    this.sender = new Sender(outbox, key, session.session, () => void this.deleted());
  }

  async run(again: boolean): Promise<void> {
    // read before anything is sent: what is confirmed from now on is in neither list otherwise
    const kept = (await this.outbox.items(this.session.session)).map(({ item }) => ({
      ...item,
      outcome: (item.content["outcome"] as string | undefined) ?? null,
      response: item.content["response"],
      when: item.content["when"],
    }));
    this.sender.hurry();
    const stimuli = await this.load();
    const reported = [...this.session.answered, ...kept];
    const progress = new TrialProgress(this.session, reported);
    this.offerStop();
    const { screen: wanted } = this.session;
    const size = wanted.measure ? await this.measured() : assumedOf(wanted);
    await refreshMeasured;
    await this.keep(itemOf("screen", { ...screenFacts(this.outbox.durable), ...size }));
    if (!this.outbox.durable) await pages.ask([pages.title(), pages.paragraph("not_stored")], [["go", "continue"]]);
    await this.ask("before", reported);
    if (!again || !progress.anyBegun || this.awayMinutes() > this.session.pace.refresh_after_min) {
      const limit = this.session.blocks[0]?.limit_s ?? 0;
      await pages.ask([pages.title(), pages.paragraphs("instructions", { limit })], [["begin", "begin"]]);
    }
    if (wanted.full_screen) await document.documentElement.requestFullscreen?.().catch(() => undefined);
    await runTrials({
      session: this.session,
      stimuli,
      progress,
      pages,
      scale: scaleOf(size, wanted),
      keep: (item) => this.keep(item),
      stopped: () => this.stopped,
    });
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => undefined);
    if (!this.stopped) await this.ask("after", reported);
    if (!this.stopped) await this.finish("finished");
  }

  /** The size of this screen, measured once a session and screen. */
  private async measured(): Promise<ScreenSize> {
    const name = `${this.session.session} ${screen.width} ${screen.height} ${window.devicePixelRatio}`;
    const known = await this.outbox.key(name);
    if (known) return JSON.parse(known) as ScreenSize;
    const size = await measureScreen(pages, this.session.screen);
    await this.outbox.setKey(name, JSON.stringify(size));
    return size;
  }

  /** Ask the questions before or after the trials, once a session. */
  private async ask(when: "before" | "after", reported: readonly { kind: string; when?: unknown }[]): Promise<void> {
    const questions = this.session.questions.filter((each) => each.when === when);
    const known = reported.some((item) => item.kind === "questions" && item.when === when);
    if (questions.length === 0 || known) return;
    await this.keep(itemOf("questions", { when, answers: await askQuestions(pages, questions) }));
  }

  /** Keep an item: on disk here, or else at the server, before the promise is kept. */
  private async keep(item: Item): Promise<void> {
    if (this.stopped) return; // the trial that was on the screen then
    await this.outbox.put(item, this.key, this.session.session);
    this.sender.hurry();
    if (this.outbox.durable) return;
    if (!this.marked) {
      this.marked = true;
      await this.outbox.put(itemOf("event", { event: "not stored" }), this.key, this.session.session);
    }
    await this.sender.drain();
  }

  private async load(): Promise<Awaited<ReturnType<typeof server.stimuli>>> {
    pages.show(pages.title(), pages.paragraph("loading"), make("progress", { "aria-label": pages.text("loading") }));
    return server.persist(() => server.stimuli(this.key, this.session.session));
  }

  private awayMinutes(): number {
    const last = this.session.answered.at(-1)?.at;
    return last ? (Date.now() - Date.parse(last)) / 60_000 : 0;
  }

  private offerStop(): void {
    find("header", HTMLElement).hidden = false;
    const stop = find("#stop", HTMLButtonElement);
    stop.textContent = pages.text("stop");
    stop.onclick = () => find("dialog", HTMLDialogElement).showModal();
    const close = (then: () => void) => () => {
      dialog.close();
      then();
    };
    const dialog = make(
      "dialog",
      { "aria-label": pages.text("stop") },
      pages.paragraph("stop_question"),
      make(
        "div",
        { class: "buttons" },
        button(pages.text("stop_cancel"), close(() => {}), { autofocus: true }),
        button(pages.text("stop_keep"), close(() => void this.stop("stopped"))),
        button(pages.text("stop_delete"), close(() => void this.stop("deleted"))),
      ),
    );
    document.body.append(dialog);
  }

  private async stop(how: "stopped" | "deleted"): Promise<void> {
    this.stopped = true;
    if (how === "stopped") return this.finish(how);
    this.sender.stop();
    pages.show(pages.title(), pages.paragraph("loading"));
    await server
      .persist(() => server.end(this.key, this.session.session, "deleted"), () => pages.show(pages.title(), pages.paragraph("no_server")))
      .catch((error: unknown) => {
        if (!(error instanceof Refusal && error.status === 410)) throw error;
      });
    return this.deleted();
  }

  private async deleted(): Promise<void> {
    this.stopped = true;
    find("header", HTMLElement).hidden = true;
    await this.outbox.clear();
    pages.show(pages.title(), pages.paragraph("stopped_deleted"));
  }

  /** Wait until all is confirmed, then end the session, and leave nothing here. */
  private async finish(how: "finished" | "stopped"): Promise<void> {
    find("header", HTMLElement).hidden = true;
    const since = Date.now();
    const show = async (): Promise<void> => {
      const count = (await this.sender.unsent()).length;
      if (count === 0) return;
      const late = Date.now() - since > RESCUE_AFTER_MS;
      const save = late ? [pages.paragraph("offline"), button(pages.text("save_file"), () => void this.saveFile())] : [];
      pages.show(pages.title(), pages.paragraph("sending", { count }), ...save);
    };
    await show();
    const shown = setInterval(() => void show(), 2000);
    await this.sender.drain();
    clearInterval(shown);
    const end = await server.persist(() => server.end(this.key, this.session.session, how));
    const refused = (await this.outbox.items(this.session.session)).length;
    if (refused === 0) await this.outbox.clear();
    const parts = [how === "finished" ? pages.paragraph("done") : pages.paragraph("stopped_kept")];
    if (how === "finished") parts.push(pages.paragraphs("debriefing"));
    if (end.completion_code) parts.push(pages.paragraph("completion", { code: end.completion_code }));
    if (end.return_url?.startsWith("https://")) {
      parts.push(make("p", {}, make("a", { href: end.return_url }, pages.text("return"))));
    }
    if (end.withdrawal_code) parts.push(pages.paragraph("withdraw", { code: end.withdrawal_code }));
    pages.show(pages.title(), ...parts);
  }

  /** Offer the unsent items as a file for `experiment rescue`. */
  private async saveFile(): Promise<void> {
    const { session, proof } = this.session;
    const items = (await this.outbox.items(session)).map(({ item }) => {
      const text = JSON.stringify(item);
      return { text, check: checksum(proof + text) };
    });
    const text = JSON.stringify({ format: "eigenwalker rescue", version: 1, session, proof, items });
    const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "application/json" })), download: "answers.json" });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }
}

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

main().catch((error: unknown) => {
  const name = error instanceof Refusal ? ({ 403: "unknown_link", 410: "stopped_deleted" }[error.status] ?? error.detail) : "";
  pages.show(make("p", { role: "alert" }, name in pages.texts ? pages.text(name) : messageOf(error)));
});
