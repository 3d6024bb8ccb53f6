/** The population as a cloud of points along two axes, with the present walker. */

import { capitalised, classOf, colourLegend, mainTrait } from "../model/labels";
import { mixedVector } from "../model/mixing";
import type { Model } from "../model/model";
import { positionOf } from "../model/features";
import { clamped, RANGES } from "../model/state";
import { draw, freshId, make, setAttributes } from "../page/elements";
import type { Axis } from "./axis";
import { pick } from "./controls";
import { note } from "./parts";
import type { Now, Part, Store } from "./store";

const WIDTH = 360;
const HEIGHT = 300;
/** Standard deviations from the middle to each edge. */
const REACH = 6.6;
/** Walkers that the page holds are circles; all others are one path. */
const RADIUS = 3.4;
/** A click within this distance of a point selects it. */
const NEAR = 24;

interface Place {
  readonly x: number;
  readonly y: number;
}

interface Point {
  readonly walker: number;
  readonly cloud: number;
  readonly circle: SVGCircleElement;
  x: number;
  y: number;
}

/** Right and down. */
type Direction = readonly [number, number];

const ARROWS: Readonly<Record<string, Direction>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

const across = (sd: number): number => WIDTH / 2 + (sd / REACH) * (WIDTH / 2);
const down = (sd: number): number => HEIGHT / 2 - (sd / REACH) * (HEIGHT / 2);
const inside = (sd: number): number => clamped([-REACH + 0.2, REACH - 0.2], sd);

