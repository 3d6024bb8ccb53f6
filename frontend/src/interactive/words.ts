/** What traits, their poles and walkers are called on the page. */

import type { KnownWalker, Model, Trait } from "../model/model";

const POLES: Readonly<Record<string, string>> = { female: "woman", male: "man" };
const MANY: Readonly<Record<string, string>> = { woman: "women", man: "men" };

/** The end of a trait, as it stands beside a slider. */
export const pole = (name: string): string => POLES[name] ?? name;

/** Those who are at one end of a trait: "women", "heavy walkers". */
export const many = (name: string): string => MANY[pole(name)] ?? `${pole(name)} walkers`;

export const ends = (trait: Trait): readonly [string, string] => [
  pole(trait.negative),
  pole(trait.positive),
];

export const capital = (words: string): string => words.charAt(0).toUpperCase() + words.slice(1);

/** The trait whose slider is the large one: the first of two classes, else the first. */
export const mainTrait = (model: Model): Trait | undefined =>
  model.traits.find(({ two_classes }) => two_classes) ?? model.traits[0];

/** "woman 3 - 27 years, 61 kg", as far as it is known. */
export function aboutWalker(walker: KnownWalker, model: Model): string {
  const said = model.traits.flatMap(({ column, unit }) => {
    const value = walker.traits[column];
    if (value === undefined || value === null || unit === "") return [];
    return [`${typeof value === "number" ? Math.round(value) : value} ${unit}`];
  });
  return [walker.name, ...said].join(", ");
}

/** Which end of a trait of two classes a walker of the population belongs to: a class of CSS. */
export function classOf(model: Model, walker: number): "negative" | "positive" | "" {
  const trait = mainTrait(model);
  const value = trait?.two_classes ? String(model.walkers[walker]?.traits[trait.column]) : null;
  return value === trait?.negative ? "negative" : value === trait?.positive ? "positive" : "";
}
