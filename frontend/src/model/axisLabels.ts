/** Names of traits, of their two ends and of walkers, as users read them. */

import type { KnownWalker, Model, Trait } from "./model";

const SEXES: Readonly<Record<string, string>> = { female: "woman", male: "man", f: "woman", m: "man" };
const PLURALS: Readonly<Record<string, string>> = { woman: "women", man: "men" };

/** The names of the two ends of a trait. */
export function endLabels({ label, negative, positive }: Trait): readonly [string, string] {
  const names = /^(sex|gender)$/i.test(label) ? SEXES : {};
  const name = (pole: string): string => names[pole.toLowerCase()] ?? pole;
  return [name(negative), name(positive)];
}

/** Those at one end of a trait: "women", "heavy walkers". */
export const plural = (end: string): string => PLURALS[end] ?? `${end} walkers`;

export const capitalised = (words: string): string => words.charAt(0).toUpperCase() + words.slice(1);

/** The legend of the two colours of a trait of two classes. */
export function colourLegend(trait: Trait | null | undefined): string {
  if (!trait?.two_classes) return "";
  const [low, high] = endLabels(trait);
  return `warm: ${plural(low)}; cool: ${plural(high)}`;
}

/** The trait of the large slider: the first of two classes, else the first. */
export const mainTrait = (model: Model): Trait | undefined =>
  model.traits.find(({ two_classes }) => two_classes) ?? model.traits[0];

/** "woman 3, 27 years, 61 kg", as far as it is known. */
export function walkerLabel(walker: KnownWalker, model: Model): string {
  const facts = model.traits.flatMap(({ column, unit }) => {
    const value = walker.traits[column];
    if (value === undefined || value === null || unit === "") return [];
    return [`${typeof value === "number" ? Math.round(value) : value} ${unit}`];
  });
  return [walker.name, ...facts].join(", ");
}

/** The class of a walker of the population in the main trait, as a CSS class. */
export function classOf(model: Model, walker: number): "negative" | "positive" | "" {
  const trait = mainTrait(model);
  const value = trait?.two_classes ? String(model.walkers[walker]?.traits[trait.column]) : null;
  return value === trait?.negative ? "negative" : value === trait?.positive ? "positive" : "";
}
