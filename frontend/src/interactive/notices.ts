/** What the page has to say: trouble, which stays until it is sent away, and news, which passes. */

import { icon, make } from "./element";

const NEWS_MS = 4000;
const MOST = 3;

export class Notices {
  readonly element = make("div", { class: "notices" });
  readonly #alerts = make("div", { role: "alert" });
  readonly #news = make("div", { role: "status" });
  #timer = 0;

  constructor() {
    this.element.append(this.#alerts, this.#news);
  }

  /** A sentence that stays until it is read. */
  trouble(sentence: string): void {
    const close = make("button", { type: "button", class: "quiet", "aria-label": "Dismiss" }, icon("close"));
    const notice = make("div", { class: "notice trouble" }, make("p", {}, sentence), close);
    close.addEventListener("click", () => notice.remove());
    this.#alerts.append(notice);
    while (this.#alerts.childElementCount > MOST) this.#alerts.firstElementChild?.remove();
  }

  /** A word that passes. */
  news(sentence: string): void {
    this.#news.replaceChildren(make("div", { class: "notice" }, make("p", {}, sentence)));
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#news.replaceChildren(), NEWS_MS);
  }

  /** Whatever was thrown, as a sentence. */
  caught(error: unknown): void {
    this.trouble(error instanceof Error && error.message ? error.message : String(error));
  }
}
