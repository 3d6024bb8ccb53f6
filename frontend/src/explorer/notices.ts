/** What the page has to say: trouble, which stays until it is sent away, and news, which passes. */

import { icon, make } from "../page/element";

const NEWS_MS = 4000;
const MOST_SENTENCES = 20;

/**
 * One notice of trouble and one of anything else, the newer one on top: what is new of a kind takes
 * the place of what was.
 */
export class Notices {
  readonly element = make("div", { class: "notices" });
  readonly #alerts = make("div", { role: "alert" });
  readonly #news = make("div", { role: "status" });
  #busy: HTMLElement | null = null;
  #timer = 0;
  #count = 0;

  constructor() {
    this.element.append(this.#alerts, this.#news);
  }

  /** Sentences that stay until they are read. */
  trouble(...sentences: string[]): void {
    this.#put(this.#alerts, this.#lasting("notice trouble", sentences));
  }

  /** Good news that takes longer to read than it would stay. */
  told(sentences: readonly string[]): void {
    this.#put(this.#news, this.#lasting("notice", sentences));
  }

  /** A word that passes. */
  news(sentence: string): void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence));
    this.#put(this.#news, notice);
    this.#timer = window.setTimeout(() => this.#remove(notice), NEWS_MS);
  }

  /** A word that stays until the returned function is called, and comes back after others. */
  busy(sentence: string): () => void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence), make("progress", {}));
    this.#busy = notice;
    this.#put(this.#news, notice);
    return () => {
      if (this.#busy === notice) this.#busy = null;
      this.#remove(notice);
    };
  }

  /** Whatever was thrown, as a sentence. */
  caught(error: unknown): void {
    this.trouble(sentenceOf(error));
  }

  /** Nothing of what was said before matters any more. */
  clear(): void {
    this.#alerts.replaceChildren();
    this.#news.replaceChildren(...(this.#busy ? [this.#busy] : []));
  }

  #put(place: HTMLElement, notice: HTMLElement): void {
    if (place === this.#news) clearTimeout(this.#timer);
    place.style.order = String(--this.#count);
    place.replaceChildren(notice);
  }

  #remove(notice: HTMLElement): void {
    const inNews = notice.parentElement === this.#news;
    notice.remove();
    if (inNews && this.#busy) this.#news.append(this.#busy);
  }

  #lasting(kind: string, sentences: readonly string[]): HTMLElement {
    const close = make("button", { type: "button", class: "quiet", "aria-label": "Dismiss" }, icon("close"));
    const more = sentences.length - MOST_SENTENCES;
    const said = [...sentences.slice(0, MOST_SENTENCES), ...(more > 0 ? [`And ${more} more of the kind.`] : [])];
    const paragraphs = said.map((sentence) => make("p", {}, sentence));
    const notice = make("div", { class: `${kind} lasting` }, make("div", {}, ...paragraphs), close);
    close.addEventListener("click", () => this.#remove(notice));
    return notice;
  }
}

/** What was thrown, in its own words. */
export const sentenceOf = (error: unknown): string =>
  error instanceof Error && error.message ? error.message : String(error);
