/** What the ends of a trait are called, everywhere in the browser. */

import type { Trait } from "./model";

const SEXES: Readonly<Record<string, string>> = { female: "woman", male: "man", f: "woman", m: "man" };

/** The two ends of a trait, as they stand beside a slider. */
export function ends({ label, negative, positive }: Trait): readonly [string, string] {
  const names = /^(sex|gender)$/i.test(label) ? SEXES : {};
  const name = (pole: string): string => names[pole.toLowerCase()] ?? pole;
  return [name(negative), name(positive)];
}
