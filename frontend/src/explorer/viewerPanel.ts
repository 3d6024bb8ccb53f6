/** The viewer on the page: its keys, the names of several walkers, the caption, and playback. */

import { plural, populationLabel } from "../model/labels";
import { captionOf } from "../model/captions";
import type { SceneFigure } from "../model/figures";
import { clamped, RANGES, wrappedDegrees } from "../model/state";
import { find, make, setAttributes } from "../page/elements";
import type { Box } from "../viewer/arrangement";
import { Viewer } from "../viewer/viewer";
import { playback } from "./playback";
import type { Now, Store, View } from "./store";

/** The caption for screen readers changes after a pause of this length. */
const PAUSE_MS = 1200;
/** More names than these overlap. */
const MAX_NAMES = 4;
/** Degrees for each press of an arrow key. */
const TURN = 5;
/** Factor for each press of + or -. */
const ZOOM = 1.15;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [TURN, 0],
  ArrowRight: [-TURN, 0],
  ArrowUp: [0, TURN],
  ArrowDown: [0, -TURN],
};

export function viewerPanel(store: Store): View {
  const host = find("#viewer", HTMLDivElement);
  const hint = find("#hint", HTMLParagraphElement);
  const labels = find("#labels", HTMLDivElement);
  const people = find("#people", HTMLParagraphElement);
  const tools = playback(store);
  let last: Now | undefined;
  const viewer = new Viewer(find("#viewer canvas", HTMLCanvasElement), {
    turned: (azimuth_deg, elevation_deg) => {
      hint.classList.add("done");
      store.change({ azimuth_deg, elevation_deg });
    },
    ticked: (phase) => tools.tick(phase),
    zoomed: (factor) => zoomBy(store, factor),
    picked: (known) => store.change({ from: known, scene: "one" }),
    arranged: (boxes) => showNames(labels, last?.figures ?? [], boxes),
  });
  store.viewer = viewer;
  const onKey = (event: KeyboardEvent): void => turnByKey(store, event);
  host.addEventListener("keydown", onKey);
  find("#playback", HTMLDivElement).replaceChildren(tools.element);
  const updateCaption = caption();
  return {
    show(now) {
      last = now;
      const { model, figures, state } = now;
      viewer.show(now);
      tools.show(now);
      const name = state.scene === "one" && state.from !== "average" ? [figures[0]!.name] : [];
      people.textContent = [populationLabel(model), ...name].join(" \u00b7 ");
      const degrees = Math.round(state.azimuth_deg);
      setAttributes(host, { "aria-valuenow": degrees, "aria-valuetext": `${degrees} degrees` });
      updateCaption(now);
    },
    remove() {
      viewer.remove();
      host.removeEventListener("keydown", onKey);
    },
  };
}

function turnByKey(store: Store, event: KeyboardEvent): void {
  const { azimuth_deg, elevation_deg } = store.state;
  const arrow = ARROWS[event.key];
  if (arrow) {
    store.change({
      azimuth_deg: wrappedDegrees(azimuth_deg + arrow[0]),
      elevation_deg: clamped(RANGES.elevation_deg, elevation_deg + arrow[1]),
    });
  } else if (event.key === "+" || event.key === "-") zoomBy(store, event.key === "+" ? ZOOM : 1 / ZOOM);
  else if (event.key === "Home") store.change({ azimuth_deg: 0, elevation_deg: 0, zoom: 1 });
  else return;
  event.preventDefault();
}

const zoomBy = (store: Store, factor: number): void =>
  store.change({ zoom: clamped(RANGES.zoom, store.state.zoom * factor) });

/** The names of a few walkers, below each of them. */
function showNames(element: HTMLElement, figures: readonly SceneFigure[], boxes: readonly Box[]): void {
  const few = figures.length > 1 && figures.length <= MAX_NAMES;
  const names = (few ? figures : []).flatMap(({ name }, i) => {
    const box = boxes[i];
    if (!box) return [];
    const tag = make("span", {}, displayName(name));
    tag.style.left = `${box.left + box.width / 2}px`;
    tag.style.top = `${box.top + box.height}px`;
    return [tag];
  });
  element.replaceChildren(...names);
}

/** "woman tripled" as "women × 3". */
function displayName(name: string): string {
  const [first = "", ...others] = name.split(" ");
  const people = plural(first);
  if (people.endsWith(" walkers") || /^\d+$/.test(others[0] ?? "")) return name;
  return [people, ...others].join(" ").replace("tripled", "\u00d7 3");
}

/** Updates the caption after a pause, if it has changed. */
function caption(): (now: Now) => void {
  const element = find("#caption", HTMLParagraphElement);
  let timer = 0;
  return ({ model, state, own }) => {
    clearTimeout(timer);
    timer = window.setTimeout(() => {
      const text = captionOf(model, state, own);
      if (element.textContent !== text) element.textContent = text;
    }, PAUSE_MS);
  };
}
