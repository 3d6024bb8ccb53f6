/** What traits, their poles and walkers are called on the page. */

import type { KnownWalker, Model, Trait } from "../model/model";
import { ends } from "../model/axisLabels";

export { ends };

const MANY: Readonly<Record<string, string>> = { woman: "women", man: "men" };

/** Those who are at one end of a trait: "women", "heavy walkers". */
export const many = (end: string): string => MANY[end] ?? `${end} walkers`;

/** Which colours stand for whom, where there are two classes. */
export function colours(trait: Trait | null | undefined): string {
  if (!trait?.two_classes) return "";
  const [low, high] = ends(trait);
  return `warm: ${many(low)}; cool: ${many(high)}`;
}

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
