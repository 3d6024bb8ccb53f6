/** The population as a cloud of points along two axes; the walker now made moves through it. */

import { vectorOf } from "../model/mixing";
import type { Model } from "../model/model";
import { placeOf } from "../model/position";
import { RANGES } from "../model/state";
import type { Axis } from "./axis";
import { pick } from "./choice";
import { draw, freshId, make, put } from "../page/element";
import { nearest, towards, type Place, type Way } from "./nearestPoint";
import { words } from "./section";
import type { Now, Part, Session } from "./store";
import { capital, classOf, colours, mainTrait } from "./labels";

const WIDTH = 360;
const HEIGHT = 300;
/** Standard deviations from the middle to each edge. */
const REACH = 6.6;
/** Points that can be reached have their circles; of the rest one path is drawn. */
const RADIUS = 3.4;
/** A click within this distance of a point means the point. */
const NEAR = 24;

interface Point {
  readonly walker: number;
  readonly cloud: number;
  readonly circle: SVGCircleElement;
  x: number;
  y: number;
}

const across = (sd: number): number => WIDTH / 2 + (sd / REACH) * (WIDTH / 2);
const down = (sd: number): number => HEIGHT / 2 - (sd / REACH) * (HEIGHT / 2);

export function cloud(session: Session): Part {
  const { model, axes } = session;
  const [first, second = first] = [axes[0], axes[Math.max(model.traits.length, 1)]];
  if (!first || !second) return words("Too few walkers to differ.");
  let [x, y] = [first, second];
  const points = pointsOf(model);
  const rest = draw("path", { class: "rest" });
  const trail = draw("line", { class: "trail" });
  const cross = draw("g", { class: "here" }, draw("circle", { r: 9, class: "halo" }), draw("circle", { r: 5 }));
  const names = [draw("text"), draw("text"), draw("text"), draw("text")];
  const chart = draw("svg",
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "listbox", tabindex: 0, class: "cloud",
      "aria-label": "Walkers of the population. Arrow keys go to the next one, Enter lets it walk.",
    },
    ...grid(), rest, trail, ...names, ...points.map(({ circle }) => circle), cross,
  );
  const said = make("p", { class: "note steady", "aria-hidden": "true" });
  let active = -1;
  let last: Now | undefined;

  const activate = (number: number): void => {
    active = number;
    points.forEach(({ circle }, i) => circle.classList.toggle("active", i === number));
    const point = points[number];
    if (point) chart.setAttribute("aria-activedescendant", point.circle.id);
    else chart.removeAttribute("aria-activedescendant");
    said.textContent = point ? model.walkers[point.walker]!.name : usually(model);
  };
  const walk = (number: number): void => {
    const point = points[number];
    if (!point) return;
    activate(number);
    const unchanged = { traits: {}, bias: null, eigenwalkers: model.eigenwalkers.map(() => 0) };
    session.change({ from: point.walker, scene: "one", ...unchanged });
  };
  const lay = (): void => {
    points.forEach((point) => {
      point.x = across(held(x.points[point.cloud]!));
      point.y = down(held(y.points[point.cloud]!));
      put(point.circle, { cx: point.x.toFixed(1), cy: point.y.toFixed(1) });
    });
    put(rest, { d: restOf(model, x, y) });
    label(names, x, y);
    if (last) move(last);
  };
  const move = (now: Now): void => {
    last = now;
    const [h, v] = [across(held(x.at(now.place))), down(held(y.at(now.place)))];
    cross.setAttribute("transform", `translate(${h.toFixed(1)} ${v.toFixed(1)})`);
    put(trail, trailOf(now, first, x, y));
    for (const mark of [cross, trail]) put(mark, { visibility: now.state.scene === "one" ? undefined : "hidden" });
    points.forEach(({ circle, walker }) => put(circle, { "aria-selected": String(now.state.from === walker) }));
  };
  const choose = (name: string, first: boolean) => {
    const picked = pick(name, axes.map((value) => ({ value, label: value.label })), (axis) => {
      if (first) x = axis;
      else y = axis;
      lay();
    });
    picked.show(first ? x : y);
    return picked.element;
  };

  const meant = (event: MouseEvent): number =>
    nearest(points, under(chart, event), (NEAR * WIDTH) / chart.clientWidth);
  chart.addEventListener("pointermove", (event) => activate(meant(event)));
  chart.addEventListener("pointerleave", () => activate(-1));
  chart.addEventListener("click", (event) => walk(meant(event)));
  chart.addEventListener("focus", () => active < 0 && chart.matches(":focus-visible") && activate(0));
  chart.addEventListener("blur", () => activate(-1));
  chart.addEventListener("keydown", (event) => {
    const way = WAYS[event.key];
    if (way) activate(towards(points, active, way));
    else if (event.key === "Enter" || event.key === " ") walk(active);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  lay();
  activate(-1);
  const axesToChoose = make("div", { class: "pair" }, choose("Across", true), choose("Up", false));
  return {
    element: make("div", {}, chart, said, axesToChoose),
    show: move,
  };
}

const held = (sd: number): number => Math.min(Math.max(sd, -REACH + 0.2), REACH - 0.2);

function pointsOf(model: Model): Point[] {
  return model.cloud.walker.flatMap((walker, cloud) => {
    const known = model.walkers[walker];
    if (!known) return [];
    const kind = `person ${classOf(model, walker)}`;
    const option = { role: "option", id: freshId(), "aria-label": known.name };
    const circle = draw("circle", { r: RADIUS, class: kind, ...option });
    return [{ walker, cloud, circle, x: 0, y: 0 }];
  });
}

/** Points that stand for someone whom the page does not hold. */
function restOf(model: Model, x: Axis, y: Axis): string {
  return model.cloud.walker
    .flatMap((walker, i) => {
      if (model.walkers[walker]) return [];
      const [h, v] = [across(held(x.points[i]!)), down(held(y.points[i]!))];
      return [`M${h.toFixed(1)} ${v.toFixed(1)}h0`];
    })
    .join("");
}

function grid(): SVGElement[] {
  const marks = [-6, -3, 0, 3, 6];
  return marks.flatMap((mark) => {
    const kind = mark === 0 ? "axis zero" : "axis";
    return [
      draw("line", { class: kind, x1: across(mark), x2: across(mark), y1: 0, y2: HEIGHT }),
      draw("line", { class: kind, y1: down(mark), y2: down(mark), x1: 0, x2: WIDTH }),
    ];
  });
}

function label([left, right, lower, upper]: readonly SVGTextElement[], x: Axis, y: Axis): void {
  type At = Readonly<Record<string, string | number>>;
  const write = (text: SVGTextElement | undefined, words: string, at: At): void => {
    text?.replaceChildren(words);
    if (text) put(text, at);
  };
  const [toLeft, toRight] = namesOf(x);
  const [below, above] = namesOf(y);
  write(left, toLeft && `\u2190 ${toLeft}`, { x: 8, y: HEIGHT / 2 - 7, "text-anchor": "start" });
  write(right, `${toRight} \u2192`, { x: WIDTH - 8, y: HEIGHT / 2 - 7, "text-anchor": "end" });
  write(lower, below && `\u2193 ${below}`, { x: WIDTH / 2 + 8, y: HEIGHT - 9, "text-anchor": "start" });
  write(upper, `\u2191 ${above}`, { x: WIDTH / 2 + 8, y: 16, "text-anchor": "start" });
}

const namesOf = ({ trait, ends, label }: Axis): readonly [string, string] =>
  trait ? ends : ["", label.toLowerCase()];

/** Where a slider leads: that of a trait which is an axis here, else the large one. */
function trailOf({ model, state, own }: Now, main: Axis, x: Axis, y: Axis): Record<string, string> {
  const axis = [x, y].find(({ trait }) => trait !== null) ?? main;
  const [start, stop] = RANGES.trait.map((steps) =>
    placeOf(model, vectorOf(model, { ...state, ...axis.moved(state, steps) }, own)),
  );
  return {
    x1: across(x.at(start!)).toFixed(1), y1: down(y.at(start!)).toFixed(1),
    x2: across(x.at(stop!)).toFixed(1), y2: down(y.at(stop!)).toFixed(1),
  };
}

function usually(model: Model): string {
  const legend = colours(mainTrait(model));
  return `Choose a point, and that walker walks.${legend && ` ${capital(legend)}.`}`;
}

/** Where on the chart a pointer is. */
function under(chart: SVGSVGElement, event: MouseEvent): Place {
  const box = chart.getBoundingClientRect();
  const scale = WIDTH / chart.clientWidth;
  const across = event.clientX - box.left - chart.clientLeft;
  const down = event.clientY - box.top - chart.clientTop;
  return { x: across * scale, y: down * scale };
}

const WAYS: Readonly<Record<string, Way>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
