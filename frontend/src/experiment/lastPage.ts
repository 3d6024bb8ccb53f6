/** The last page: it waits until all is confirmed, offers what is unsent as a file, and leaves nothing on the machine. */

import { button, make } from "../page/elements";
import { checksum } from "./answers";
import type { Place } from "./place";
import type { Sender } from "./sender";
import * as server from "./server";
import type { End, SessionContent } from "./session";

const RESCUE_AFTER_MS = 120_000;
const LOOK_MS = 1000;

export class LastPage {
  constructor(
    private readonly place: Place,
    private readonly session: SessionContent,
    private readonly sender: Sender,
  ) {}

  async finish(how: "finished" | "stopped"): Promise<void> {
    const { outbox, link, key, pages } = this.place;
    await this.wait();
    const end = await server.persist(() => server.end(key, this.session.session, how), () => pages.say(pages.text("no_server")));
    pages.say("");
    const isRefused = outbox.items(key, this.session.session).length > 0;
    if (!isRefused) await outbox.clear(link, key);
    const next = how === "finished" ? await this.nextSession() : [];
    const refused = isRefused ? [pages.paragraph("refused"), this.saving()] : [];
    pages.show(...endContent(this.place, how, end), ...next, ...refused);
  }

  /** Wait until each item is confirmed, or refused for good. */
  private async wait(): Promise<void> {
    if (this.sender.unsent().length === 0) return;
    const { pages } = this.place;
    const count = make("p", { role: "status" });
    const rescue = make("div", { hidden: true }, pages.paragraph("offline"), this.saving());
    const say = (): void => {
      const text = pages.text("sending", { count: this.sender.unsent().length });
      if (count.textContent !== text) count.textContent = text;
    };
    say();
    pages.show(pages.title(), count, rescue);
    const stay = (event: BeforeUnloadEvent): void => event.preventDefault();
    window.addEventListener("beforeunload", stay);
    const shown = setInterval(say, LOOK_MS);
    const late = setTimeout(() => void (rescue.hidden = false), RESCUE_AFTER_MS);
    await this.sender.drain();
    clearInterval(shown);
    clearTimeout(late);
    window.removeEventListener("beforeunload", stay);
  }

  /** When the next session begins, and by which link. */
  private async nextSession(): Promise<Node[]> {
    const { pages, key, link } = this.place;
    const state = await server.welcome(key, {}).then(({ state }) => state, () => null);
    if (state?.name !== "not_due" && state?.name !== "new") return [];
    const time = new Date(state.due_utc ?? Date.now()).toLocaleString(document.documentElement.lang);
    const address = `${location.origin}/s/${key}`;
    const own = key === link ? [] : [make("p", {}, make("a", { href: address }, address))];
    return [pages.paragraph("not_due", { time }), ...own];
  }

  private saving(): HTMLElement {
    const { pages } = this.place;
    return make("div", { class: "buttons" }, button(pages.text("save_file"), () => this.saveFile()));
  }

  /** Give what is here to the observer, as a file for `experiment rescue`. */
  private saveFile(): void {
    const { session, proof } = this.session;
    const items = this.place.outbox.items(this.place.key, session).map(({ item }) => {
      const text = JSON.stringify(item);
      return { text, check: checksum(proof + text) };
    });
    const text = JSON.stringify({ format: "eigenwalker rescue", version: 1, session, proof, items });
    const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "application/json" })), download: "answers.json" });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }
}

/** What is said once a session is over. */
export function endContent({ pages }: Pick<Place, "pages">, how: "finished" | "stopped", end: End): Node[] {
  const parts: Node[] = [pages.title(), pages.paragraph(how === "finished" ? "done" : "stopped_kept")];
  if (how === "finished") parts.push(pages.paragraphs("debriefing"));
  if (end.completion_code) parts.push(withCode(pages.text("completion", { code: end.completion_code }), end.completion_code));
  if (end.return_url?.startsWith("https://")) {
    parts.push(make("p", {}, make("a", { href: end.return_url }, pages.text("return"))));
  }
  if (end.withdrawal_code) parts.push(withCode(pages.text("withdraw", { code: end.withdrawal_code }), end.withdrawal_code));
  return parts;
}

/** A sentence whose code stands out. */
function withCode(text: string, code: string): HTMLElement {
  const [before, ...after] = text.split(code);
  if (after.length === 0) return make("p", {}, text);
  return make("p", {}, before!, make("code", { dir: "ltr" }, code), after.join(code));
}
