/** Below the viewer: play, pause and scrub, speed, view, style. */

import { RANGES, type State } from "../model/state";
import { button, icon, make } from "../page/elements";
import { choice, type Option, slider } from "./controls";
import { bound, group } from "./parts";
import type { Part, Store } from "./store";

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
 * The input follows the walk only this often: its visible parts are layers that move without being
 * painted, and painting the input costs as much as painting the walker.
 */
const INPUT_MS = 500;
/** Steps of a stride for scrubbing. */
const N_STEPS = 200;

function playButton(store: Store): Part {
  const element = button("", () => store.play(!store.state.playing), { class: "round" });
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

/** The part, and a function that moves the scrub bar during playback. */
export function playback(store: Store): Part & { tick(phase: number): void } {
  const scrub = make("input", {
    type: "range", min: 0, max: 1, step: 1 / N_STEPS, value: 0, class: "scrub",
    "aria-label": "Moment of the stride",
  });
  scrub.addEventListener("input", () => store.change({ playing: false, cycle: Number(scrub.value) % 1 }));
  let before: Pick<State, "playing" | "cycle"> = store.state;
  scrub.addEventListener("pointerdown", () => (before = store.state));
  scrub.addEventListener("pointercancel", () => store.change({ playing: before.playing, cycle: before.cycle }));
  const [fill, knob] = [make("i"), make("b")];
  let lastInput = -Infinity;
  const tick = (phase: number): void => {
    fill.style.transform = `translateX(${100 * (phase - 1)}%)`;
    knob.style.transform = `translateX(${100 * phase}%)`;
    const time = performance.now();
    if (store.state.playing && time - lastInput < INPUT_MS) return;
    lastInput = time;
    scrub.value = String(phase);
  };
  const [min, max] = RANGES.tempo;
  const tempo = slider({
    label: "Speed", min, max, step: 0.05, initial: 1,
    format: (value) => `${value.toFixed(2)}\u00d7`,
    onInput: (value) => store.change({ tempo: value }),
  });
  const unnamed = { named: false };
  const view = choice("View", VIEWS, (azimuth_deg) => store.change({ azimuth_deg, elevation_deg: 0 }), unnamed);
  const style = choice("Drawn as", STYLES, (value) => store.change({ style: value }), unnamed);
  const { element, show } = group({ class: "tools" },
    playButton(store),
    make("div", { class: "time" }, scrub, make("div", { class: "run", "aria-hidden": "true" }, fill, knob)),
    bound(tempo, (state) => state.tempo),
    bound(view, (state) => (state.elevation_deg === 0 ? Math.round(state.azimuth_deg) : NaN)),
    bound(style, (state) => state.style));
  return {
    element,
    tick,
    show(now) {
      show(now);
      if (!now.state.playing) tick(now.state.cycle);
    },
  };
}
