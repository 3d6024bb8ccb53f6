/** The Python server of `eigenwalker serve`; the one module that sends requests. */

import { checked, explained, type Schema } from "../core/schema";
import { list, number, record } from "../model/model";

const line: Schema<string> = { type: "string" };
const lines = { ...list(line, 0, Infinity), default: [] };
const CAPTURE = record({ name: line, vector: list(number(), 0, Infinity), messages: lines });
/** The model is not checked yet. */
const POPULATION = record({ model: {}, messages: lines });

/** What the visitor knows of captures better than their files: frames a second, and the unit of length. */
export const captureFields: { rate?: string; unit?: string } = {};

/** The visitor's own names of markers, which go with every capture; `changed` is called when they are others. */
export const markerNames: { file: File | null; changed: () => void } = { file: null, changed: () => undefined };

export function nameMarkers(file: File | null): void {
  markerNames.file = file;
  markerNames.changed();
}

const withNames = (captures: readonly File[]): readonly File[] =>
  markerNames.file ? [...captures, markerNames.file] : captures;

/** A sentence about the fields where they are filled in, for messages about captures. */
export function fieldsSaid(): string[] {
  const { rate, unit } = captureFields;
  const names = markerNames.file?.name;
  const said = [
    ...(rate ? [`at ${rate} frames a second`] : []),
    ...(unit ? [`in ${unit}`] : []),
    ...(names ? [`with the marker names of ${names}`] : []),
  ];
  return said.length > 0 ? [`Read ${said.join(", ")}, as the fields under "Who walks" say.`] : [];
}

export const hasServer = (): boolean =>
  document.querySelector('meta[name="eigenwalker-server"]')?.getAttribute("content") === "1";

/** A capture, with the files that belong to it, as a walker of a population that the server holds. */
export const readCapture = (files: readonly File[], population: string) =>
  answerAbout(withNames(files), CAPTURE, "walker", (all) => post("capture", { ...queryOf(all), population }, new Blob([...all])));

/** The file of a population as a model. */
export const readPopulation = (file: File) =>
  answerAbout([file], POPULATION, "population", (all) => post("population", queryOf(all), new Blob([...all])));

/** Many captures, with or without a table of traits, as a model. */
export const readCaptures = (files: readonly File[]) =>
  answerAbout(withNames(files), POPULATION, "population", (all) => post("population", queryOf(all), new Blob([...all])));

async function answerAbout<T>(
  files: readonly File[], schema: Schema<T>, what: string, send: (files: readonly File[]) => Promise<Response>,
): Promise<T> {
  const content: unknown = await (await send(files)).json();
  return explained(`The server's answer about ${files[0]?.name} is no ${what}`, () => checked(content, schema, "answer"));
}

export async function makeFilm(stimulus: string, format: "mp4" | "webm" | "gif" | "bvh" | "glb"): Promise<Blob> {
  return (await post("film", { format }, stimulus)).blob();
}

/** One file by its name, several by names and sizes in their order; and what the page's fields say of captures. */
function queryOf(files: readonly File[]): Record<string, string> {
  const [first, ...others] = files;
  if (first && others.length === 0) return { ...captureFields, name: first.name };
  return { ...captureFields, files: JSON.stringify(files.map(({ name, size }) => [name, size])) };
}

async function post(what: string, query: Readonly<Record<string, string>>, body: BodyInit): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(`/api/${what}?${new URLSearchParams(query)}`, { method: "POST", body });
  } catch {
    throw new Error("The server does not answer: is eigenwalker serve still running?");
  }
  if (answer.ok) return answer;
  const detail: unknown = await answer.json().then((content) => content?.detail).catch(() => null);
  throw new Error(typeof detail === "string" ? detail : `The server refused with ${answer.status} ${answer.statusText}.`);
}
