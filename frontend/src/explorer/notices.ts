/** Messages of the page: errors, which stay until they are dismissed, and news, which pass. */

import { button, icon, make, messageOf } from "../page/elements";

const NEWS_MS = 4000;
const MAX_SENTENCES = 20;

/** One notice of errors and one of anything else, the newer one on top; a new one replaces the old one. */
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

  error(...sentences: string[]): void {
    this.#put(this.#alerts, this.#lasting("notice trouble", sentences));
  }

  /** Messages that stay until they are dismissed. */
  info(sentences: readonly string[]): void {
    this.#put(this.#news, this.#lasting("notice", sentences));
  }

  news(sentence: string): void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence));
    this.#put(this.#news, notice);
    this.#timer = window.setTimeout(() => this.#remove(notice), NEWS_MS);
  }

  /** A message that stays until the returned function is called; other news interrupt it. */
  busy(sentence: string): () => void {
    const notice = make("div", { class: "notice" }, make("p", {}, sentence), make("progress", {}));
    this.#busy = notice;
    this.#put(this.#news, notice);
    return () => {
      if (this.#busy === notice) this.#busy = null;
      this.#remove(notice);
    };
  }

  /** Anything thrown, as an error. */
  caught(error: unknown): void {
    this.error(messageOf(error));
  }

  /** Remove all messages but the busy one. */
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
    const close = button(icon("close"), () => this.#remove(notice), { class: "quiet", "aria-label": "Dismiss" });
    const more = sentences.length - MAX_SENTENCES;
    const shown = [...sentences.slice(0, MAX_SENTENCES), ...(more > 0 ? [`And ${more} more of the kind.`] : [])];
    const paragraphs = shown.map((sentence) => make("p", {}, sentence));
    const notice = make("div", { class: `${kind} lasting` }, make("div", {}, ...paragraphs), close);
    return notice;
  }
}
