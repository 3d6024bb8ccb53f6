/** Files that someone brings: a model, a stimulus, a population, captures. */

import { NoStimulus, readStimulus } from "../core/readStimulus";
import type { Model, Own } from "../model/model";
import { readModel } from "../model/readModel";
import { ownOf } from "./ownWalker";
import { CannotOpen } from "./refusal";
import { hasServer, readCapture, readPopulation } from "./server";

/** What files turned out to be. */
export type Opened =
  | { readonly kind: "model"; readonly held: Held; readonly messages: readonly string[] }
  | { readonly kind: "own"; readonly own: Own; readonly messages: readonly string[] };

/** A model, and the name under which the server keeps its population; empty where it does not. */
export interface Held {
  readonly model: Model;
  readonly population: string;
}

/** More than any text that the page itself reads. */
const MOST_TEXT_BYTES = 64e6;
const POPULATION = /\.nc$/i;
const TEXT = /\.json$/i;
/** More files than these are not named one by one. */
const MOST_NAMED = 2;
/** Needed beside a capture, and no capture itself. */
const BESIDE = /\.asf$/i;

/** The model in a parsed file, checked. */
export function heldIn(content: unknown): Held {
  const kept = content && typeof content === "object" && "population" in content ? content.population : "";
  return { model: readModel(content), population: typeof kept === "string" ? kept : "" };
}

/** What is brought together, parted into what is opened one after the other. */
export function bundles(files: readonly File[]): File[][] {
  const alone = files.filter(({ name }) => TEXT.test(name) || POPULATION.test(name));
  const others = files.filter((file) => !alone.includes(file));
  return [...alone.map((file) => [file]), ...(others.length > 0 ? [others] : [])];
}

/** What to call files that are opened together. */
export function callIt(files: readonly File[], folder = ""): string {
  const names = files.map(({ name }) => name);
  if (names.length > 1 && folder) return `${folder}/`;
  const more = names.length - MOST_NAMED;
  return more > 1 ? `${names.slice(0, MOST_NAMED).join(", ")} and ${more} more` : names.join(", ");
}

/** Read what belongs together, by the page itself where it can, else by the server. */
export async function openFiles(files: readonly File[], held: Held | null, folder = ""): Promise<Opened> {
  const [file, ...others] = files;
  if (!file) throw new CannotOpen("There is no file in that.");
  if (TEXT.test(file.name)) return openText(file, held?.model ?? null);
  const people = POPULATION.test(file.name);
  if (!hasServer()) {
    const what = people ? "a population" : others.length > 0 ? "captures" : "a capture";
    throw new CannotOpen(`${file.name}: a page alone cannot read ${what}. Run "eigenwalker serve" and drop it there.`);
  }
  const captures = files.filter(({ name }) => !BESIDE.test(name));
  if (people || captures.length > 1) {
    const { model, messages } = await readPopulation(files);
    const opened = heldIn(model);
    if (people) return { kind: "model", held: opened, messages };
    const made = { ...opened.model, captures: callIt(captures, folder) };
    return { kind: "model", held: { ...opened, model: made }, messages };
  }
  return openCapture(files, held);
}

async function openCapture(files: readonly File[], held: Held | null): Promise<Opened> {
  const message = "The server does not keep the population shown here; drop its .nc file first.";
  if (!held?.population) throw new CannotOpen(message);
  const capture = await readCapture(files, held.population);
  const [came, wanted] = [capture.vector.length, held.model.average.length];
  if (came !== wanted) throw new CannotOpen(`${capture.name} came as ${came} numbers; walkers here have ${wanted}.`);
  return { kind: "own", own: { name: capture.name, vector: capture.vector }, messages: capture.messages };
}

async function openText(file: File, model: Model | null): Promise<Opened> {
  if (file.size > MOST_TEXT_BYTES) {
    const size = Math.round(file.size / 1e6);
    throw new CannotOpen(`${file.name} has ${size} MB; a model or stimulus has ${MOST_TEXT_BYTES / 1e6} at most.`);
  }
  const content = parsed(await file.text(), file.name);
  const format = content && typeof content === "object" && "format" in content ? content.format : null;
  try {
    if (format === "eigenwalker model") {
      return { kind: "model", held: { ...heldIn(content), population: "" }, messages: [] };
    }
    if (format === "eigenwalker stimulus" && model) {
      return { kind: "own", own: ownOf(model, readStimulus(content), file.name), messages: [] };
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
