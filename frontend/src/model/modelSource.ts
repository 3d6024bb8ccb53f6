/** A model with the walkers' size, and the same without it. */

import type { Model } from "./model";
import { readModel } from "./readModel";

/** A model, and the name of its population on the server; empty if the server does not hold it. */
export interface ModelSource {
  readonly model: Model;
  /** The same walkers with their size, if the model's are without it, or the other way round. */
  readonly other: Model | null;
  readonly population: string;
}

export function modelSourceOf(content: unknown): ModelSource {
  const population = content && typeof content === "object" && "population" in content ? content.population : "";
  const named = { population: typeof population === "string" ? population : "" };
  const model = readModel(content);
  if (!content || typeof content !== "object" || !("other_size" in content)) return { model, other: null, ...named };
  const keepSize = model.size_kept;
  return { model: { ...model, keepSize }, other: { ...readModel(content.other_size), keepSize }, ...named };
}

/** A source whose walkers have their size, or not; as it is where that cannot be chosen. */
export const withSize = (source: ModelSource, keep: boolean): ModelSource =>
  source.other && source.model.size_kept !== keep ? { ...source, model: source.other, other: source.model } : source;
