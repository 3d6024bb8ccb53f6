/** Python behind the page, where `eigenwalker serve` has put it there; the one module that asks it. */

export interface Capture {
  readonly name: string;
  readonly vector: readonly number[];
  readonly messages: readonly string[];
}

/** Said by the server or of it; the message is a sentence to show. */
export class ServerSays extends Error {}

/** Whether there is a server behind the page. */
export const hasServer = (): boolean =>
  document.querySelector('meta[name="eigenwalker-server"]')?.getAttribute("content") === "1";

/** A model that is not yet checked, and what became of the captures it was made of. */
export interface Population {
  readonly model: unknown;
  readonly messages: readonly string[];
}

/** A capture, and the files it needs beside it, as a walker of a population that the server keeps. */
export async function readCapture(files: readonly File[], population: string): Promise<Capture> {
  const answer: unknown = await (await post("capture", { ...sent(files), population }, new Blob([...files]))).json();
  if (!isCapture(answer)) throw new ServerSays(`The server's answer about ${files[0]?.name} is no walker.`);
  return answer;
}

/** A population's file, or many captures and perhaps a table of their traits, as a model. */
export async function readPopulation(files: readonly File[]): Promise<Population> {
  const answer: unknown = await (await post("population", sent(files), new Blob([...files]))).json();
  if (!answer || typeof answer !== "object" || !("model" in answer)) {
    throw new ServerSays(`The server's answer about ${files[0]?.name} is no population.`);
  }
  return { model: answer.model, messages: "messages" in answer && areSentences(answer.messages) ? answer.messages : [] };
}

/** One file by its name; several by names and sizes, one after the other. */
function sent(files: readonly File[]): Record<string, string> {
  const [first, ...others] = files;
  if (first && others.length === 0) return { name: first.name };
  return { files: JSON.stringify(files.map(({ name, size }) => [name, size])) };
}

const areSentences = (messages: unknown): messages is string[] =>
  Array.isArray(messages) && messages.every((sentence) => typeof sentence === "string");

/** A film of a stimulus. */
export async function makeFilm(stimulus: string, format: "mp4" | "webm" | "gif"): Promise<Blob> {
  return (await post("film", { format }, stimulus)).blob();
}

async function post(what: string, query: Readonly<Record<string, string>>, body: BodyInit): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(`/api/${what}?${new URLSearchParams(query)}`, { method: "POST", body });
  } catch {
    throw new ServerSays("The server does not answer: is eigenwalker serve still running?");
  }
  if (answer.ok) return answer;
  throw new ServerSays(await complaint(answer));
}

async function complaint(answer: Response): Promise<string> {
  const said: unknown = await answer.json().catch(() => null);
  const detail = said && typeof said === "object" && "detail" in said ? said.detail : null;
  return typeof detail === "string" ? detail : `The server refused with ${answer.status} ${answer.statusText}.`;
}

function isCapture(answer: unknown): answer is Capture {
  if (!answer || typeof answer !== "object") return false;
  const { name, vector, messages } = answer as Record<string, unknown>;
  return (
    typeof name === "string" &&
    Array.isArray(vector) && vector.every(Number.isFinite) &&
    areSentences(messages)
  );
}
