/** Python behind the page, where `eigenwalker serve` has put it there; the one module that asks it. */

export interface Capture {
  readonly name: string;
  readonly vector: readonly number[];
  readonly told: readonly string[];
}

/** Said by the server or of it; the message is a sentence to show. */
export class ServerSays extends Error {}

/** Whether there is a server behind the page. */
export const hasServer = (): boolean =>
  document.querySelector('meta[name="eigenwalker-server"]')?.getAttribute("content") === "1";

/** A capture read, fitted and put into the population's correspondence. */
export async function readCapture(file: File): Promise<Capture> {
  const answer: unknown = await (await post("capture", { name: file.name }, file)).json();
  if (!isCapture(answer)) throw new ServerSays(`The server's answer about ${file.name} is no walker.`);
  return answer;
}

/** A model of a population's file, not yet checked. */
export async function readPopulation(file: File): Promise<unknown> {
  return (await post("population", { name: file.name }, file)).json();
}

/** A film of a stimulus. */
export async function makeFilm(stimulus: string, format: "mp4" | "webm" | "gif"): Promise<Blob> {
  return (await post("film", { format }, stimulus)).blob();
}

async function post(what: string, query: Record<string, string>, body: BodyInit): Promise<Response> {
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
  const { name, vector, told } = answer as Record<string, unknown>;
  return (
    typeof name === "string" &&
    Array.isArray(vector) && vector.every(Number.isFinite) &&
    Array.isArray(told) && told.every((sentence) => typeof sentence === "string")
  );
}