export function cloud(store: Store): Part | HTMLElement {
  const { model, axes } = store;
  const [first, second = first] = [axes[0], axes[Math.max(model.traits.length, 1)]];
  if (!first || !second) return note("Too few walkers to differ.");
  let [x, y] = [first, second];
  const points = pointsOf(model);
  const rest = draw("path", { class: "rest" });
  const trail = draw("line", { class: "trail" });
  const cross = draw("g", { class: "here" }, draw("circle", { r: 9, class: "halo" }), draw("circle", { r: 5 }));
  const names = draw("g");
  const chart = draw("svg",
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "listbox", tabindex: 0, class: "cloud",
      "aria-label": "Walkers of the population. Arrow keys go to the next one, Enter lets it walk.",
    },
    ...grid(), rest, trail, names, ...points.map(({ circle }) => circle), cross,
  );
  const legend = colourLegend(mainTrait(model));
  const help = `Choose a point, and that walker walks.${legend && ` ${capitalised(legend)}.`}`;
  const text = make("p", { class: "note steady", "aria-hidden": "true" });
  let active = -1;
  let last: Now | undefined;

  const activate = (number: number): void => {
    active = number;
    const point = points[number];
    points.forEach(({ circle }) => circle.classList.toggle("active", circle === point?.circle));
    setAttributes(chart, { "aria-activedescendant": point?.circle.id });
    text.textContent = point ? model.walkers[point.walker]!.name : help;
  };
  const select = (number: number): void => {
    const point = points[number];
    if (!point) return;
    activate(number);
    const unchanged = { traits: {}, bias: null, eigenwalkers: model.eigenwalkers.map(() => 0) };
    store.change({ from: point.walker, scene: "one", ...unchanged });
  };
  const layOut = (): void => {
    const placeOf = (cloud: number): Place => ({
      x: across(inside(x.points[cloud]!)),
      y: down(inside(y.points[cloud]!)),
    });
    for (const point of points) {
      Object.assign(point, placeOf(point.cloud));
      setAttributes(point.circle, { cx: point.x.toFixed(1), cy: point.y.toFixed(1) });
    }
    const others = [...model.cloud.walker.keys()].filter((i) => !model.walkers[model.cloud.walker[i]!]).map(placeOf);
    setAttributes(rest, { d: others.map((at) => `M${at.x.toFixed(1)} ${at.y.toFixed(1)}h0`).join("") });
    names.replaceChildren(...axisNames(x, y));
    if (last) show(last);
  };
  const show = (now: Now): void => {
    last = now;
    const [h, v] = [across(inside(x.at(now.position))), down(inside(y.at(now.position)))];
    cross.setAttribute("transform", `translate(${h.toFixed(1)} ${v.toFixed(1)})`);
    setAttributes(trail, trailOf(now, first, x, y));
    const { scene, from } = now.state;
    for (const mark of [cross, trail]) setAttributes(mark, { visibility: scene === "one" ? undefined : "hidden" });
    for (const { circle, walker } of points) setAttributes(circle, { "aria-selected": String(from === walker) });
  };
  const axisPick = (name: string, initial: Axis, choose: (axis: Axis) => void): HTMLElement => {
    const { element, show } = pick(name, axes.map((value) => ({ value, label: value.label })), (axis) => {
      choose(axis);
      layOut();
    });
    show(initial);
    return element;
  };

  const atPointer = (event: MouseEvent): number =>
    nearestPoint(points, placeInChart(chart, event), (NEAR * WIDTH) / chart.clientWidth);
  chart.addEventListener("pointermove", (event) => activate(atPointer(event)));
  chart.addEventListener("pointerleave", () => activate(-1));
  chart.addEventListener("click", (event) => select(atPointer(event)));
  chart.addEventListener("focus", () => active < 0 && chart.matches(":focus-visible") && activate(0));
  chart.addEventListener("blur", () => activate(-1));
  chart.addEventListener("keydown", (event) => {
    const direction = ARROWS[event.key];
    if (direction) activate(nextPoint(points, active, direction));
    else if (event.key === "Enter" || event.key === " ") select(active);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  layOut();
  activate(-1);
  const picks = make("div", { class: "pair" },
    axisPick("Across", x, (axis) => (x = axis)),
    axisPick("Up", y, (axis) => (y = axis)));
  return { element: make("div", {}, chart, text, picks), show };
}

function pointsOf(model: Model): Point[] {
  return model.cloud.walker.flatMap((walker, cloud) => {
    const known = model.walkers[walker];
    if (!known) return [];
    const option = { role: "option", id: freshId(), "aria-label": known.name };
    const circle = draw("circle", { r: RADIUS, class: `person ${classOf(model, walker)}`, ...option });
    return [{ walker, cloud, circle, x: 0, y: 0 }];
  });
}

const grid = (): SVGElement[] =>
  [-6, -3, 0, 3, 6].flatMap((sd) => {
    const kind = sd === 0 ? "axis zero" : "axis";
    return [
      draw("line", { class: kind, x1: across(sd), x2: across(sd), y1: 0, y2: HEIGHT }),
      draw("line", { class: kind, y1: down(sd), y2: down(sd), x1: 0, x2: WIDTH }),
    ];
  });

function axisNames(x: Axis, y: Axis): SVGTextElement[] {
  const [[left, right], [below, above]] = [x, y].map(({ trait, ends, label }) =>
    trait ? ends : (["", label.toLowerCase()] as const),
  ) as [readonly [string, string], readonly [string, string]];
  const text = (words: string, x: number, y: number, anchor: string) =>
    draw("text", { x, y, "text-anchor": anchor }, words);
  return [
    text(left && `\u2190 ${left}`, 8, HEIGHT / 2 - 7, "start"),
    text(`${right} \u2192`, WIDTH - 8, HEIGHT / 2 - 7, "end"),
    text(below && `\u2193 ${below}`, WIDTH / 2 + 8, HEIGHT - 9, "start"),
    text(`\u2191 ${above}`, WIDTH / 2 + 8, 16, "start"),
  ];
}

/** The line along which a slider moves the walker: that of a trait on an axis, else the large slider. */
function trailOf({ model, state, own }: Now, main: Axis, x: Axis, y: Axis): Record<string, string> {
  const axis = [x, y].find(({ trait }) => trait !== null) ?? main;
  const [start, end] = RANGES.trait.map((steps) =>
    positionOf(model, mixedVector(model, { ...state, ...axis.moved(state, steps) }, own)),
  );
  return {
    x1: across(x.at(start!)).toFixed(1), y1: down(y.at(start!)).toFixed(1),
    x2: across(x.at(end!)).toFixed(1), y2: down(y.at(end!)).toFixed(1),
  };
}

function placeInChart(chart: SVGSVGElement, event: MouseEvent): Place {
  const box = chart.getBoundingClientRect();
  const scale = WIDTH / chart.clientWidth;
  return {
    x: (event.clientX - box.left - chart.clientLeft) * scale,
    y: (event.clientY - box.top - chart.clientTop) * scale,
  };
}

/** The number of the nearest point, -1 if none is within a distance. */
export function nearestPoint(points: readonly Place[], { x, y }: Place, within: number): number {
  const distances = points.map((point) => Math.hypot(point.x - x, point.y - y));
  const best = distances.indexOf(Math.min(...distances));
  return best >= 0 && distances[best]! < within ? best : -1;
}

/** The nearest point in a direction, not too far aside; the same point if there is none. */
export function nextPoint(points: readonly Place[], from: number, [right, below]: Direction): number {
  const here = points[from];
  if (!here) return 0;
  let [best, least] = [from, Infinity];
  points.forEach((point, number) => {
    const [h, v] = [point.x - here.x, point.y - here.y];
    const ahead = h * right + v * below;
    const aside = Math.abs(h * below) + Math.abs(v * right);
    const cost = ahead + 2 * aside;
    if (ahead > 0 && aside <= 2 * ahead && cost < least) [best, least] = [number, cost];
  });
  return best;
}
