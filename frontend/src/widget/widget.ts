/** A walker in a notebook, for anywidget: shows the values that Python sets, and sends changes by hand back. */

import { playLoop } from "../canvas/frameClock";
import { mannequinFrom, type MannequinPainter } from "../canvas/mannequinLoader";
import { painterOn } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import { entry } from "../core/schema";
import { figuresOf } from "../model/figures";
import { endLabels, SIZE_HINT } from "../model/labels";
import type { Model, OwnWalker, Trait } from "../model/model";
import { modelSourceOf, withSize } from "../model/modelSource";
import { initialState, RANGES, type State } from "../model/state";
import { button, make, messageOf, signed } from "../page/elements";
import { Viewer } from "../viewer/viewer";
import style from "./widget.css?inline";

/** The values that Python and the page share, from anywidget. */
export interface SharedModel {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, listener: (message?: unknown) => void): void;
  off(event: string, listener: (message?: unknown) => void): void;
  send(message: unknown): void;
}

/** The least time between two messages to the kernel during a drag. */
const SEND_EVERY_MS = 80;
const PLAIN = [
  "kind", "part", "bias", "tempo", "azimuth_deg", "elevation_deg", "perspective", "style", "trails",
  "dark", "playing", "cycle",
] as const satisfies readonly (keyof State)[];
const WATCHED = [...PLAIN, "keep_size", "alpha", "start", "strengths", "eigenwalkers", "_own"];

function render({ model: shared, el }: { model: SharedModel; el: HTMLElement }): () => void {
  const root = el.shadowRoot ?? el.attachShadow({ mode: "open" });
  const box = make("div", { class: "walker" });
  root.replaceChildren(make("style", {}, style), box);
  try {
    return shared.get("_stimulus") ? showStimulus(shared, box) : showWalker(shared, box);
  } catch (error) {
    box.replaceChildren(make("p", { role: "alert" }, messageOf(error)));
    return () => {};
  }
}

/** Show a stimulus as it is, again and again; the returned function ends that. */
function showStimulus(shared: SharedModel, box: HTMLElement): () => void {
  const stimulus = readStimulus(shared.get("_stimulus"));
  const canvas = make("canvas", { role: "img", "aria-label": "A moving figure" });
  const play = button("", () => {
    shared.set("playing", !shared.get("playing"));
    shared.save_changes();
  });
  box.replaceChildren(canvas, ...(shared.get("controls") ? [make("div", { class: "bar" }, play)] : []));
  const scale = Math.min(1, Number(shared.get("height_px")) / stimulus.display.height_px);
  const painter = painterOn(canvas, stimulus, scale);
  let time = 0;
  let stop = (): void => {};
  const show = (): void => {
    stop();
    const playing = Boolean(shared.get("playing"));
    play.textContent = playing ? "Pause" : "Play";
    painter.paint(time);
    if (!playing) return;
    stop = playLoop(time, stimulus.timing.duration_s, (now) => {
      time = now;
      painter.paint(time);
    });
  };
  shared.on("change:playing", show);
  show();
  return () => {
    stop();
    shared.off("change:playing", show);
  };
}

/** Show a walker of a model with its sliders; the returned function ends that. */
function showWalker(shared: SharedModel, box: HTMLElement): () => void {
  const source = modelSourceOf(shared.get("_model"));
  const sized = (): Model => withSize(source, Boolean(shared.get("keep_size"))).model;
  const { model } = source;
  const canvas = make("canvas", { class: "turns", role: "img" });
  canvas.style.height = `${Number(shared.get("height_px"))}px`;
  const send = senderOf(shared);
  const change = (part: Record<string, unknown>): void => {
    for (const [name, value] of Object.entries(part)) shared.set(name, value);
    send();
  };
  const controls = shared.get("controls") ? controlsOf(model, change) : null;
  box.replaceChildren(canvas, ...(controls ? [controls.element] : []));
  const viewer = new Viewer(canvas, {
    turned: (azimuth_deg, elevation_deg) => change({ azimuth_deg, elevation_deg }),
    loadMannequin: () => requestMannequin(shared),
  });
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) change({ playing: false });
  let request = 0;
  const show = (): void => {
    request = 0;
    const model = sized();
    const state = stateOf(shared, model);
    box.classList.toggle("light", !state.dark);
    canvas.setAttribute("aria-label", `${model.title}, seen from ${Math.round(state.azimuth_deg)} degrees`);
    viewer.show({ model, state, figures: figuresOf(model, state, ownWalker(shared)) });
    controls?.show(state);
  };
  // Values that change together are shown together.
  const showSoon = (): void => {
    request ||= requestAnimationFrame(show);
  };
  const keepPhase = (): void => {
    if (!shared.get("playing")) change({ cycle: viewer.phase });
  };
  for (const name of WATCHED) shared.on(`change:${name}`, showSoon);
  shared.on("change:playing", keepPhase);
  show();
  return () => {
    for (const name of WATCHED) shared.off(`change:${name}`, showSoon);
    shared.off("change:playing", keepPhase);
    cancelAnimationFrame(request);
    viewer.remove();
  };
}

