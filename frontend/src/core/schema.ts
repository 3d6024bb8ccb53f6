/**
 * Parsed JSON checked against a JSON Schema, with defaults filled in: the one check of all files.
 *
 * It covers the part of JSON Schema that our schemas use. Code that ajv generates would be ten times as
 * long as the schema itself, and its messages say less.
 */

type Limit =
  | "minimum" | "exclusiveMinimum" | "maximum" | "maxProperties"
  | "minLength" | "maxLength" | "minItems" | "maxItems";

/** A schema of values of a type. */
export interface Schema<T = unknown> extends Readonly<Partial<Record<Limit, number>>> {
  /** The type alone; no schema has this field. */
  readonly inferred?: T;
  readonly $ref?: string;
  readonly $defs?: Readonly<Record<string, Schema>>;
  readonly type?: string;
  readonly enum?: readonly unknown[];
  readonly const?: unknown;
  readonly default?: unknown;
  readonly pattern?: string;
  readonly items?: Schema;
  readonly uniqueItems?: boolean;
  readonly properties?: Readonly<Record<string, Schema>>;
  readonly required?: readonly string[];
  readonly propertyNames?: Schema;
  /** False: other names are refused. Left out: other names are ignored. */
  readonly additionalProperties?: boolean | Schema;
  readonly anyOf?: readonly Schema[];
  readonly oneOf?: readonly Schema[];
}

/** A value of an object by a name that others chose: "constructor" is in every object, and in none of its own. */
export const entry = <T>(values: Readonly<Record<string, T>>, name: string): T | undefined =>
  Object.hasOwn(values, name) ? values[name] : undefined;

/** The type of the values of a schema. */
export type Checked<S> = S extends Schema<infer T> ? T : never;

/** A file that cannot be used; the message says where and why. */
export class InvalidFile extends Error {}

/** Refuse a value at a place of a file. */
export function refuse(where: string, expected: string, value: unknown): never {
  const got = (JSON.stringify(value) ?? "nothing").slice(0, 80);
  throw new InvalidFile(`${where}: expected ${expected}, got ${got}.`);
}

/** Say first what all errors of a reader are about. */
export function explained<T>(about: string, read: () => T): T {
  try {
    return read();
  } catch (error) {
    throw error instanceof InvalidFile ? new InvalidFile(`${about}: ${error.message}`) : error;
  }
}

/** A copy of the value that keeps to the schema; `where` names its place in messages. */
export function checked<T>(value: unknown, schema: Schema<T>, where: string): T {
  const definitions = schema.$defs ?? {};

  function check(value: unknown, given: Schema, where: string): unknown {
    const schema = resolved(given);
    if (schema.oneOf) return check(value, ofName(value, schema.oneOf, where), where);
    if (schema.anyOf) return checkAny(value, schema.anyOf.map(resolved), where);
    if ("const" in schema) return value === schema.const ? value : refuse(where, String(schema.const), value);
    if (schema.enum) return schema.enum.includes(value) ? value : refuse(where, schema.enum.join(" or "), value);
    switch (schema.type) {
      case "number":
      case "integer":
        return checkNumber(value, schema, where);
      case "string":
        return checkText(value, schema, where);
      case "boolean":
        return typeof value === "boolean" ? value : refuse(where, "true or false", value);
      case "null":
        return value === null ? value : refuse(where, "null", value);
      case "array":
        return checkList(value, schema, where);
      case "object":
        return checkObject(value, schema, where);
      default:
        return value;
    }
  }

  const resolved = (schema: Schema): Schema =>
    schema.$ref === undefined ? schema : resolved(definitions[schema.$ref.replace("#/$defs/", "")]!);

  /** The kind of object whose `name` the value has. */
  function ofName(value: unknown, kinds: readonly Schema[], where: string): Schema {
    const name = isObject(value) ? value["name"] : undefined;
    const kind = kinds.map(resolved).find(({ properties }) => properties?.["name"]?.const === name);
    return kind ?? refuse(where, "the name of a transform", name);
  }

  /** By the first kind that fits; the message is about the first that is not null. */
  function checkAny(value: unknown, kinds: readonly Schema[], where: string): unknown {
    if (value === null && kinds.some(({ type }) => type === "null")) return null;
    const others = kinds.filter(({ type }) => type !== "null");
    const last = others.at(-1)!;
    for (const kind of others.slice(0, -1)) {
      try {
        return check(value, kind, where);
      } catch (error) {
        if (!(error instanceof InvalidFile)) throw error;
      }
    }
    return check(value, last, where);
  }

  function checkList(value: unknown, schema: Schema, where: string): unknown[] {
    const { minItems = 0, maxItems = Infinity, items = {} } = schema;
    const expected = `a list of ${span(minItems, maxItems)} values`;
    if (!Array.isArray(value)) return refuse(where, expected, value);
    if (value.length < minItems || value.length > maxItems) refuse(where, expected, value.length);
    if (schema.uniqueItems && new Set(value).size < value.length) {
      refuse(where, "values that differ from each other", "some twice");
    }
    return value.map((item, i) => check(item, items, `${where}[${i}]`));
  }

  function checkObject(value: unknown, schema: Schema, where: string): Record<string, unknown> {
    if (!isObject(value)) return refuse(where, "an object", value);
    const { properties = {}, required = [], additionalProperties: others = true, maxProperties = Infinity } = schema;
    const names = Object.keys(value);
    if (names.length > maxProperties) refuse(where, `${maxProperties} names at most`, names.length);
    const result: [string, unknown][] = [];
    for (const name of names) {
      if (schema.propertyNames) check(name, schema.propertyNames, where);
      const known = entry(properties, name) ?? others;
      if (known === false) refuse(where, "no such name", name);
      if (typeof known === "object") result.push([name, check(value[name], known, `${where}.${name}`)]);
    }
    for (const [name, property] of Object.entries(properties)) {
      if (Object.hasOwn(value, name)) continue;
      if (required.includes(name)) refuse(where, `"${name}"`, "none");
      if ("default" in property) result.push([name, property.default]);
    }
    return Object.fromEntries(result);
  }

  return check(value, schema, where) as T;
}

function checkNumber(value: unknown, schema: Schema, where: string): number {
  const { type, exclusiveMinimum: above, minimum: low = above ?? -Infinity, maximum: high = Infinity } = schema;
  const expected = `${type} from ${low} to ${high}`;
  if (typeof value !== "number" || !(value >= low && value <= high)) return refuse(where, expected, value);
  if (value === above) refuse(where, `${type} above ${above}`, value);
  return type === "integer" && !Number.isInteger(value) ? refuse(where, expected, value) : value;
}

function checkText(value: unknown, { minLength = 0, maxLength = Infinity, pattern }: Schema, where: string): string {
  if (typeof value !== "string") return refuse(where, "text", value);
  const { length } = [...value];
  if (length < minLength || length > maxLength) refuse(where, `text of ${span(minLength, maxLength)} letters`, value);
  return pattern && !new RegExp(pattern).test(value) ? refuse(where, `text like ${pattern}`, value) : value;
}

const span = (low: number, high: number): string => (low === high ? String(low) : `${low} to ${high}`);

const isObject = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);
