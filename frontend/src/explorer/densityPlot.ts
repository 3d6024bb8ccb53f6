/** How many real people lie where along a trait: a hill for each class, drawn behind a track. */

import type { Model } from "../model/model";
import { RANGES } from "../model/state";
import type { Axis } from "./axis";
import { draw } from "../page/element";
import { classOf } from "./labels";

/** Standard deviation by which each person is blurred, in standard deviations of the trait. */
const BLUR = 0.32;
const N_PLACES = 121;
const HEIGHT = 100;

/** Hills over -6 to 6: one for each class of a trait of two, else one. */
export function ridge(model: Model, axis: Axis): SVGSVGElement {
  const groups = grouped(model, axis);
  const heights = groups.map(({ positions }) => density(positions));
  const highest = Math.max(...heights.flat(), Number.MIN_VALUE);
  return draw(
    "svg",
    { viewBox: `0 0 ${N_PLACES - 1} ${HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true" },
    ...groups.map(({ kind }, i) => draw("path", { class: `ridge ${kind}`, d: outline(heights[i]!, highest) })),
  );
}

interface Group {
  readonly kind: "negative" | "positive" | "all";
  readonly positions: readonly number[];
}

function grouped(model: Model, { points, trait }: Axis): Group[] {
  if (!trait?.two_classes) return [{ kind: "all", positions: points }];
  return (["negative", "positive"] as const).map((kind) => ({
    kind,
    positions: points.filter((_, i) => classOf(model, model.cloud.walker[i]!) === kind),
  }));
}

function density(positions: readonly number[]): number[] {
  const [low, high] = RANGES.trait;
  return Array.from({ length: N_PLACES }, (_, i) => {
    const place = low + ((high - low) * i) / (N_PLACES - 1);
    return positions.reduce((sum, at) => sum + Math.exp(-(((place - at) / BLUR) ** 2) / 2), 0);
  });
}

function outline(heights: readonly number[], highest: number): string {
  const points = heights.map((height, i) => `${i} ${(HEIGHT * (1 - height / highest)).toFixed(1)}`);
  return `M0 ${HEIGHT}L${points.join("L")}L${N_PLACES - 1} ${HEIGHT}Z`;
}
