/** Parsed JSON from anywhere, read value by value, or refused with the place and what was expected. */

/** What is no model, and why. */
export class NoModel extends Error {}

/** Reads one value; `where` is its place in the file. */
export type Reader<T> = (value: unknown, where: string) => T;

export function refuse(where: string, wanted: string, came: unknown): never {
  const said = (JSON.stringify(came) ?? "nothing").slice(0, 60);
  throw new NoModel(`This is no model of walkers: ${where}: expected ${wanted}, got ${said}.`);
}

export function number(low = -1e9, high = 1e9): Reader<number> {
  return (value, where) => {
    if (typeof value === "number" && value >= low && value <= high) return value;
    return refuse(where, `a number from ${low} to ${high}`, value);
  };
}

export function whole(low: number, high: number): Reader<number> {
  const read = number(low, high);
  return (value, where) => {
    const found = read(value, where);
    return Number.isInteger(found) ? found : refuse(where, "a whole number", value);
  };
}

/** Text to show; it is never taken for HTML. */
export const text: Reader<string> = (value, where) =>
  typeof value === "string" && value.length <= 2000 ? value : refuse(where, "text", value);

export const truth: Reader<boolean> = (value, where) =>
  typeof value === "boolean" ? value : refuse(where, "true or false", value);

export function oneOf<const Choice>(...choices: readonly Choice[]): Reader<Choice> {
  return (value, where) => {
    const found = choices.find((choice) => choice === value);
    return found === undefined ? refuse(where, choices.map(String).join(" or "), value) : found;
  };
}

export function orNull<T>(read: Reader<T>): Reader<T | null> {
  return (value, where) => (value === null || value === undefined ? null : read(value, where));
}

export function list<T>(read: Reader<T>, fewest = 0, most = 100_000): Reader<T[]> {
  return (value, where) => {
    if (!Array.isArray(value)) return refuse(where, "a list", value);
    if (value.length < fewest || value.length > most) {
      const wanted = fewest === most ? `${most} values` : `${fewest} to ${most} values`;
      return refuse(where, wanted, value.length);
    }
    return value.map((item, i) => read(item, `${where}[${i}]`));
  };
}

export const numbers = (length: number): Reader<number[]> => list(number(), length, length);

/** An object of any names. */
export function named<T>(read: Reader<T>, most = 1000): Reader<Record<string, T>> {
  return (value, where) => {
    const entries = Object.entries(object(value, where));
    if (entries.length > most) return refuse(where, `${most} names at most`, entries.length);
    return Object.fromEntries(entries.map(([name, item]) => [name, read(item, `${where}.${name}`)]));
  };
}

type Fields<T> = { readonly [Name in keyof T]: Reader<T[Name]> };

/** An object of these names; others are passed over. */
export function record<T>(fields: Fields<T>): Reader<T> {
  return (value, where) => {
    const given = object(value, where);
    const item = (name: string): unknown => (Object.hasOwn(given, name) ? given[name] : undefined);
    const readers = Object.entries(fields) as [string, Reader<unknown>][];
    const read = readers.map(([name, reader]) => [name, reader(item(name), `${where}.${name}`)]);
    return Object.fromEntries(read) as T;
  };
}

function object(value: unknown, where: string): Record<string, unknown> {
  if (typeof value !== "object" || value === null || Array.isArray(value)) {
    return refuse(where, "an object", value);
  }
  return value as Record<string, unknown>;
}
