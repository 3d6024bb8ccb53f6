/** Below the stage: play, pause and scrub, how fast, from where, and drawn how. */

import { RANGES, type State } from "../model/state";
import { choice, type Option } from "./choice";
import { icon, make } from "../page/element";
import type { Part, Session } from "./store";
import { slider } from "./slider";

export interface Transport extends Part {
  /** Let the scrub slider follow the walk. */
  tick(cycle: number): void;
}

const STYLES: readonly Option<State["style"]>[] = [
  { value: "dots", label: "Points" },
  { value: "sticks", label: "Sticks" },
  { value: "mannequin", label: "Body" },
];
const VIEWS: readonly Option<number>[] = [
  { value: 0, label: "Front", hint: "0 degrees" },
  { value: 30, label: "30\u00b0" },
  { value: 90, label: "Side", hint: "90 degrees" },
];
/**
 * The slider itself follows the walk so seldom: what is seen of it are layers that move without being
 * painted, and to paint the slider costs as much as to paint the walker.
 */
const VALUED_MS = 500;
/** How many steps the stride has for who scrubs. */
const FINE = 200;

/** The button that lets it walk or stand; there are two of them, as room allows. */
export function playButton(session: Session): Part {
  const element = make("button", { type: "button", class: "round" });
  element.addEventListener("click", () => session.play(!session.state.playing));
  let shown: boolean | undefined;
  return {
    element,
    show({ state: { playing } }) {
      if (playing === shown) return;
      shown = playing;
      element.replaceChildren(icon(playing ? "pause" : "play"));
      element.setAttribute("aria-label", playing ? "Pause" : "Play");
      element.title = playing ? "Pause (space)" : "Play (space)";
    },
  };
}

export function transport(session: Session): Transport {
  const play = playButton(session);
  const scrub = make("input", {
    type: "range", min: 0, max: 1, step: 1 / FINE, value: 0, class: "scrub",
    "aria-label": "Moment of the stride",
  });
  scrub.addEventListener("input", () =>
    session.change({ playing: false, cycle: Number(scrub.value) % 1 }),
  );
  let before: Pick<State, "playing" | "cycle"> = session.state;
  scrub.addEventListener("pointerdown", () => (before = session.state));
  scrub.addEventListener("pointercancel", () => session.change({ playing: before.playing, cycle: before.cycle }));
  const run = make("div", { class: "run", "aria-hidden": "true" }, make("i"), make("b"));
  let valued = -Infinity;
  const tick = (cycle: number): void => {
    const [fill, knob] = run.children as unknown as [HTMLElement, HTMLElement];
    fill.style.transform = `translateX(${100 * (cycle - 1)}%)`;
    knob.style.transform = `translateX(${100 * cycle}%)`;
    const time = performance.now();
    if (session.state.playing && time - valued < VALUED_MS) return;
    valued = time;
    scrub.value = String(cycle);
  };
  const tempo = slider({
    label: "Speed", min: RANGES.tempo[0], max: RANGES.tempo[1], step: 0.05, usual: 1,
    said: (value) => `${value.toFixed(2)}\u00d7`,
    onInput: (value) => session.change({ tempo: value }),
  });
  const look = (azimuth_deg: number): void => session.change({ azimuth_deg, elevation_deg: 0 });
  const views = choice("View", VIEWS, look, { named: false });
  const styles = choice("Drawn as", STYLES, (style) => session.change({ style }), { named: false });
  return {
    element: make("div", { class: "tools" },
      play.element,
      make("div", { class: "time" }, scrub, run),
      tempo.element,
      views.element,
      styles.element,
    ),
    tick,
    show(now) {
      const { state } = now;
      play.show(now);
      tempo.show(state.tempo);
      views.show(state.elevation_deg === 0 ? Math.round(state.azimuth_deg) : NaN);
      styles.show(state.style);
      if (!state.playing) tick(state.cycle);
    },
  };
}
