/** Sliders of the traits: the first one large below the stage, the others beside it. */

import { RANGES, within, type State } from "../model/state";
import { realRange, type Axis } from "./axis";
import { make } from "../page/element";
import { ridge } from "./densityPlot";
import type { Part, Session } from "./store";
import { signed, slider, type Slider } from "./slider";

/** So far from the thumb, a walker has a mark of its own. */
const MARKED_SD = 0.1;
/** Places of the scale below the large slider. */
const SCALE = [-6, -4.5, -3, 0, 3, 4.5, 6];

/**
 * The large slider, with the people there are as hills behind its track. Its thumb says how far the
 * walker was led; a mark on the hills, where the walker that came of it lies among the people.
 */
export function mainSlider(session: Session): Part {
  const [axis] = session.axes;
  const element = make("div", { class: "hero" });
  if (!axis) return { element, show: () => {} };
  const one = axisSlider(session, axis);
  one.element.classList.add("large", "fresh");
  one.input.addEventListener("input", () => one.element.classList.remove("fresh"));
  const far = (): HTMLElement => make("span", { class: "beyond" }, "beyond anyone");
  const scale = make("div", { class: "scale", "aria-hidden": "true" },
    ...SCALE.map((mark) => (Math.abs(mark) === 4.5 ? far() : make("span", {}, signed(mark, 0)))),
  );
  const mark = make("i", { class: "mark", "aria-hidden": "true" }, make("span"));
  one.element.append(make("div", { class: "hill" }, ridge(session.model, axis), mark), scale);
  element.append(one.element);
  return {
    element,
    show({ state, place }) {
      one.show(axis.value(state));
      one.element.classList.toggle("idle", state.scene === "four");
      showMark(mark, axis.at(place), state.scene === "one" ? axis.value(state) : null);
    },
  };
}

/** Mark where the walker lies, where that is not where the thumb stands. */
function showMark(mark: HTMLElement, score: number, thumb: number | null): void {
  const [low, high] = RANGES.trait;
  mark.hidden = thumb === null || Math.abs(score - thumb) < MARKED_SD;
  mark.style.setProperty("--at", String(within([0, 1], (score - low) / (high - low))));
  mark.classList.toggle("left", score < (low + high) / 2);
  mark.firstElementChild!.textContent = `this walker ${signed(score)}`;
}

/** Sliders of all traits but the first. */
export function otherTraits(session: Session): Part {
  return sliders(session, session.axes.slice(1).filter(({ trait }) => trait !== null));
}

/** Eigenwalkers as sliders: what varies most among walkers, whatever it means. */
export function eigenwalkerSliders(session: Session): Part {
  const { eigenwalkers } = session.model;
  const axes = session.axes.filter(({ trait }) => trait === null);
  const shares = eigenwalkers.map(({ share }) => `${Math.round(100 * share)} % of the variance`);
  return sliders(session, axes, (axis, i) => `${axis.label} \u00b7 ${shares[i]}`);
}

/** A slider for each axis, with names of its ends, or under a label of its own. */
function sliders(session: Session, axes: readonly Axis[], label?: (axis: Axis, i: number) => string): Part {
  const all = axes.map((axis, i) => axisSlider(session, axis, label?.(axis, i)));
  return {
    element: make("div", { class: "sliders" }, ...all.map(({ element }) => element)),
    show: ({ state }) =>
      all.forEach((one, i) => {
        one.show(axes[i]!.value(state));
        one.element.classList.toggle("idle", state.scene === "four");
      }),
  };
}

/** Mean walkers are what they are: who moves a slider wants to see one that it changes. */
export const leftMeans = ({ state }: Session): Partial<State> => (state.scene === "four" ? { scene: "one" } : {});

function axisSlider(session: Session, axis: Axis, label?: string): Slider {
  const [min, max] = RANGES.trait;
  return slider({
    label: label ?? axis.label,
    ...(label === undefined ? { ends: axis.ends } : {}),
    min,
    max,
    step: 0.05,
    usual: 0,
    real: realRange(axis),
    said: (value) => (value === 0 ? "0" : `${signed(value)} SD`),
    onInput: (value) => session.change({ ...axis.moved(session.state, value), ...leftMeans(session) }),
  });
}
