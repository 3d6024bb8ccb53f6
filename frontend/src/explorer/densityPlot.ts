/** The density of people along a trait: a curve for each class, behind the track of a slider. */

import { classOf } from "../model/axisLabels";
import type { Model } from "../model/model";
import { RANGES } from "../model/state";
import { draw } from "../page/elements";
import type { Axis } from "./axis";

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
