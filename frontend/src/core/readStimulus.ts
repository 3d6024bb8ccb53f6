/** Stimulus files held against their published schema, defaults filled in. */

import schema from "../../../src/eigenwalker/stimulus/schema.json";
import type { Stimulus, Walker } from "./stimulus";
import { adds } from "./transforms";

/** As much of JSON Schema as the schema of stimuli needs. */
interface Schema {
  readonly $ref?: string;
  readonly $defs?: Readonly<Record<string, Schema>>;
  readonly type?: string;
  readonly enum?: readonly unknown[];
  readonly const?: unknown;
  readonly minimum?: number;
  readonly exclusiveMinimum?: number;
  readonly maximum?: number;
  readonly minLength?: number;
  readonly maxLength?: number;
  readonly pattern?: string;
  readonly items?: Schema;
  readonly minItems?: number;
  readonly maxItems?: number;
  readonly uniqueItems?: boolean;
  readonly properties?: Readonly<Record<string, Schema>>;
  readonly required?: readonly string[];
  readonly additionalProperties?: boolean | Schema;
  readonly maxProperties?: number;
  readonly default?: unknown;
  readonly anyOf?: readonly Schema[];
  readonly oneOf?: readonly Schema[];
}

/** Dots that may have to be computed for one moment, `MAX_WORK` in Python's `schema.py`. */
export const MOST_WORK = 1_000_000;

/** What is no stimulus, and why. */
export class NoStimulus extends Error {}

/**
 * The stimulus that the parsed content of a file describes.
 *
 * Throws `NoStimulus` with the first thing amiss.
 */
export function readStimulus(content: unknown): Stimulus {
  const stimulus = kept(content, schema as Schema, "stimulus") as Stimulus;
  stimulus.figures.forEach((figure, number) => {
    const where = `figures[${number}]`;
    if ((figure.walker === null) === (figure.trajectories === null)) {
      throw new NoStimulus(`${where}: expected either walker or trajectories.`);
    }
    if (figure.walker) checkWalker(figure.walker, `${where}.walker`);
    const { markers } = (figure.walker ?? figure.trajectories)!;
    for (const name of [...figure.segments, ...figure.pairs].flat()) {
      if (!markers.includes(name)) throw new NoStimulus(`${where}: there is no dot "${name}".`);
    }
    for (const frame of figure.trajectories?.samples ?? []) {
      if (frame.length !== markers.length) {
        throw new NoStimulus(`${where}: ${markers.length} dots, but a frame of ${frame.length}.`);
      }
    }
  });
  checkChain(stimulus);
  return stimulus;
}

function checkWalker(walker: Walker, where: string): void {
  const nDots = walker.markers.length;
  if ([walker.p0, ...walker.p].some((posture) => posture.length !== nDots)) {
    throw new NoStimulus(`${where}: ${nDots} dots, but postures of another number.`);
  }
  const lengths = new Set([walker.p.length, walker.harmonics.length, walker.phases.length]);
  if (lengths.size > 1) {
    throw new NoStimulus(`${where}: postures, harmonics and phases differ in number.`);
  }
}

/** Follow the dots through the chain: transforms must name figures and dots that are there. */
function checkChain({ figures, transforms }: Stimulus): void {
  const dots = figures.map((figure) => (figure.walker ?? figure.trajectories)!.markers);
  const joined = figures.map((figure) => figure.segments.length > 0);
  const evaluations = figures.map(() => 1);
  let work = 0;
  transforms.forEach((step, number) => {
    const where = `transforms[${number}] (${step.name})`;
    if (adds(step) && (step.figures ?? figures).length > 1) {
      throw new NoStimulus(`${where}: name one figure, as in figures: [0].`);
    }
    for (const figure of step.figures ?? figures.keys()) {
      const there = dots[figure];
      if (!there) throw new NoStimulus(`${where}: there is no figure ${figure}.`);
      const lacking = needed(step).find((name) => !there.includes(name));
      if (lacking !== undefined) throw new NoStimulus(`${where}: there is no dot "${lacking}".`);
      if (step.name === "morph") {
        checkWalker(step.walker, `${where}.walker`);
        if (there.some((name) => !step.walker.markers.includes(name)) || !(step.end_s > step.start_s)) {
          throw new NoStimulus(`${where}: the other walker lacks dots, or it ends before it starts.`);
        }
      }
      if (step.name === "limb_dots") {
        if (step.places === "limbs" && !joined[figure]) {
          throw new NoStimulus(`${where}: the figure has no segments to put dots on; use joints.`);
        }
        dots[figure] = Array.from({ length: step.number }, (_, dot) => `dot_${dot + 1}`);
        joined[figure] = false;
      }
      if (step.name === "mask") {
        const clocks = step.phases ? step.number : 1;
        work += step.number + clocks * evaluations[figure]! * there.length;
      }
      evaluations[figure] = moreEvaluations(step, evaluations[figure]!, there.length);
    }
  });
  work += dots.reduce((sum, there, figure) => sum + evaluations[figure]! * there.length, 0);
  if (work > MOST_WORK) {
    throw new NoStimulus(
      `This is no stimulus: its chain computes ${work} dots for one moment, and no more than ${MOST_WORK} are ` +
        "shown in time; use fewer dots or fewer transforms that give each dot a clock.",
    );
  }
}

