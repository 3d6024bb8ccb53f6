/**
 * Sliders of the traits, the first one large with the density of people, and of the eigenwalkers; Moler's controls:
 * the strength of each component, each component alone, and the bias towards a class.
 */

import { entry } from "../core/schema";
import { componentName } from "../model/captions";
import { capitalised, classOf, endLabels, SIZE_HINT } from "../model/labels";
import { partsOf } from "../model/mixing";
import type { Kind, Model } from "../model/model";
import { clamped, RANGES, type State } from "../model/state";
import { button, draw, make, signed } from "../page/elements";
import { rangeOf, type Axis } from "./axis";
import { choice, pick, slider, toggle, type Option, type Slider } from "./controls";
import { bound, group, note } from "./parts";
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
  if (!axis) return group({});
  const one = axisSlider(store, axis);
  one.element.classList.add("large", "fresh");
  one.input.addEventListener("input", () => one.element.classList.remove("fresh"));
  const beyond = () => make("span", { class: "beyond" }, "beyond anyone");
  const scale = make("div", { class: "scale", "aria-hidden": "true" },
    ...SCALE.map((at) => (Math.abs(at) === 4.5 ? beyond() : make("span", {}, signed(at, 0)))),
  );
  const mark = make("i", { class: "mark", "aria-hidden": "true" }, make("span"));
  one.element.append(make("div", { class: "hill" }, densityPlot(store.model, axis), mark), scale);
  return {
    element: one.element,
    show(now) {
      one.show(now);
      showMark(mark, axis.at(now.position), now.state.scene === "one" ? axis.value(now.state) : null);
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

export const otherTraits = (store: Store): Part =>
  sliders(store, store.axes.slice(1).filter(({ trait }) => trait !== null));

export function eigenwalkerSliders(store: Store): Part {
  const { eigenwalkers } = store.model;
  const axes = store.axes.filter(({ trait }) => trait === null);
  const labels = axes.map(({ label }, i) => `${label} \u00b7 ${Math.round(100 * eigenwalkers[i]!.share)} % of the variance`);
  return sliders(store, axes, labels);
}

/** A slider for each axis, with names of its ends, or with a label. */
const sliders = (store: Store, axes: readonly Axis[], labels: readonly string[] = []): Part =>
  group({ class: "sliders" }, ...axes.map((axis, i) => axisSlider(store, axis, labels[i])));

/** Moving a slider leaves the mean walkers, which no slider changes. */
const leaveMeans = ({ state }: Store): Partial<State> => (state.scene === "four" ? { scene: "one" } : {});

function axisSlider(store: Store, axis: Axis, label?: string): Part & Pick<Slider, "input"> {
  const [min, max] = RANGES.trait;
  const one = slider({
    label: label ?? axis.label,
    ...(label === undefined ? { ends: axis.ends } : {}),
    min, max, step: 0.05, initial: 0,
    people: rangeOf(axis),
    format: (value) => (value === 0 ? "0" : `${signed(value)} SD`),
    onInput: (value) => store.change({ ...axis.moved(store.state, value), ...leaveMeans(store) }),
  });
  return {
    ...one,
    show({ state }) {
      one.show(axis.value(state));
      one.element.classList.toggle("idle", state.scene === "four");
    },
  };
}

export function strengthControls(store: Store): Part {
  const [min, max] = RANGES.strength;
  const strengths = (): readonly number[] => store.state.strengths;
  const rows = store.model.harmonics.map((_, number) => {
    const label = capitalised(componentName(number));
    const one = slider({
      label, min, max, step: 0.05, initial: 1,
      format: (value) => `\u00d7 ${value.toFixed(2).replace("-", "\u2212")}`,
      onInput: (value) => store.change({ strengths: strengths().with(number, value) }),
    });
    const alone = button("alone", () => {
      const already = isAlone(strengths(), number);
      store.change({ strengths: strengths().map((_, i) => Number(already || i === number)) });
    }, { class: "small", "aria-label": `${label} alone` });
    one.element.classList.add("solo");
    one.element.querySelector("output")?.after(alone);
    const show = (strengths: readonly number[]): void => {
      one.show(strengths[number] ?? 1);
      alone.setAttribute("aria-pressed", String(isAlone(strengths, number)));
    };
    return bound({ element: one.element, show }, (state) => state.strengths);
  });
  return group({ class: "sliders" }, ...rows);
}

const isAlone = (strengths: readonly number[], number: number): boolean =>
  strengths.every((strength, i) => strength === Number(i === number));

/** A slider of the bias for each trait of two classes. */
export function biasControls(store: Store): Part {
  const [min, max] = RANGES.bias;
  const rows = store.model.traits.filter(({ means }) => means !== null).flatMap((trait) => {
    const means = `the mean ${endLabels(trait).join(" and the mean ")}`;
    const one = slider({
      label: `Bias of ${trait.label}`,
      ends: endLabels(trait),
      min, max, step: 0.05, initial: 0,
      people: [-1, 1],
      format: (value) => signed(value),
      onInput: (steps) =>
        store.change({ bias: steps === 0 ? null : { trait: trait.name, steps }, ...leaveMeans(store) }),
    });
    return [
      note(`Bias: 0 is as it is, \u00b11 half the way between ${means}.`),
      bound(one, ({ bias }) => (bias?.trait === trait.name ? bias.steps : 0)),
    ];
  });
  return group({ class: "sliders" }, ...rows);
}

const PARTS: Readonly<Record<string, Omit<Option<string>, "value">>> = {
  all: { label: "Everything", hint: "All that a walk consists of" },
  structure: { label: "Body only", hint: "The mean posture: how people are built" },
  dynamics: { label: "Motion only", hint: "How they move, whatever their build" },
  p1: { label: "Stride (p1)" },
  p2: { label: "Sway (p2)" },
  p3: { label: "Hop (p3)" },
  p4: { label: "Bounce (p4)" },
  frequency: { label: "Frequency" },
  phases: { label: "Phases" },
};
const COMMON = ["all", "structure", "dynamics"];

const KINDS: readonly Option<Kind>[] = [
  { value: "discriminant", label: "Tells best", hint: "The discriminant: what a classifier looks for (Troje)" },
  { value: "mean_difference", label: "Differs most", hint: "The difference between mean walkers (Moler)" },
];

/** The part of the features that traits change, and the kind of their direction. */
export function classifierControls(store: Store): Part {
  const options = partsOf(store.model).map((value): Option<string> => {
    return { value, ...(entry(PARTS, value) ?? { label: capitalised(value) }) };
  });
  const [common, rest] = [true, false].map((is) => options.filter(({ value }) => COMMON.includes(value) === is));
  const choose = (part: string): void => store.change({ part: part || "all" });
  const parts = choice("What the sliders may change", common!, choose);
  const single = pick("or one part of the motion", [{ value: "", label: "\u2013" }, ...rest!], choose);
  const kind = choice("Direction", KINDS, (value) => store.change({ kind: value }));
  const about = note("");
  const describe = (kind: Kind): void => {
    about.textContent =
      kind === "discriminant"
        ? "The direction that tells people apart best: one step is one standard deviation of the walkers."
        : "From the mean of one class to the mean of the other: shows best what goes along with a trait.";
  };
  const size = toggle("Keep people's size", (keepSize) => store.change({ keepSize }), SIZE_HINT);
  return group({},
    ...(store.model.keepSize === undefined ? [] : [bound(size, (state) => state.keepSize)]),
    bound(parts, (state) => state.part),
    ...(rest!.length > 0 ? [bound(single, ({ part }) => (COMMON.includes(part) ? "" : part))] : []),
    bound(kind, (state) => state.kind),
    bound({ element: about, show: describe }, (state) => state.kind));
}

/** Standard deviation of the kernel, in standard deviations of the trait. */
const KERNEL_SD = 0.32;
const N_PLACES = 121;
const HEIGHT = 100;

/** Curves over the range of the slider: one for each class of a trait of two classes, else one. */
export function densityPlot(model: Model, { points, trait }: Axis): SVGSVGElement {
  const kinds = trait?.two_classes ? (["negative", "positive"] as const) : (["all"] as const);
  const curves = kinds.map((kind) =>
    density(points.filter((_, i) => kind === "all" || classOf(model, model.cloud.walker[i]!) === kind)),
  );
  const highest = Math.max(...curves.flat(), Number.MIN_VALUE);
  return draw(
    "svg",
    { viewBox: `0 0 ${N_PLACES - 1} ${HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true" },
    ...kinds.map((kind, i) => draw("path", { class: `density ${kind}`, d: outline(curves[i]!, highest) })),
  );
}

function density(positions: readonly number[]): number[] {
  const [low, high] = RANGES.trait;
  return Array.from({ length: N_PLACES }, (_, i) => {
    const place = low + ((high - low) * i) / (N_PLACES - 1);
    return positions.reduce((sum, at) => sum + Math.exp(-(((place - at) / KERNEL_SD) ** 2) / 2), 0);
  });
}

function outline(heights: readonly number[], highest: number): string {
  const points = heights.map((height, i) => `${i} ${(HEIGHT * (1 - height / highest)).toFixed(1)}`);
  return `M0 ${HEIGHT}L${points.join("L")}L${N_PLACES - 1} ${HEIGHT}Z`;
}
