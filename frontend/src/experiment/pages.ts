/** Pages around the trials: texts, buttons, and what waits. */

import { button, find, make } from "../page/elements";
import type { Texts } from "./session";

export type PageContent = Node | string;
export type TextValues = Readonly<Record<string, string | number>>;

/** Shows pages; one at a time. Texts that are pages come as safe HTML, made by the server's own Markdown. */
export class Pages {
  private readonly main = find("#page", HTMLElement);
  private readonly trials = find("#trials", HTMLElement);

  constructor(private texts: Texts = {}) {}

  /** Speak a language from now on. */
  speak(language: string, texts: Texts): void {
    this.texts = texts;
    document.title = this.text("title");
    document.documentElement.lang = language;
    document.documentElement.dir = this.text("direction");
    find("#mark", HTMLElement).textContent = this.text("test_mark");
  }

  text(name: string, values: TextValues = {}): string {
    const text = this.texts[name] ?? name;
    return text.replace(/\{(\w+)\}/g, (whole, key: string) => String(values[key] ?? whole));
  }

  has(name: string): boolean {
    return name in this.texts;
  }

  /** A text that is a page. */
  paragraphs(name: string, values: TextValues = {}): HTMLElement {
    const element = make("div");
    element.innerHTML = this.text(name, values);
    return element;
  }

  paragraph(name: string, values: TextValues = {}): HTMLElement {
    return make("p", {}, this.text(name, values));
  }

  /** Show a page; whoever reads by ear or moves by keys begins at its top. */
  show(...content: readonly PageContent[]): void {
    this.trials.hidden = true;
    this.main.hidden = false;
    this.main.classList.remove("wide");
    this.main.replaceChildren(...content);
    (this.main.querySelector("h1") ?? this.main).focus();
    window.scrollTo(0, 0);
  }

  /** Show content with buttons; the promise gives the name of the one that is pressed. */
  ask<Name extends string>(content: readonly PageContent[], choices: readonly (readonly [Name, string])[]): Promise<Name> {
    return new Promise((resolve) => {
      const buttons = choices.map(([name, label], i) =>
        button(this.text(label), () => resolve(name), { class: i === 0 ? "first" : "other" }),
      );
      this.show(...content, make("div", { class: "buttons" }, ...buttons));
    });
  }

  /** Say something beside the page. */
  say(text: string): void {
    find("#notice", HTMLElement).textContent = text;
  }

  title(name = "title"): HTMLElement {
    return make("h1", { tabindex: -1 }, this.text(name));
  }

  showTrials(): HTMLElement {
    this.main.hidden = true;
    this.main.replaceChildren();
    this.trials.hidden = false;
    find("#trials h1", HTMLElement).textContent = this.text("title");
    return find("#stage", HTMLElement);
  }
}
