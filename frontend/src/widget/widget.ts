/** The walker in a notebook, for anywidget: what Python sets is shown, what a hand sets goes back. */

import { mannequinFrom, type MannequinPainter } from "../canvas/mannequinLoader";
import { castOf } from "../model/figures";
import type { Model, Own } from "../model/model";
import { readModel } from "../model/readModel";
import { initialState, type State } from "../model/state";
import { Stage } from "../viewer/viewer";
import { film } from "./film";
import { controlsOf, type Controls } from "./controls";
import style from "./widget.css?inline";

/** What anywidget gives: the values that Python and the page share. */
export interface Shared {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, heard: (message?: unknown) => void): void;
  off(event: string, heard: (message?: unknown) => void): void;
  send(message: unknown): void;
}

/** The kernel hears of a hand that moves so often. */
const TOLD_EVERY_MS = 80;
const PLAIN = [
  "kind", "part", "bias", "tempo", "azimuth_deg", "elevation_deg", "perspective", "style", "trails",
  "dark", "playing", "cycle",
] as const satisfies readonly (keyof State)[];
const WATCHED = [...PLAIN, "alpha", "start", "strengths", "eigenwalkers", "_own"];

function render({ model: shared, el }: { model: Shared; el: HTMLElement }): () => void {
  const root = el.shadowRoot ?? el.attachShadow({ mode: "open" });
  const sheet = document.createElement("style");
  sheet.textContent = style;
  const box = document.createElement("div");
  box.className = "walker";
  root.replaceChildren(sheet, box);
  try {
    return shared.get("_stimulus") ? film(shared, box) : walker(shared, box);
  } catch (error) {
    const trouble = document.createElement("p");
    trouble.setAttribute("role", "alert");
    trouble.textContent = error instanceof Error ? error.message : String(error);
    box.replaceChildren(trouble);
    return () => {};
  }
}

/** A walker made of a model, with its sliders; what ends it is returned. */
function walker(shared: Shared, box: HTMLElement): () => void {
  const model = readModel(shared.get("_model"));
  const canvas = document.createElement("canvas");
  canvas.style.height = `${Number(shared.get("height_px"))}px`;
  canvas.className = "turns";
  canvas.setAttribute("role", "img");
  const tell = teller(shared);
  const change = (part: Record<string, unknown>): void => {
    for (const [name, value] of Object.entries(part)) shared.set(name, value);
    tell();
  };
  const controls: Controls | null = shared.get("controls") ? controlsOf(model, change) : null;
  box.replaceChildren(canvas, ...(controls ? [controls.element] : []));
  const stage = new Stage(canvas, {
    turned: (azimuth_deg, elevation_deg) => change({ azimuth_deg, elevation_deg }),
    mannequin: () => mannequinOf(shared),
  });
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) change({ playing: false });
  let waiting = 0;
  const show = (): void => {
    waiting = 0;
    const state = stateOf(shared, model);
    box.classList.toggle("light", !state.dark);
    canvas.setAttribute("aria-label", `${model.title}, seen from ${Math.round(state.azimuth_deg)} degrees`);
    stage.show(model, castOf(model, state, ownOf(shared)), state);
    controls?.show(state);
  };
  // Several values that change together are shown together.
  const soon = (): void => {
    waiting ||= requestAnimationFrame(show);
  };
  const pausedAt = (): void => {
    if (!shared.get("playing")) change({ cycle: stage.cycle });
  };
  for (const name of WATCHED) shared.on(`change:${name}`, soon);
  shared.on("change:playing", pausedAt);
  show();
  return () => {
    for (const name of WATCHED) shared.off(`change:${name}`, soon);
    shared.off("change:playing", pausedAt);
    cancelAnimationFrame(waiting);
    stage.remove();
  };
}

/** What sends changes to Python, at once and then not too often. */
function teller(shared: Shared): () => void {
  let timer = 0;
  let more = false;
  const send = (): void => {
    timer = 0;
    if (!more) return;
    more = false;
    shared.save_changes();
    timer = window.setTimeout(send, TOLD_EVERY_MS);
  };
  return () => {
    more = true;
    if (timer === 0) send();
  };
}

export function stateOf(shared: Pick<Shared, "get">, model: Model): State {
  const initial = initialState(model);
  const plain = Object.fromEntries(PLAIN.map((name) => [name, shared.get(name)]));
  const numbers = (name: string, usual: readonly number[]): number[] => {
    const given = shared.get(name) as readonly number[];
    return usual.map((value, i) => given[i] ?? value);
  };
  return {
    ...initial,
    ...(plain as Partial<State>),
    traits: shared.get("alpha") as State["traits"],
    from: shared.get("start") as State["from"],
    strengths: numbers("strengths", initial.strengths),
    eigenwalkers: numbers("eigenwalkers", initial.eigenwalkers),
  };
}

function ownOf(shared: Shared): Own | null {
  const vector = shared.get("_own") as readonly number[] | null;
  return vector ? { name: "your walker", vector } : null;
}

/** The module of the mannequin, which Python sends when it is asked for. */
function mannequinOf(shared: Shared): Promise<MannequinPainter> {
  return new Promise((resolve, reject) => {
    const heard = (message: unknown): void => {
      const text = (message as { mannequin?: unknown } | null)?.mannequin;
      if (typeof text !== "string") return;
      shared.off("msg:custom", heard);
      mannequinFrom(text).then(resolve, reject);
    };
    shared.on("msg:custom", heard);
    shared.send({ wants: "mannequin" });
  });
}

export default { render };
