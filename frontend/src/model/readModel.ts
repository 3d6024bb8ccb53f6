/** A model from parsed JSON, checked: its shapes fit each other, and all numbers are finite. */

import { checked, explained, refuse, type Schema } from "../core/schema";
import { columnsOf } from "./features";
import type { Model } from "./model";
import { MAX_IN_CROWD } from "./state";

const MAX_MARKERS = 200;
const MAX_POSTURES = 32;
const MAX_POINTS = 5000;
const MAX_WALKERS = 10_000_000;

const number = (minimum = -1e9, maximum = 1e9): Schema => ({ type: "number", minimum, maximum });
const integer = (minimum: number, maximum: number): Schema => ({ type: "integer", minimum, maximum });
const list = (items: Schema, minItems: number, maxItems = minItems): Schema => ({ type: "array", items, minItems, maxItems });
const map = (additionalProperties: Schema): Schema => ({ type: "object", additionalProperties, maxProperties: 1000 });
/** An object with at least these names. */
const record = (properties: Record<string, Schema>): Schema => ({
  type: "object",
  properties,
  required: Object.entries(properties).flatMap(([name, schema]) => ("default" in schema ? [] : [name])),
});
const orNull = (schema: Schema): Schema => ({ anyOf: [schema, { type: "null" }], default: null });
const numbers = (length: number): Schema => list(number(), length);
const positive = number(Number.MIN_VALUE);
/** Text to show, never HTML. */
const text: Schema = { type: "string", maxLength: 2000 };
const flag: Schema = { type: "boolean" };

/**
 * The model in the parsed content of a file.
 *
 * Throws `InvalidFile` with the first problem.
 */
export const readModel = (content: unknown): Model =>
  explained("This is no model of walkers", () => {
    const head = checked<Model>(content, HEAD, "model");
    const body = checked<Model>(content, bodySchema(head), "model");
    checkLayout(head, body.layout);
    const size = Math.max(...Object.values(body.layout).map(([, end]) => end));
    const walkers = checked<Model>(content, walkersSchema(size), "model");
    const { n } = checked<Model>(content, record({ cloud: record({ n: integer(0, MAX_POINTS) }) }), "model").cloud;
    const cloud = checked<Model>(content, cloudSchema(n, walkers), "model");
    const model = { ...head, ...body, ...walkers, ...cloud };
    model.traits.forEach((trait, i) => checkSteps(model, trait, `model.traits[${i}].steps`));
    return model;
  });

const HEAD = record({
  format: { const: "eigenwalker model" },
  version: { const: 1 },
  program: text,
  title: text,
  source: text,
  simulated: flag,
  provenance: map(text),
  n_walkers: integer(1, MAX_WALKERS),
  n_flagged: integer(0, MAX_WALKERS),
  markers: list(text, 1, MAX_MARKERS),
  form: { enum: ["eigenposture", "fourier"] },
  harmonics: list(integer(1, 64), 1, MAX_POSTURES),
});

function bodySchema({ markers, harmonics }: Model): Schema {
  const marker: Schema = { enum: markers };
  const links = list(list(marker, 2), 0, 1000);
  return record({
    segments: links,
    pairs: links,
    groups: map(list(marker, 0, 100_000)),
    fixed_phases: list(orNull(number(-1000, 1000)), harmonics.length),
    layout: map(list(integer(0, 100_000), 2)),
  });
}

/** Blocks p0, p1 ... of all coordinates, the frequency, and free phases, without gaps. */
function checkLayout({ markers, harmonics, form }: Model, layout: Model["layout"]): void {
  const where = "model.layout";
  const sizes = new Map([["frequency", 1], ...(form === "eigenposture" ? [["phases", harmonics.length - 1] as const] : [])]);
  for (let i = 0; i <= harmonics.length; i++) sizes.set(`p${i}`, 3 * markers.length);
  for (const [block, size] of sizes) {
    const [start, end] = layout[block] ?? refuse(where, `the block "${block}"`, Object.keys(layout));
    if (end - start !== size) refuse(`${where}.${block}`, `${size} columns`, [start, end]);
  }
  const spans = Object.values(layout).sort((a, b) => a[0] - b[0]);
  const total = spans.reduce((at, [start, end]) => (start === at ? end : NaN), 0);
  if (Number.isNaN(total)) refuse(where, "blocks without gaps", layout);
}

function walkersSchema(size: number): Schema {
  const vector = numbers(size);
  const traitValue: Schema = { anyOf: [flag, { type: "null" }, number(), text] };
  const steps = map({});
  return record({
    average: vector,
    scale: list(positive, size),
    eigenwalkers: list(record({ vector, sd: positive, share: number(0, 1) }), 0, 100),
    spread: record({ rms: number(0), distances: list(number(0), 1, MAX_POINTS) }),
    walkers: list(record({ name: text, row: integer(0, MAX_WALKERS), vector, traits: map(traitValue) }), 0, MAX_IN_CROWD),
    traits: list(
      record({
        ...{ name: text, column: text, label: text, unit: text, negative: text, positive: text, two_classes: flag },
        steps: record({ discriminant: steps, mean_difference: steps }),
        projection: record({ gradient: vector, offset: number() }),
        means: orNull(record({ negative: vector, positive: vector })),
      }),
      0,
      100,
    ),
  });
}

const cloudSchema = (n: number, { eigenwalkers, walkers }: Model): Schema =>
  record({
    cloud: record({
      n: integer(n, n),
      scores: list(numbers(eigenwalkers.length), n),
      walker: list(integer(-1, walkers.length - 1), n),
    }),
  });

/** Each step has as many numbers as its part has columns. */
function checkSteps(model: Model, { steps }: Model["traits"][number], where: string): void {
  for (const [kind, parts] of Object.entries(steps)) {
    for (const [part, step] of Object.entries(parts)) {
      const place = `${where}.${kind}.${part}`;
      checked(step, numbers(partSize(model, part, place)), place);
    }
  }
}

function partSize(model: Model, part: string, where: string): number {
  try {
    return columnsOf(model, part).length;
  } catch {
    return refuse(where, "a part of the features", part);
  }
}
