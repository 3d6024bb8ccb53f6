/** The server: the one module that calls `fetch`. */

import type { Item } from "./answers";
import type { End, SessionContent, StimulusFile, Welcome } from "./session";

/** An answer of the server that is not the one asked for; status 0 is none at all. */
export class Refusal extends Error {
  constructor(
    readonly status: number,
    readonly detail: string,
    readonly content: Readonly<Record<string, unknown>> = {},
    readonly retryAfterS: number | null = null,
  ) {
    super(detail);
  }

  /** Whether the same request may be answered later. */
  get passes(): boolean {
    return this.status === 0 || this.status === 429 || this.status >= 500;
  }
}

export interface Outcome {
  readonly confirmed: readonly string[];
  readonly refused: readonly { readonly answer: string; readonly outcome: string }[];
}

export type Site = Readonly<Record<string, string>>;

const LONGEST_WAIT_MS = 30_000;
const LONGEST_LOAD_MS = 600_000;

/** The server's clock at its last answer; a machine's own may be wrong. */
let serverMs = Date.now();
export const serverTimeMs = (): number => serverMs;

async function ask(key: string, path: string, body: unknown, taken: readonly number[] = [200], longestMs = LONGEST_WAIT_MS): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(`/api/${path}`, {
      method: "POST",
      headers: { authorization: `Bearer ${key}`, "content-type": "application/json" },
      body: JSON.stringify(body),
      cache: "no-store",
      signal: AbortSignal.timeout(longestMs),
    });
  } catch (error) {
    throw new Refusal(0, String(error));
  }
  serverMs = Date.parse(response.headers.get("date") ?? "") || serverMs;
  if (taken.includes(response.status)) return response;
  const content = (await response.json().catch(() => ({}))) as Record<string, unknown>;
  const wait = Number(response.headers.get("retry-after"));
  throw new Refusal(response.status, String(content["detail"] ?? ""), content, wait > 0 ? wait : null);
}

async function json<Content>(response: Promise<Response>): Promise<Content> {
  const got = await response;
  try {
    return (await got.json()) as Content;
  } catch (error) {
    throw new Refusal(0, String(error)); // cut off on its way
  }
}

export const welcome = (key: string, site: Site): Promise<Welcome> => json(ask(key, "welcome", { site }));

export const start = (
  key: string,
  asked: { readonly consent: string; readonly language: string; readonly own_key: string; readonly site: Site },
): Promise<SessionContent> => json(ask(key, "start", asked));

/** All stimuli of a session; `report` is told which share has come. */
export async function stimuli(
  key: string,
  session: number,
  report: (share: number) => void,
): Promise<Readonly<Record<string, StimulusFile>>> {
  const response = await ask(key, "stimuli", { session }, [200], LONGEST_LOAD_MS);
  const size = Number(response.headers.get("content-length"));
  if (!response.body || !size) return json(Promise.resolve(response));
  let read = 0;
  const counted = new TransformStream<Uint8Array, Uint8Array>({
    transform(chunk, out) {
      report(Math.min((read += chunk.byteLength) / size, 1));
      out.enqueue(chunk);
    },
  });
  return json(Promise.resolve(new Response(response.body.pipeThrough(counted))));
}

export const sendItems = (key: string, session: number, items: readonly Item[]): Promise<Outcome> =>
  json(ask(key, "answers", { session, items }, [200, 409]));

export const end = (key: string, session: number, how: "finished" | "stopped" | "deleted"): Promise<End> =>
  json(ask(key, "end", { session, how }));

/** Ask again while the server may answer later, with longer and longer waits; `waiting` is told. */
export async function persist<Content>(request: () => Promise<Content>, waiting: () => void = () => {}): Promise<Content> {
  for (let wait = 500; ; wait = Math.min(2 * wait, 10_000)) {
    try {
      return await request();
    } catch (error) {
      if (!(error instanceof Refusal && error.passes)) throw error;
      waiting();
      await new Promise((resolve) => setTimeout(resolve, 1000 * (error.retryAfterS ?? 0) || wait));
    }
  }
}
