/** The Python server of `eigenwalker serve`; the one module that sends requests. */

export interface Capture {
  readonly name: string;
  readonly vector: readonly number[];
  readonly messages: readonly string[];
}

/** A model that is not checked yet, and messages about its captures. */
export interface Population {
  readonly model: unknown;
  readonly messages: readonly string[];
}

export const hasServer = (): boolean =>
  document.querySelector('meta[name="eigenwalker-server"]')?.getAttribute("content") === "1";

/** A capture, with the files that belong to it, as a walker of a population that the server holds. */
export async function readCapture(files: readonly File[], population: string): Promise<Capture> {
  const answer = await json(post("capture", { ...namesOf(files), population }, new Blob([...files])));
  const { name, vector, messages } = answer;
  if (typeof name === "string" && isListOf(vector, Number.isFinite) && isListOf(messages, isText)) {
    return { name, vector: vector as number[], messages: messages as string[] };
  }
  throw new Error(`The server's answer about ${files[0]?.name} is no walker.`);
}

/** The file of a population, or many captures with or without a table of traits, as a model. */
export async function readPopulation(files: readonly File[]): Promise<Population> {
  const { model, messages } = await json(post("population", namesOf(files), new Blob([...files])));
  if (model === undefined) throw new Error(`The server's answer about ${files[0]?.name} is no population.`);
  return { model, messages: isListOf(messages, isText) ? (messages as string[]) : [] };
}

export async function makeFilm(stimulus: string, format: "mp4" | "webm" | "gif"): Promise<Blob> {
  return (await post("film", { format }, stimulus)).blob();
}

/** One file by its name; several by names and sizes, in their order. */
function namesOf(files: readonly File[]): Record<string, string> {
  const [first, ...others] = files;
  if (first && others.length === 0) return { name: first.name };
  return { files: JSON.stringify(files.map(({ name, size }) => [name, size])) };
}

const isText = (value: unknown): boolean => typeof value === "string";
const isListOf = (value: unknown, isItem: (item: unknown) => boolean): boolean =>
  Array.isArray(value) && value.every(isItem);

async function post(what: string, query: Readonly<Record<string, string>>, body: BodyInit): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(`/api/${what}?${new URLSearchParams(query)}`, { method: "POST", body });
  } catch {
    throw new Error("The server does not answer: is eigenwalker serve still running?");
  }
  if (answer.ok) return answer;
  const { detail } = await json(answer).catch(() => ({ detail: null }));
  throw new Error(typeof detail === "string" ? detail : `The server refused with ${answer.status} ${answer.statusText}.`);
}

/** The fields of a JSON object; none of anything else. */
async function json(answer: Response | Promise<Response>): Promise<Readonly<Record<string, unknown>>> {
  const content: unknown = await (await answer).json();
  return content && typeof content === "object" ? (content as Record<string, unknown>) : {};
}
