/** What the page has to say: trouble, which stays until it is sent away, and news, which passes. */

import { icon, make } from "./element";

const NEWS_MS = 4000;
const MOST = 3;
const MOST_SENTENCES = 20;

function lasting(kind: string, sentences: readonly string[]): HTMLElement {
  const close = make("button", { type: "button", class: "quiet", "aria-label": "Dismiss" }, icon("close"));
  const paragraphs = sentences.slice(0, MOST_SENTENCES).map((sentence) => make("p", {}, sentence));
  const notice = make("div", { class: kind }, make("div", {}, ...paragraphs), close);
  close.addEventListener("click", () => notice.remove());
  return notice;
}

function stay(place: HTMLElement, notice: HTMLElement): void {
  place.append(notice);
  while (place.childElementCount > MOST) place.firstElementChild?.remove();
}

export class Notices {
  readonly element = make("div", { class: "notices" });
  readonly #alerts = make("div", { role: "alert" });
  readonly #news = make("div", { role: "status" });
  #last: HTMLElement | null = null;
  #timer = 0;

  constructor() {
    this.element.append(this.#alerts, this.#news);
  }

  /** A sentence that stays until it is read. */
  trouble(sentence: string): void {
    stay(this.#alerts, lasting("notice trouble", [sentence]));
  }

  /** Good news that takes longer to read than it would stay. */
  told(sentences: readonly string[]): void {
    stay(this.#news, lasting("notice", sentences));
  }

  /** A word that passes. */
  news(sentence: string): void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence));
    this.#last?.remove();
    this.#last = notice;
    this.#news.append(notice);
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => notice.remove(), NEWS_MS);
  }

  /** A word that stays until the returned function is called. */
  busy(sentence: string): () => void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence), make("progress", {}));
    this.#news.append(notice);
    return () => notice.remove();
  }

  /** Whatever was thrown, as a sentence. */
  caught(error: unknown): void {
    this.trouble(error instanceof Error && error.message ? error.message : String(error));
  }
}
