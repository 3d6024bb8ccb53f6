/** Files that a visitor drops or chooses: a model, a stimulus, a population, captures. */

import { readStimulus } from "../core/readStimulus";
import { InvalidFile } from "../core/schema";
import type { Model, OwnWalker } from "../model/model";
import { modelSourceOf, type ModelSource } from "../model/modelSource";
import { find } from "../page/elements";
import { ownWalkerOf } from "./ownWalker";
import { fieldsSaid, hasServer, nameMarkers, readCapture, readCaptures, readPopulation } from "./server";

/** The content of files, with messages about them. */
export type Opened = { readonly messages: readonly string[] } & (
  | { readonly kind: "model"; readonly source: ModelSource }
  | { readonly kind: "own"; readonly own: OwnWalker }
  | { readonly kind: "names" }
);

const MAX_TEXT_BYTES = 64e6;
const POPULATION = /\.nc$/i;
const TEXT = /\.json$/i;
/** Limit of the files that are named one by one. */
const MAX_NAMED = 2;
/** Names of markers of one's own. */
const NAMES = /\.toml$/i;
/** Files that belong to a capture. */
const COMPANION = /\.asf$/i;

/** Files in groups that are opened one after the other. */
export function bundles(files: readonly File[]): File[][] {
  const alone = files.filter(({ name }) => TEXT.test(name) || POPULATION.test(name));
  const others = files.filter((file) => !alone.includes(file));
  return [...alone.map((file) => [file]), ...(others.length > 0 ? [others] : [])];
}

export function bundleName(files: readonly File[], folder = ""): string {
  const names = files.map(({ name }) => name);
  if (names.length > 1 && folder) return `${folder}/`;
  const more = names.length - MAX_NAMED;
  return more > 1 ? `${names.slice(0, MAX_NAMED).join(", ")} and ${more} more` : names.join(", ");
}

/** Open files that belong together: the page reads them if it can, else the server. */
export async function openFiles(brought: readonly File[], source: ModelSource | null, folder = ""): Promise<Opened> {
  const [names, more] = brought.filter(({ name }) => NAMES.test(name));
  if (names && more) throw new Error(`${names.name} and ${more.name}: one file of marker names is enough.`);
  const files = brought.filter((each) => each !== names);
  if (names && hasServer()) nameMarkers(names);
  const [file, ...others] = names && files.length === 0 && !hasServer() ? brought : files;
  if (names && !file) {
    return { kind: "names", messages: [`${names.name} names the markers of captures from now on.`] };
  }
  if (!file) throw new Error("There is no file in that.");
  if (TEXT.test(file.name)) return openText(file, source?.model ?? null);
  const isPopulation = POPULATION.test(file.name);
  if (!hasServer()) {
    const what = isPopulation ? "a population" : others.length > 0 ? "captures" : "a capture";
    throw new Error(`${file.name}: a page alone cannot read ${what}. Run "eigenwalker serve" and drop it there.`);
  }
  const captures = files.filter(({ name }) => !COMPANION.test(name));
  if (!isPopulation && captures.length <= 1) return openCapture(files, source);
  const { model, messages } = await (isPopulation ? readPopulation(file) : readCaptures(files));
  const opened = modelSourceOf(model);
  if (isPopulation) return { kind: "model", source: opened, messages };
  const name = { captures: bundleName(captures, folder) };
  const named = { model: { ...opened.model, ...name }, other: opened.other && { ...opened.other, ...name } };
  return { kind: "model", source: { ...opened, ...named }, messages: [...fieldsSaid(), ...messages] };
}

async function openCapture(files: readonly File[], source: ModelSource | null): Promise<Opened> {
  if (!source?.population) throw new Error("The server does not keep the population shown here; drop its .nc file first.");
  const { name, vector, messages } = await readCapture(files, source.population);
  const { length } = source.model.average;
  if (vector.length !== length) throw new Error(`${name} came as ${vector.length} numbers; walkers here have ${length}.`);
  return { kind: "own", own: { name, vector }, messages: [...fieldsSaid(), ...messages] };
}

async function openText(file: File, model: Model | null): Promise<Opened> {
  const { name, size } = file;
  if (size > MAX_TEXT_BYTES) {
    throw new Error(`${name} has ${Math.round(size / 1e6)} MB; a model or stimulus has ${MAX_TEXT_BYTES / 1e6} at most.`);
  }
  const content = parse(await file.text(), name);
  const format = content && typeof content === "object" && "format" in content ? content.format : null;
  try {
    if (format === "eigenwalker model") {
      return { kind: "model", source: { ...modelSourceOf(content), population: "" }, messages: [] };
    }
    if (format === "eigenwalker stimulus" && model) {
      return { kind: "own", own: ownWalkerOf(model, readStimulus(content), name), messages: [] };
    }
  } catch (error) {
    throw error instanceof InvalidFile ? new Error(`${name}: ${error.message}`) : error;
  }
  throw new Error(`${name} is neither a model nor a stimulus of eigenwalker.`);
}

function parse(text: string, name: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    throw new Error(`${name} is not JSON: it ends early or was changed.`);
  }
}

const MAX_FILES = 500;

/** Files of one drop, and the name of their folder, if it was one. */
export interface DroppedFiles {
  readonly files: readonly File[];
  readonly folder: string;
}

/** Hand over files that are dropped or chosen; the returned function opens the dialog. */
export function takeFiles(take: (dropped: DroppedFiles) => void): () => void {
  const veil = find("#drop", HTMLDivElement);
  const input = find("#file", HTMLInputElement);
  const ifFiles = (handle: (event: DragEvent) => void) => (event: DragEvent): void => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    handle(event);
  };
  window.addEventListener("dragover", ifFiles(() => (veil.hidden = false)));
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) veil.hidden = true;
  });
  window.addEventListener("drop", ifFiles((event) => {
    veil.hidden = true;
    void filesOf(event.dataTransfer!).then(take);
  }));
  input.addEventListener("change", () => {
    take({ files: [...(input.files ?? [])], folder: "" });
    input.value = "";
  });
  return () => input.click();
}

async function filesOf({ items, files }: DataTransfer): Promise<DroppedFiles> {
  const plain = { files: [...files], folder: "" };
  const entries = [...items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.some(({ isDirectory }) => isDirectory)) return plain;
  const found: File[] = [];
  for (const entry of entries) await collect(entry, found);
  return { files: found, folder: entries.length === 1 ? entries[0]!.name : "" };
}

async function collect(entry: FileSystemEntry, found: File[]): Promise<void> {
  if (found.length >= MAX_FILES || entry.name.startsWith(".")) return;
  if (entry.isFile) {
    found.push(await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject)));
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const next = (): Promise<FileSystemEntry[]> => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
  // A folder is read in batches; the last one is empty.
  for (let batch = await next(); batch.length > 0; batch = await next()) {
    for (const each of batch) await collect(each, found);
  }
}
