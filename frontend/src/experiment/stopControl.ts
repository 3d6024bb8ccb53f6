/** Stopping, which is possible on every page: the observer keeps or deletes what was given, or goes on. */

import { button, find, make } from "../page/elements";
import type { Pages } from "./pages";

export class StopControl {
  private readonly header = find("header", HTMLElement);
  private readonly dialog: HTMLDialogElement;
  private left: Promise<void> = Promise.resolve();
  private leave = (): void => {};

  constructor(pages: Pages, stop: (how: "stopped" | "deleted") => void) {
    const close = (then: () => void = () => {}) => () => {
      this.dialog.close();
      then();
    };
    const control = find("#stop", HTMLButtonElement);
    control.textContent = pages.text("stop");
    control.onclick = () => this.open();
    const title = make("h2", { id: "stop-title" }, pages.text("stop"));
    this.dialog = make(
      "dialog",
      { "aria-labelledby": "stop-title" },
      title,
      pages.paragraph("stop_question"),
      make(
        "div",
        { class: "buttons" },
        button(pages.text("stop_cancel"), close(), { class: "first" }),
        button(pages.text("stop_keep"), close(() => stop("stopped"))),
        button(pages.text("stop_delete"), close(() => stop("deleted"))),
      ),
    );
    this.dialog.addEventListener("close", () => this.leave());
    // an answer is given to a trial, not to a question about stopping
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(this.dialog);
    this.header.hidden = false;
  }

  get isOpen(): boolean {
    return this.dialog.open;
  }

  /** Kept once the question is answered, or at once where none is asked. */
  get answered(): Promise<void> {
    return this.left;
  }

  open(): void {
    if (this.isOpen) return;
    this.left = new Promise((resolve) => (this.leave = resolve));
    this.dialog.showModal();
  }

  /** There is nothing left to stop. */
  remove(): void {
    this.header.hidden = true;
    this.dialog.remove();
    this.leave();
  }
}
