/** @vitest-environment jsdom */
/** The small plots: the line leads through the walker that is shown. */

import { expect, it } from "vitest";
import { measurePlots } from "../src/explorer/measurePlots";
import { Store } from "../src/explorer/store";
import { initialState, type State } from "../src/model/state";
import { goldenModel } from "./golden_model";

const model = goldenModel();

function plotted(part: Partial<State>): { points: string[][]; dots: string[]; hidden: boolean | string } {
  const store = new Store(model, { ...initialState(model), ...part });
  const { element, show } = measurePlots(store);
  show(store.now());
  const lines = [...element.querySelectorAll("polyline")].map((line) => line.getAttribute("points")?.split(" ") ?? []);
  const dots = [...element.querySelectorAll("circle.now:not(.beyond)")].map((dot) => `${dot.getAttribute("cx")},${dot.getAttribute("cy")}`);
  return { points: lines, dots, hidden: element.hidden };
}

it.each<[string, Partial<State>]>([
  ["the average", {}],
  ["a walker of the population", { from: 1 }],
  ["one of another weight", { traits: { sex: 0.5, weight_kg: 0.5 } }],
  ["one of whom only the motion is changed", { traits: { sex: 1 }, part: "dynamics" }],
  ["one along an eigenwalker", { eigenwalkers: [0.5] }],
])("the line leads through the walker: %s", (_, part) => {
  const { points, dots } = plotted(part);
  expect(points.length).toBeGreaterThan(4);
  expect(dots.length).toBeGreaterThan(0);
  const all = points.flat();
  for (const dot of dots) expect(all).toContain(dot);
});

it("the line has no level stretch at an edge: across, its points are evenly apart", () => {
  const { points } = plotted({ from: 1 });
  const x = [...new Set(points[0]!.map((point) => Number(point.split(",")[0])))];
  expect(x.every((each, i) => i === 0 || each > x[i - 1]!)).toBe(true);
});

it("one walker's numbers are not shown where several walk", () => {
  expect(plotted({ scene: "one" }).hidden).toBe(false);
  expect(plotted({ scene: "four" }).hidden).toBe(true);
});
