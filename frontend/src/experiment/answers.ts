/** What a page reports: items that are made once and never change. */

export type Kind = "begun" | "answer" | "event" | "screen" | "questions";
export type Content = Readonly<Record<string, unknown>>;

export interface Item {
  /** Made here, once; the server keeps one item of a name. */
  readonly answer: string;
  readonly kind: Kind;
  readonly trial: number | null;
  readonly attempt: number | null;
  readonly content: Content;
}

/** 128 random bits as 22 letters, as a key or the name of an item. */
export function randomName(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").slice(0, 22);
}

export const itemOf = (kind: Kind, content: Content, trial: number | null = null, attempt: number | null = null): Item => ({
  answer: randomName(),
  kind,
  trial,
  attempt,
  content: { ...content, time_utc: new Date().toISOString() },
});

/** Shows that a text was edited: FNV-1a of 64 bits, as Python computes it. */
export function checksum(text: string): string {
  let value = 0xcbf29ce484222325n;
  for (const byte of new TextEncoder().encode(text)) value = BigInt.asUintN(64, (value ^ BigInt(byte)) * 0x100000001b3n);
  return value.toString(16).padStart(16, "0");
}
