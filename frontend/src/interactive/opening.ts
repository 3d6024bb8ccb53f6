/** Files that someone brings: a model, a stimulus, a population, a capture. */

import { NoStimulus, readStimulus } from "../core/check";
import type { Model, Own } from "../model/model";
import { readModel } from "../model/read";
import { ownOf } from "./own";
import { CannotOpen } from "./refusal";
import { hasServer, readCapture, readPopulation } from "./server";

/** What a file turned out to be. */
export type Opened =
  | { readonly kind: "model"; readonly model: Model }
  | { readonly kind: "own"; readonly own: Own; readonly told: readonly string[] };

/** More than any text that the page itself reads. */
const MOST_TEXT_BYTES = 64e6;
const POPULATION = /\.nc$/i;
const TEXT = /\.json$/i;

/** Read one file, by the page itself where it can, else by the server. */
export async function openFile(file: File, model: Model | null): Promise<Opened> {
  if (TEXT.test(file.name)) return openText(file, model);
  const what = POPULATION.test(file.name) ? "a population" : "a capture";
  if (!hasServer()) {
    throw new CannotOpen(
      `${file.name}: a page alone cannot read ${what}. Run "eigenwalker serve" and drop it there.`,
    );
  }
  if (POPULATION.test(file.name)) return { kind: "model", model: readModel(await readPopulation(file)) };
  const { name, vector, told } = await readCapture(file);
  if (model && vector.length !== model.average.length) {
    throw new CannotOpen(`${file.name} came as ${vector.length} numbers; walkers here have ${model.average.length}.`);
  }
  return { kind: "own", own: { name, vector }, told };
}

async function openText(file: File, model: Model | null): Promise<Opened> {
  if (file.size > MOST_TEXT_BYTES) {
    throw new CannotOpen(`${file.name} has ${Math.round(file.size / 1e6)} MB; a model or stimulus has ${MOST_TEXT_BYTES / 1e6} at most.`);
  }
  const content = parsed(await file.text(), file.name);
  const format = content && typeof content === "object" && "format" in content ? content.format : null;
  try {
    if (format === "eigenwalker model") return { kind: "model", model: readModel(content) };
    if (format === "eigenwalker stimulus" && model) {
      return { kind: "own", own: ownOf(model, readStimulus(content), file.name), told: [] };
    }
  } catch (error) {
    if (error instanceof NoStimulus) throw new CannotOpen(`${file.name} is no stimulus: ${error.message}`);
    throw error;
  }
  throw new CannotOpen(`${file.name} is neither a model nor a stimulus of eigenwalker.`);
}

function parsed(text: string, name: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    throw new CannotOpen(`${name} is not JSON: it ends early or was changed.`);
  }
}
