/** The page of an observer: welcome, language, consent; then a visit to the session. */

import { find, make, messageOf } from "../page/elements";
import { randomName } from "./answers";
import { missingInBrowser } from "./browserCheck";
import { endContent } from "./lastPage";
import { isReloaded, linkOf, ownKeyOf, pageVersion, rememberOwnKey } from "./link";
import { Outbox } from "./outbox";
import { Pages } from "./pages";
import * as server from "./server";
import { Refusal } from "./server";
import type { Welcome } from "./session";
import { Visit } from "./visit";

/** Said where the texts of the experiment are not at hand. */
const pages = new Pages({
  unknown_link: "This link is not known. Please ask the experimenter for a new one.",
  no_server: "The experiment cannot be reached right now. The page tries again by itself.",
  stopped_deleted: "Everything you gave was deleted.",
  old_browser: "This browser cannot show the experiment: it lacks {missing}. Please open the link in a recent Firefox, Chrome, Edge or Safari.",
});

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
  const link = linkOf();
  if (!link) return pages.show(pages.paragraph("unknown_link"));
  const missing = missingInBrowser().join(", ");
  if (missing) return pages.show(pages.paragraph("old_browser", { missing }));
  const outbox = await Outbox.open();
  const own = (await outbox.note(link.key, "own key")) ?? ownKeyOf(link);
  const waiting = (): void => pages.show(pages.paragraph("no_server"));
  const welcome = await server.persist(() => server.welcome(own ?? link.key, link.site), waiting);
  const isOwn = own !== null && own !== link.key;
  if (pageVersion && welcome.page && welcome.page !== pageVersion && (isReloaded || isOwn)) {
    return location.replace(`/s/${own ?? link.key}`); // a session goes on with the page it began with
  }
  let language = languageOf(welcome);
  pages.speak(language, welcome.languages[language]!);
  find("#mark", HTMLElement).hidden = !welcome.test;
  if (!(await onlyTab(own ?? link.key))) return pages.show(pages.title(), pages.paragraph("other_tab"));
  const answer = await mayBegin(welcome, () => language, (chosen) => {
    language = chosen;
    pages.speak(language, welcome.languages[language]!);
  });
  if (answer === "no") return undefined;

  const key = own ?? (welcome.personal ? link.key : randomName());
  await outbox.setNote(link.key, "own key", key);
  rememberOwnKey(link, key);
  const asked = { consent: welcome.consent[language]!, language, own_key: key, site: link.site };
  const session = await server.persist(() => server.start(own ?? link.key, asked), waiting);
  const texts = welcome.languages[session.language];
  if (texts) pages.speak(session.language, texts);
  const visit = new Visit({ pages, outbox, link: link.key, key }, session);
  await visit.run({ again: welcome.state.name === "under_way", wantsStop: answer === "stop" });
}

function languageOf({ languages }: Welcome): string {
  const known = Object.keys(languages);
  const wanted = navigator.languages.map((each) => each.slice(0, 2).toLowerCase());
  return wanted.find((each) => known.includes(each)) ?? known[0]!;
}

/** Show why no session can begin, or ask for consent; a session under way goes on at a click. */
async function mayBegin(
  { state, phones, languages, end }: Welcome,
  language: () => string,
  speak: (language: string) => void,
): Promise<"yes" | "stop" | "no"> {
  const say = (...content: readonly Node[]): "no" => {
    pages.show(...content);
    return "no";
  };
  if (end) return say(...endContent({ pages }, state.outcome ?? "finished", end));
  if (state.name === "finished" || state.name === "closed") return say(pages.title(), pages.paragraph(state.name));
  if (state.name === "not_due") {
    const time = new Date(state.due_utc!).toLocaleString(document.documentElement.lang);
    return say(pages.title(), pages.paragraph("not_due", { time }));
  }
  if (!phones && Math.min(screen.width, screen.height) < 500) return say(pages.title(), pages.paragraph("no_phone"));
  if (state.name === "under_way") {
    const choices = [["go", "continue"], ["stop", "stop"]] as const;
    const answer = await pages.ask([pages.title(), pages.paragraphs("welcome_back")], choices);
    return answer === "stop" ? "stop" : "yes";
  }
  for (;;) {
    const chosen = languageChoice(Object.keys(languages), language());
    const content = [...chosen.content, pages.title(), pages.paragraphs("consent"), pages.paragraphs("warning")];
    const asked = pages.ask(content, [["agree", "agree"], ["decline", "decline"]]);
    const answer = await Promise.race([asked, chosen.other]);
    if (answer === "agree") return "yes";
    if (answer === "decline") return say(pages.title(), pages.paragraph("declined"));
    speak(answer);
  }
}

/** A list of languages, each by its own name; `other` is kept once another one is chosen. */
function languageChoice(languages: readonly string[], now: string): { content: Node[]; other: Promise<string> } {
  if (languages.length < 2) return { content: [], other: new Promise(() => {}) };
  const nameOf = (language: string): string => new Intl.DisplayNames(language, { type: "language" }).of(language) ?? language;
  const options = languages.map((each) => make("option", { value: each, lang: each, selected: each === now }, nameOf(each)));
  const list = make("select", { id: "language" }, ...options);
  const other = new Promise<string>((resolve) => list.addEventListener("change", () => resolve(list.value)));
  return { content: [make("p", { class: "language" }, make("label", { for: "language" }, pages.text("language")), list)], other };
}

main().catch((error: unknown) => {
  const name = error instanceof Refusal ? ({ 403: "unknown_link", 410: "stopped_deleted" }[error.status] ?? error.detail) : "";
  pages.show(make("p", { role: "alert" }, pages.has(name) ? pages.text(name) : messageOf(error)));
});
