/** The model of a page: a population, the variation in it, and the directions of its traits; schemas and types. */

import type { Checked, Schema } from "../core/schema";

/** The direction that tells a trait best, or the difference between the means of its two ends. */
export type Kind = "discriminant" | "mean_difference";
export type Numbers = readonly number[];

const MAX_MARKERS = 200;
const MAX_POSTURES = 32;
const MAX_POINTS = 5000;
const MAX_POPULATION = 10_000_000;
export const MAX_WALKERS = 100;

export const number = (minimum = -1e9, maximum = 1e9): Schema<number> => ({ type: "number", minimum, maximum });
const integer = (minimum: number, maximum: number): Schema<number> => ({ type: "integer", minimum, maximum });
export const list = <T>(items: Schema<T>, minItems: number, maxItems = minItems): Schema<readonly T[]> => ({
  type: "array", items, minItems, maxItems,
});
const pair = <T>(items: Schema<T>): Schema<readonly [T, T]> => ({ type: "array", items, minItems: 2, maxItems: 2 });
export const numbers = (length: number): Schema<Numbers> => list(number(), length);
const map = <T>(additionalProperties: Schema<T>): Schema<Readonly<Record<string, T>>> => ({
  type: "object", additionalProperties, maxProperties: 1000,
});
const orNull = <T>(schema: Schema<T>): Schema<T | null> => ({ anyOf: [schema, { type: "null" }], default: null });
export const record = <Fields extends Record<string, Schema>>(
  properties: Fields,
): Schema<{ readonly [Name in keyof Fields]: Checked<Fields[Name]> }> => ({
  type: "object",
  properties,
  required: Object.keys(properties).filter((name) => !("default" in properties[name]!)),
});
const positive = number(Number.MIN_VALUE);
/** Text to show, never HTML. */
const text: Schema<string> = { type: "string", maxLength: 2000 };
const flag: Schema<boolean> = { type: "boolean" };

export const HEAD = record({
  format: { const: "eigenwalker model" } as Schema<"eigenwalker model">,
  version: { const: 1 } as Schema<1>,
  program: text,
  title: text,
  /** File of the population; empty for the built-in population. */
  source: text,
  simulated: flag,
  provenance: map(text),
  /** Whether the walkers have their own size, or that of the average walker. */
  size_kept: { ...flag, default: true } as Schema<boolean>,
  n_walkers: integer(1, MAX_POPULATION),
  /** Walkers of doubtful captures, which are left out. */
  n_flagged: integer(0, MAX_POPULATION),
  /** The walkers' mean speed over that of the average walker's feet. */
  speed_factor: { ...positive, default: 1 } as Schema<number>,
  markers: list(text, 1, MAX_MARKERS),
  form: { enum: ["eigenposture", "fourier"] } as Schema<"eigenposture" | "fourier">,
  harmonics: list(integer(1, 64), 1, MAX_POSTURES),
});

export function bodySchema({ markers, harmonics }: Checked<typeof HEAD>) {
  const marker: Schema<string> = { enum: markers };
  const links = list(pair(marker), 0, 1000);
  return record({
    segments: links,
    pairs: links,
    groups: map(list(marker, 0, 100_000)),
    /** For each posture its phase; null if the phase is a feature. */
    fixed_phases: list(orNull(number(-1000, 1000)), harmonics.length),
    /** For each block of the features, its columns from the first to before the second. */
    layout: map(pair(integer(0, 100_000))),
  });
}

export function featureSchema(size: number) {
  const vector = numbers(size);
  const steps = map({} as Schema<Numbers>);
  const trait = record({
    /** As an argument of Python's `trait_axis`. */
    name: text,
    /** Its column in the traits of the walkers. */
    column: text,
    label: text,
    unit: text,
    negative: text,
    positive: text,
    two_classes: flag,
    /** One standard deviation of the walkers along the trait, for the columns of each part. */
    steps: record({ discriminant: steps, mean_difference: steps }),
    /** The position of a walker along the trait: offset + gradient . vector. */
    projection: record({ gradient: vector, offset: number() }),
    /** Mean walkers of two classes. */
    means: orNull(record({ negative: vector, positive: vector })),
  });
  const traitValue = { anyOf: [flag, { type: "null" }, number(), text] } as Schema<string | number | boolean | null>;
  /** The vector is one standard deviation of the walkers; share is that of the standardised variance. */
  const eigenwalker = record({ vector, sd: positive, share: number(0, 1) });
  /** Row is the number in the population. */
  const walker = record({ name: text, row: integer(0, MAX_POPULATION), vector, traits: map(traitValue) });
  return record({
    average: vector,
    scale: list(positive, size),
    eigenwalkers: list(eigenwalker, 0, 100),
    /** Root mean square distance from the average; the distances of the walkers in units of it. */
    spread: record({ rms: number(0), distances: list(number(0), 1, MAX_POINTS) }),
    walkers: list(walker, 0, MAX_WALKERS),
    traits: list(trait, 0, 100),
  });
}

export const COUNT = record({ cloud: record({ n: integer(0, MAX_POINTS) }) });

/** The walkers of the population as points; at most as many as the page has room for. */
export const cloudSchema = (n: number, { eigenwalkers, walkers }: Checked<ReturnType<typeof featureSchema>>) =>
  record({
    cloud: record({
      n: integer(n, n),
      /** For each point, its scores on the eigenwalkers in standard deviations. */
      scores: list(numbers(eigenwalkers.length), n),
      /** For each point, its number among the model's walkers; -1 if it is not one of them. */
      walker: list(integer(-1, walkers.length - 1), n),
    }),
  });

type Part<F extends (...values: never[]) => Schema> = Checked<ReturnType<F>>;

type Content = Part<typeof bodySchema> & Part<typeof featureSchema> & Part<typeof cloudSchema>;

/**
 * `captures` names the captures that the server has just made into this population; `keepSize` is the initial choice
 * where the same walkers are there with their size and without.
 */
export type Model = Checked<typeof HEAD> & Content & { readonly captures?: string; readonly keepSize?: boolean };
export type Trait = Model["traits"][number];
export type KnownWalker = Model["walkers"][number];

/** A walker that is not in the population: a visitor's own capture or stimulus. */
export interface OwnWalker {
  readonly name: string;
  readonly vector: Numbers;
}
