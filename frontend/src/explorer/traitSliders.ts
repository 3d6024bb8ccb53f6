/** Sliders of the traits, the first one large below the viewer, and of the eigenwalkers. */

import { clamped, RANGES, type State } from "../model/state";
import { make, signed } from "../page/elements";
import { rangeOf, type Axis } from "./axis";
import { densityPlot } from "./densityPlot";
import { slider, type Slider } from "./slider";
import type { Part, Store } from "./store";

/** The walker has a mark of its own if it is at least this far from the thumb. */
const MARK_FROM_SD = 0.1;
/** Numbers of the scale below the large slider; 4.5 stands for a label. */
const SCALE = [-6, -4.5, -3, 0, 3, 4.5, 6];

/**
 * The large slider, with the density of the people behind its track. Its thumb shows the steps along the
 * axis; a mark on the density shows the position of the resulting walker among the people.
 */
export function mainSlider(store: Store): Part {
  const [axis] = store.axes;
  const element = make("div");
  if (!axis) return { element, show: () => {} };
  const one = axisSlider(store, axis);
  one.element.classList.add("large", "fresh");
  one.input.addEventListener("input", () => one.element.classList.remove("fresh"));
  const beyond = () => make("span", { class: "beyond" }, "beyond anyone");
  const scale = make("div", { class: "scale", "aria-hidden": "true" },
    ...SCALE.map((at) => (Math.abs(at) === 4.5 ? beyond() : make("span", {}, signed(at, 0)))),
  );
  const mark = make("i", { class: "mark", "aria-hidden": "true" }, make("span"));
  one.element.append(make("div", { class: "hill" }, densityPlot(store.model, axis), mark), scale);
  element.append(one.element);
  return {
    element,
    show({ state, position }) {
      one.show(axis.value(state));
      one.element.classList.toggle("idle", state.scene === "four");
      showMark(mark, axis.at(position), state.scene === "one" ? axis.value(state) : null);
    },
  };
}

/** Mark the position of the walker, unless it is that of the thumb. */
function showMark(mark: HTMLElement, position: number, thumb: number | null): void {
  const [low, high] = RANGES.trait;
  mark.hidden = thumb === null || Math.abs(position - thumb) < MARK_FROM_SD;
  mark.style.setProperty("--at", String(clamped([0, 1], (position - low) / (high - low))));
  mark.classList.toggle("left", position < (low + high) / 2);
  mark.firstElementChild!.textContent = `this walker ${signed(position)}`;
}

/** Sliders of all traits but the first. */
export const otherTraits = (store: Store): Part =>
  sliders(store, store.axes.slice(1).filter(({ trait }) => trait !== null));

/** Sliders of the eigenwalkers. */
export function eigenwalkerSliders(store: Store): Part {
  const { eigenwalkers } = store.model;
  const axes = store.axes.filter(({ trait }) => trait === null);
  const labels = axes.map(({ label }, i) => `${label} \u00b7 ${Math.round(100 * eigenwalkers[i]!.share)} % of the variance`);
  return sliders(store, axes, labels);
}

/** A slider for each axis, with names of its ends, or with a label. */
function sliders(store: Store, axes: readonly Axis[], labels: readonly string[] = []): Part {
  const all = axes.map((axis, i) => axisSlider(store, axis, labels[i]));
  return {
    element: make("div", { class: "sliders" }, ...all.map(({ element }) => element)),
    show: ({ state }) =>
      all.forEach((one, i) => {
        one.show(axes[i]!.value(state));
        one.element.classList.toggle("idle", state.scene === "four");
      }),
  };
}

/** Moving a slider leaves the mean walkers, which no slider changes. */
export const leaveMeans = ({ state }: Store): Partial<State> => (state.scene === "four" ? { scene: "one" } : {});

function axisSlider(store: Store, axis: Axis, label?: string): Slider {
  const [min, max] = RANGES.trait;
  return slider({
    label: label ?? axis.label,
    ...(label === undefined ? { ends: axis.ends } : {}),
    min, max, step: 0.05, initial: 0,
    people: rangeOf(axis),
    format: (value) => (value === 0 ? "0" : `${signed(value)} SD`),
    onInput: (value) => store.change({ ...axis.moved(store.state, value), ...leaveMeans(store) }),
  });
}
