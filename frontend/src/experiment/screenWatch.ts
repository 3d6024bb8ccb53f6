/** Notices that the zoom, the screen, the window, or full screen changed, and asks about it between trials. */

import { itemOf, type Item } from "./answers";
import type { Pages } from "./pages";

/** Bars of a phone's browser come and go. */
const TOLERATED_PX = { fine: 2, coarse: 130 };

interface Seen {
  readonly pixel_ratio: number;
  readonly screen_px: readonly [number, number];
  readonly window_px: readonly [number, number];
  readonly full_screen: boolean;
  /** By two fingers. */
  readonly zoomed: boolean;
}

const seen = (): Seen => ({
  pixel_ratio: window.devicePixelRatio,
  screen_px: [screen.width, screen.height],
  window_px: [window.innerWidth, window.innerHeight],
  full_screen: document.fullscreenElement !== null,
  zoomed: Math.abs((window.visualViewport?.scale ?? 1) - 1) > 0.02,
});

export class ScreenWatch {
  private last = seen();

  constructor(
    private readonly pages: Pages,
    private readonly keep: (item: Item) => Promise<void>,
    /** Measures the screen anew; null where the design measures none. */
    private readonly measure: (() => Promise<void>) | null,
  ) {}

  /** What is on the screen now is as it should be. */
  accept(): void {
    this.last = seen();
  }

  /** Ask about whatever changed since it was last as it should be. */
  async check(): Promise<void> {
    for (let now = seen(); ; now = seen()) {
      const what = this.change(now);
      if (!what) return this.accept();
      await this.keep(itemOf("event", { event: what, before: this.last, now }));
      await this.ask(what);
    }
  }

  private async ask(what: Change): Promise<void> {
    const { pages } = this;
    const content = [pages.title(), pages.paragraph(what)];
    if (what === "full_screen_left") {
      const answer = await pages.ask(content, [["back", "full_screen_back"], ["go", "window_go_on"]]);
      if (answer === "back") await enterFullScreen();
      this.accept();
    } else if (what === "screen_changed" && this.measure) {
      const answer = await pages.ask(content, [["measure", "measure_again"], ["back", "screen_as_before"]]);
      if (answer === "back") return; // looked at again
      await this.measure();
      this.accept();
    } else {
      await pages.ask(content, [["continue", "continue"]]);
      if (what !== "zoomed_in") this.accept(); // for pictures beyond the edge there is no going on
    }
  }

  private change(now: Seen): Change | null {
    const { last } = this;
    if (now.zoomed) return "zoomed_in";
    if (last.full_screen && !now.full_screen) return "full_screen_left";
    const turned = now.screen_px[0] === last.screen_px[1] && now.screen_px[1] === last.screen_px[0];
    const sameScreen = turned || now.screen_px.every((px, i) => px === last.screen_px[i]);
    if (now.pixel_ratio !== last.pixel_ratio || !sameScreen) return "screen_changed";
    const tolerated = TOLERATED_PX[matchMedia("(pointer: coarse)").matches ? "coarse" : "fine"];
    const isEqual = now.window_px.every((px, i) => Math.abs(px - last.window_px[i]!) <= tolerated);
    return isEqual || now.full_screen !== last.full_screen ? null : "window_changed";
  }
}

/** Also the names of the texts that ask. */
type Change = "zoomed_in" | "full_screen_left" | "screen_changed" | "window_changed";

export async function enterFullScreen(): Promise<void> {
  await document.documentElement.requestFullscreen?.({ navigationUI: "hide" }).catch(() => undefined);
}
