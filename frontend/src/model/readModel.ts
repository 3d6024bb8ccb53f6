/** A model from parsed JSON, checked: its shapes fit each other, and all numbers are finite. */

import { checked, explained, refuse } from "../core/schema";
import { columnsOf } from "./features";
import { bodySchema, cloudSchema, COUNT, featureSchema, HEAD, numbers, type Model } from "./model";

/**
 * The model in the parsed content of a file.
 *
 * Throws `InvalidFile` with the first problem.
 */
export const readModel = (content: unknown): Model =>
  explained("This is no model of walkers", () => {
    const head = checked(content, HEAD, "model");
    const body = checked(content, bodySchema(head), "model");
    checkLayout({ ...head, ...body });
    const size = Math.max(...Object.values(body.layout).map(([, end]) => end));
    const features = checked(content, featureSchema(size), "model");
    const { n } = checked(content, COUNT, "model").cloud;
    const model = { ...head, ...body, ...features, ...checked(content, cloudSchema(n, features), "model") };
    model.traits.forEach((trait, i) => checkSteps(model, trait, `model.traits[${i}].steps`));
    return model;
  });

type Body = Pick<Model, "markers" | "harmonics" | "form" | "layout">;

/** Blocks p0, p1 ... of all coordinates, the frequency, and free phases, without gaps. */
function checkLayout({ markers, harmonics, form, layout }: Body): void {
  const where = "model.layout";
  const sizes = new Map([["frequency", 1]]);
  if (form === "eigenposture") sizes.set("phases", harmonics.length - 1);
  for (let i = 0; i <= harmonics.length; i++) sizes.set(`p${i}`, 3 * markers.length);
  for (const [block, size] of sizes) {
    const [start, end] = layout[block] ?? refuse(where, `the block "${block}"`, Object.keys(layout));
    if (end - start !== size) refuse(`${where}.${block}`, `${size} columns`, [start, end]);
  }
  const spans = Object.values(layout).toSorted((a, b) => a[0] - b[0]);
  const total = spans.reduce((at, [start, end]) => (start === at ? end : NaN), 0);
  if (Number.isNaN(total)) refuse(where, "blocks without gaps", layout);
}

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
