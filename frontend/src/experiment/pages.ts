/** Pages around the trials: texts, buttons, and what waits. */

import { button, find, make } from "../page/elements";
import type { Texts } from "./session";

export type PageContent = Node | string;

/** Shows pages; one at a time. Texts that are pages come as safe HTML, made by the server's own Markdown. */
export class Pages {
  private readonly main = find("#page", HTMLElement);
  private readonly trials = find("#trials", HTMLElement);

  constructor(public texts: Texts = {}) {}

  text(name: string, values: Readonly<Record<string, string | number>> = {}): string {
    const text = this.texts[name] ?? name;
    return text.replace(/\{(\w+)\}/g, (whole, key: string) => String(values[key] ?? whole));
  }

  /** A text that is a page. */
  paragraphs(name: string, values: Readonly<Record<string, string | number>> = {}): HTMLElement {
    const element = make("div");
    element.innerHTML = this.text(name, values);
    return element;
  }

  paragraph(name: string, values: Readonly<Record<string, string | number>> = {}): HTMLElement {
    return make("p", {}, this.text(name, values));
  }

  show(...content: readonly PageContent[]): void {
    this.trials.hidden = true;
    this.main.hidden = false;
    this.main.replaceChildren(...content);
    this.main.focus();
    window.scrollTo(0, 0);
  }

  /** Show content with buttons; the promise gives the name of the one that is pressed. */
  ask<Name extends string>(content: readonly PageContent[], choices: readonly (readonly [Name, string])[]): Promise<Name> {
    return new Promise((resolve) => {
      const buttons = choices.map(([name, label]) => button(this.text(label), () => resolve(name)));
      this.show(...content, make("div", { class: "buttons" }, ...buttons));
    });
  }

  title(name = "title"): HTMLElement {
    return make("h1", {}, this.text(name));
  }

  showTrials(): HTMLElement {
    this.main.hidden = true;
    this.main.replaceChildren();
    this.trials.hidden = false;
    return this.trials;
  }
}
