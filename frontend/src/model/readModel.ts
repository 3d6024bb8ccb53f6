/** A model from parsed JSON, checked: its shapes fit each other and every number is one. */

import { columnsOf } from "./layout";
import type { Cloud, Eigenwalker, KnownWalker, Model, Span, Trait } from "./model";
import * as is from "./reading";
import { MOST_IN_CROWD } from "./state";

export { NoModel } from "./reading";

const MOST_MARKERS = 200;
const MOST_POSTURES = 32;
const MOST_POINTS = 5000;

/**
 * The model that the parsed content of a file describes.
 *
 * Throws `NoModel` with the first thing amiss.
 */
export function readModel(content: unknown): Model {
  const head = is.record({
    format: is.oneOf("eigenwalker model"),
    version: is.oneOf(1),
    program: is.text,
    title: is.text,
    source: is.text,
    simulated: is.truth,
    provenance: is.named(is.text),
    n_walkers: is.whole(1, 10_000_000),
    n_flagged: is.whole(0, 10_000_000),
    markers: is.list(is.text, 1, MOST_MARKERS),
    form: is.oneOf("eigenposture", "fourier"),
    harmonics: is.list(is.whole(1, 64), 1, MOST_POSTURES),
  })(content, "model");
  const marker = is.oneOf(...head.markers);
  const link: is.Reader<readonly [string, string]> = (value, where) =>
    is.list(marker, 2, 2)(value, where) as unknown as readonly [string, string];
  const body = is.record({
    segments: is.list(link, 0, 1000),
    pairs: is.list(link, 0, 1000),
    groups: is.named(is.list(marker)),
    fixed_phases: is.list(is.orNull(is.number(-1000, 1000)), head.harmonics.length, head.harmonics.length),
    layout: readLayout(head.markers.length, head.harmonics.length, head.form),
  })(content, "model");
  const size = Math.max(...Object.values(body.layout).map(([, end]) => end));
  const content_ = is.record({
    average: is.numbers(size),
    scale: is.list(is.number(Number.MIN_VALUE), size, size),
    eigenwalkers: is.list(eigenwalker(size), 0, 100),
    spread: is.record({
      rms: is.number(0),
      distances: is.list(is.number(0), 1, MOST_POINTS),
    }),
    walkers: is.list(knownWalker(size), 0, MOST_IN_CROWD),
    traits: is.list(trait(size, body), 0, 100),
  })(content, "model");
  const cloud = is.record({ cloud: readCloud(content_) })(content, "model");
  return { ...head, ...body, ...content_, ...cloud };
}

/** Blocks p0, p1 ... of all coordinates, the frequency, and free phases, one after the other. */
function readLayout(nMarkers: number, nPostures: number, form: Model["form"]): is.Reader<Model["layout"]> {
  const postures = Array.from({ length: nPostures + 1 }, (_, i) => [`p${i}`, 3 * nMarkers] as const);
  const free = form === "eigenposture" ? ([["phases", nPostures - 1]] as const) : [];
  const wanted = new Map<string, number>([...postures, ["frequency", 1], ...free]);
  const span = is.list(is.whole(0, 100_000), 2, 2);
  return (value, where) => {
    const spans = is.named(span)(value, where) as unknown as Record<string, Span>;
    for (const [block, size] of wanted) {
      const [start, end] = spans[block] ?? is.refuse(where, `the block "${block}"`, Object.keys(spans));
      if (end - start !== size) is.refuse(`${where}.${block}`, `${size} columns`, [start, end]);
    }
    const inOrder = Object.values(spans).sort((a, b) => a[0] - b[0]);
    const total = inOrder.reduce((at, [start, end]) => (start === at ? end : NaN), 0);
    if (Number.isNaN(total)) is.refuse(where, "blocks that lie side by side", spans);
    return spans;
  };
}

const eigenwalker = (size: number): is.Reader<Eigenwalker> =>
  is.record({
    vector: is.numbers(size),
    sd: is.number(Number.MIN_VALUE),
    share: is.number(0, 1),
  });

const knownWalker = (size: number): is.Reader<KnownWalker> =>
  is.record({
    name: is.text,
    row: is.whole(0, 10_000_000),
    vector: is.numbers(size),
    traits: is.named(traitValue),
  });

const traitValue: is.Reader<string | number | boolean | null> = (value, where) => {
  if (value === null || typeof value === "boolean") return value;
  return typeof value === "number" ? is.number()(value, where) : is.text(value, where);
};

function trait(size: number, model: Pick<Model, "layout">): is.Reader<Trait> {
  const steps: is.Reader<Record<string, readonly number[]>> = (value, where) => {
    const given = is.named((part) => part)(value, where);
    const read = Object.entries(given).map(([part, step]) => {
      const place = `${where}.${part}`;
      return [part, is.numbers(partSize(model, part, place))(step, place)] as const;
    });
    return Object.fromEntries(read);
  };
  return is.record({
    name: is.text,
    column: is.text,
    label: is.text,
    unit: is.text,
    negative: is.text,
    positive: is.text,
    two_classes: is.truth,
    steps: is.record({ discriminant: steps, mean_difference: steps }),
    projection: is.record({ gradient: is.numbers(size), offset: is.number() }),
    means: is.orNull(is.record({ negative: is.numbers(size), positive: is.numbers(size) })),
  });
}

function partSize(model: Pick<Model, "layout">, part: string, where: string): number {
  try {
    return columnsOf(model, part).length;
  } catch (error) {
    if (!(error instanceof Error)) throw error;
    return is.refuse(where, "a part of the features", part);
  }
}

/** Scores and numbers, as many as there are points. */
function readCloud(model: Pick<Model, "eigenwalkers" | "walkers">): is.Reader<Cloud> {
  return (value, where) => {
    const { n } = is.record({ n: is.whole(0, MOST_POINTS) })(value, where);
    return is.record({
      n: is.whole(n, n),
      scores: is.list(is.numbers(model.eigenwalkers.length), n, n),
      walker: is.list(is.whole(-1, model.walkers.length - 1), n, n),
    })(value, where);
  };
}
