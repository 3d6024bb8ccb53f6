/** Names of traits, of their two ends, of walkers and of populations, as users read them. */

import { entry } from "../core/schema";
import type { KnownWalker, Model, Trait } from "./model";

const SEXES: Readonly<Record<string, string>> = { female: "woman", male: "man", f: "woman", m: "man" };
const PLURALS: Readonly<Record<string, string>> = { woman: "women", man: "men" };

export function endLabels({ label, negative, positive }: Trait): readonly [string, string] {
  const names = /^(sex|gender)$/i.test(label) ? SEXES : {};
  const name = (pole: string): string => entry(names, pole.toLowerCase()) ?? pole;
  return [name(negative), name(positive)];
}

/** Those at one end of a trait: "women", "heavy walkers". */
export const plural = (end: string): string => entry(PLURALS, end) ?? `${end} walkers`;

export const capitalised = (words: string): string => words.charAt(0).toUpperCase() + words.slice(1);

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
    const value = entry(walker.traits, column);
    if (value === undefined || value === null || unit === "") return [];
    return [`${typeof value === "number" ? Math.round(value) : value} ${unit}`];
  });
  return [walker.name, ...facts].join(", ");
}

/** The class of a walker of the population in the main trait, as a CSS class. */
export function classOf(model: Model, walker: number): "negative" | "positive" | "" {
  const trait = mainTrait(model);
  const value = trait?.two_classes ? String(entry(model.walkers[walker]?.traits ?? {}, trait.column)) : null;
  return value === trait?.negative ? "negative" : value === trait?.positive ? "positive" : "";
}

const FEW = 10;

/** One line: the number of walkers, whether they are simulated, and their file. */
export function populationLabel({ n_walkers, simulated, source, captures }: Model): string {
  const people = `${n_walkers} ${simulated ? "simulated " : ""}${n_walkers === 1 ? "walker" : "walkers"}`;
  const from = captures ?? source;
  return from ? `${people} of ${from}` : people;
}

/** Warnings about a population that is small, or that has no traits. */
export function warnings({ n_walkers, traits }: Model): string[] {
  const few = `${n_walkers} walkers are few: sliders push what sets just these apart, and say little of others.`;
  const blank = "No trait tells these walkers apart, for want of a table of traits or of walkers: the large slider is what varies most among them.";
  return [...(n_walkers < FEW ? [few] : []), ...(traits.length === 0 ? [blank] : [])];
}

/** What the switch for people's size does. */
export const SIZE_HINT = "Otherwise all are as large as the average walker: size is divided out, as in Troje (2002)";
