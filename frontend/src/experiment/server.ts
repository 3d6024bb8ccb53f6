/** The server: the one module that calls `fetch`. */

import type { Item } from "./answers";
import type { SessionContent, StimulusFile, Welcome } from "./session";

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

export interface End {
  readonly withdrawal_code?: string;
  readonly completion_code?: string;
  readonly return_url?: string;
}

export type Site = Readonly<Record<string, string>>;

const LONGEST_WAIT_MS = 30_000;

async function ask(key: string, path: string, body: unknown, taken: readonly number[] = [200]): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(`/api/${path}`, {
      method: "POST",
      headers: { authorization: `Bearer ${key}`, "content-type": "application/json" },
      body: JSON.stringify(body),
      cache: "no-store",
      signal: AbortSignal.timeout(LONGEST_WAIT_MS),
    });
  } catch (error) {
    throw new Refusal(0, String(error));
  }
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

export const stimuli = (key: string, session: number): Promise<Readonly<Record<string, StimulusFile>>> =>
  json(ask(key, "stimuli", { session }));

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