/** How often a figure is computed for one moment, after one more transform. */
function moreEvaluations(step: Stimulus["transforms"][number], before: number, nDots: number): number {
  if (step.name === "phase_scramble") return before * nDots;
  if (step.name === "delay" || step.name === "morph") return before * 2;
  return step.name === "limb_dots" ? before + 1 : before;
}

/** Dots that a transform cannot do without. */
function needed(step: Stimulus["transforms"][number]): readonly string[] {
  if (step.name === "conflict" || step.name === "ellipses") {
    return ["left_shoulder", "right_shoulder", "left_hip", "right_hip"];
  }
  return "markers" in step ? step.markers : [];
}

/** A schema with the definition that it refers to. */
function resolved(part: Schema): Schema {
  return part.$ref ? { ...(schema as Schema).$defs?.[part.$ref.split("/").at(-1)!], ...part } : part;
}

/** A value in its plain form, or an error that says where it departs from its schema. */
function kept(value: unknown, part: Schema, where: string): unknown {
  const schema = resolved(part);
  if (schema.oneOf) return kept(value, branch(value, schema.oneOf, where), where);
  if (schema.anyOf) return keptByAny(value, schema.anyOf, where);
  if ("const" in schema && value !== schema.const) refuse(where, String(schema.const), value);
  if (schema.enum && !schema.enum.includes(value)) refuse(where, schema.enum.join(" or "), value);
  switch (schema.type) {
    case "number":
    case "integer":
      return keptNumber(value, schema, where);
    case "string":
      return keptText(value, schema, where);
    case "boolean":
      return typeof value === "boolean" ? value : refuse(where, "true or false", value);
    case "null":
      return value === null ? value : refuse(where, "null", value);
    case "array":
      return keptList(value, schema, where);
    case "object":
      return keptObject(value, schema, where);
    default:
      return value;
  }
}

/** The one of several kinds of object whose name the value bears. */
function branch(value: unknown, kinds: readonly Schema[], where: string): Schema {
  const name = isObject(value) ? value["name"] : undefined;
  const found = kinds.map(resolved).find((kind) => kind.properties?.["name"]?.const === name);
  return found ?? refuse(where, "the name of a transform", name);
}

function keptByAny(value: unknown, kinds: readonly Schema[], where: string): unknown {
  if (value === null && kinds.some(({ type }) => type === "null")) return null;
  const [last, ...others] = kinds.filter(({ type }) => type !== "null").reverse();
  for (const kind of others) {
    try {
      return kept(value, kind, where);
    } catch (error) {
      if (!(error instanceof NoStimulus)) throw error;
    }
  }
  return kept(value, last!, where);
}

function keptNumber(value: unknown, schema: Schema, where: string): number {
  const low = schema.minimum ?? schema.exclusiveMinimum ?? -Infinity;
  const high = schema.maximum ?? Infinity;
  const wanted = `${schema.type} from ${low} to ${high}`;
  if (typeof value !== "number" || !(value >= low && value <= high)) refuse(where, wanted, value);
  if (value === schema.exclusiveMinimum) refuse(where, `${schema.type} above ${low}`, value);
  if (schema.type === "integer" && !Number.isInteger(value)) refuse(where, wanted, value);
  return value;
}

function keptText(value: unknown, schema: Schema, where: string): string {
  const { minLength = 0, maxLength = Infinity, pattern } = schema;
  if (typeof value !== "string") return refuse(where, "text", value);
  const length = [...value].length;
  const wanted = `text of ${minLength} to ${maxLength} letters`;
  if (length < minLength || length > maxLength) refuse(where, wanted, value);
  if (pattern && !new RegExp(pattern).test(value)) refuse(where, `text like ${pattern}`, value);
  return value;
}

function keptList(value: unknown, schema: Schema, where: string): unknown[] {
  const { minItems = 0, maxItems = Infinity, items = {} } = schema;
  const wanted = `a list of ${minItems} to ${maxItems} values`;
  if (!Array.isArray(value)) return refuse(where, wanted, value);
  if (value.length < minItems || value.length > maxItems) refuse(where, wanted, value.length);
  if (schema.uniqueItems && new Set(value).size < value.length) {
    refuse(where, "values that differ from each other", "some twice");
  }
  return value.map((item, i) => kept(item, items, `${where}[${i}]`));
}

function keptObject(value: unknown, schema: Schema, where: string): Record<string, unknown> {
  if (!isObject(value)) return refuse(where, "an object", value);
  const { properties = {}, required = [], additionalProperties } = schema;
  const result: Record<string, unknown> = {};
  for (const [name, item] of Object.entries(value)) {
    const known = Object.hasOwn(properties, name) ? properties[name] : additionalProperties;
    if (typeof known !== "object") return refuse(where, "no such name", name);
    result[name] = kept(item, known, `${where}.${name}`);
  }
  for (const [name, property] of Object.entries(properties)) {
    if (name in result) continue;
    if (required.includes(name)) refuse(where, `"${name}"`, "none");
    result[name] = property.default;
  }
  return result;
}

const isObject = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);

function refuse(where: string, wanted: string, came: unknown): never {
  const said = (JSON.stringify(came) ?? "nothing").slice(0, 80);
  throw new NoStimulus(`This is no stimulus: ${where}: expected ${wanted}, got ${said}.`);
}