/** A function that sends changes to Python, at once and then at a limited rate. */
function senderOf(shared: SharedModel): () => void {
  let timer = 0;
  let pending = false;
  const send = (): void => {
    timer = 0;
    if (!pending) return;
    pending = false;
    shared.save_changes();
    timer = window.setTimeout(send, SEND_EVERY_MS);
  };
  return () => {
    pending = true;
    if (timer === 0) send();
  };
}

function stateOf(shared: SharedModel, model: Model): State {
  const initial = initialState(model);
  const plain = Object.fromEntries(PLAIN.map((name) => [name, shared.get(name)]));
  const numbers = (name: "strengths" | "eigenwalkers"): number[] => {
    const given = shared.get(name) as readonly number[];
    return initial[name].map((value, i) => given[i] ?? value);
  };
  return {
    ...initial,
    ...(plain as Partial<State>),
    keepSize: Boolean(shared.get("keep_size")),
    traits: shared.get("alpha") as State["traits"],
    from: shared.get("start") as State["from"],
    strengths: numbers("strengths"),
    eigenwalkers: numbers("eigenwalkers"),
  };
}

function ownWalker(shared: SharedModel): OwnWalker | null {
  const vector = shared.get("_own") as readonly number[] | null;
  return vector ? { name: "your walker", vector } : null;
}

/** The mannequin painter from the module that Python sends on request. */
function requestMannequin(shared: SharedModel): Promise<MannequinPainter> {
  return new Promise((resolve, reject) => {
    const onMessage = (message: unknown): void => {
      const text = (message as { mannequin?: unknown } | null)?.mannequin;
      if (typeof text !== "string") return;
      shared.off("msg:custom", onMessage);
      mannequinFrom(text).then(resolve, reject);
    };
    shared.on("msg:custom", onMessage);
    shared.send({ wants: "mannequin" });
  });
}

export default { render };

export interface Controls {
  readonly element: HTMLElement;
  show(state: State): void;
}

type Change = (part: Record<string, unknown>) => void;

const MAX_SLIDERS = 8;

export function controlsOf(model: Model, change: Change): Controls {
  let shown: State | null = null;
  const sliders = model.traits.slice(0, MAX_SLIDERS).map((trait) =>
    traitSlider(trait, (alpha) => change({ alpha: { ...shown?.traits, [trait.name]: alpha } })),
  );
  const play = button("Pause", () => change({ playing: !shown?.playing }));
  const back = button("Back to average", () =>
    change({ alpha: {}, bias: null, strengths: [], eigenwalkers: [], start: "average" }),
  );
  const size = make("input", { type: "checkbox" });
  size.addEventListener("change", () => change({ keep_size: size.checked }));
  const sizes = make("label", { class: "size", title: SIZE_HINT }, size, "Keep people's size");
  const bar = make("div", { class: "bar" }, play, ...(model.traits.length > 0 ? [back] : []),
    ...(model.keepSize === undefined ? [] : [sizes]));
  return {
    element: make("div", { class: "controls" }, ...sliders.map(({ element }) => element), bar),
    show(state) {
      shown = state;
      size.checked = state.keepSize;
      play.textContent = state.playing ? "Pause" : "Play";
      for (const slider of sliders) slider.show(state);
    },
  };
}

/** From one end of a trait to the other; a double click sets it to 0. */
function traitSlider(trait: Trait, onInput: (alpha: number) => void): Controls {
  const { name } = trait;
  const [left, right] = endLabels(trait);
  const [min, max] = RANGES.trait;
  const label = `${name}: from ${left} to ${right}`;
  const input = make("input", { type: "range", min, max, step: 0.1, value: 0, "aria-label": label });
  const number = make("output");
  input.addEventListener("input", () => onInput(Number(input.value)));
  input.addEventListener("dblclick", () => onInput(0));
  return {
    element: make("label", {}, make("span", {}, left), input, make("span", {}, right), number),
    show({ traits }) {
      const alpha = entry(traits, name) ?? 0;
      if (Number(input.value) !== alpha) input.value = String(alpha);
      input.style.setProperty("--now", String((Number(input.value) - min) / (max - min)));
      input.classList.toggle("below", alpha < 0);
      number.textContent = signed(alpha);
      input.setAttribute("aria-valuetext", `${number.textContent} standard deviations`);
    },
  };
}
