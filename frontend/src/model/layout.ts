/** Which number of a feature vector is what, as `eigenwalker.population.features` has it (J11, A2). */

import type { Model, Span } from "./model";

export const blockOf = ({ layout }: Pick<Model, "layout">, block: string): Span | undefined =>
  Object.hasOwn(layout, block) ? layout[block] : undefined;

const found = new WeakMap<Model["layout"], Map<string, readonly number[]>>();

/** Columns of a part of the features, in increasing order: a block, or several joined by "+". */
export function columnsOf({ layout }: Pick<Model, "layout">, part: string): readonly number[] {
  const known = found.get(layout) ?? new Map<string, readonly number[]>();
  found.set(layout, known);
  const columns = known.get(part) ?? gather({ layout }, part);
  known.set(part, columns);
  return columns;
}

function gather(model: Pick<Model, "layout">, part: string): number[] {
  const blocks = Object.keys(model.layout);
  const gathered: Readonly<Record<string, readonly string[]>> = {
    all: blocks,
    structure: ["p0"],
    dynamics: blocks.filter((block) => block !== "p0"),
    postures: blocks.filter((block) => /^p\d+$/.test(block)),
    timing: blocks.filter((block) => !/^p\d+$/.test(block)),
  };
  const chosen = part.split("+").flatMap((name) => {
    const inside = Object.hasOwn(gathered, name) ? gathered[name]! : [name];
    return inside.flatMap((block) => {
      const span = blockOf(model, block);
      if (!span) throw new Error(`There is no part "${block}"; there are ${blocks.join(", ")}.`);
      return Array.from({ length: span[1] - span[0] }, (_, i) => span[0] + i);
    });
  });
  return [...new Set(chosen)].sort((a, b) => a - b);
}
