/**
 * A state as the fragment of an address, short: values of the initial state are left out.
 *
 * `sex:3,weight_kg:-2` is written `t=sex:3,weight_kg:-2`. Anybody may write an address: unknown names and
 * invalid numbers are ignored, and numbers are brought within their ranges.
 */

import { entry } from "../core/schema";
import { partsOf } from "./mixing";
import type { Model } from "./model";
import {
  clamped, fieldsOf, initialSettings, initialState, MAX_SIDE_BY_SIDE, RANGES, TRANSFORM_NAMES, wrappedDegrees,
  type Bias, type Field, type State, type TransformName, type Transforms,
} from "./state";

type Range = readonly [number, number];

/** Writes a part of the state, and reads it; undefined for an invalid text. */
interface Code<T> {
  readonly name: string;
  write(value: T): string;
  read(text: string, model: Model): T | undefined;
}

type CodedPart = Exclude<keyof State, "playing">;

const CODES: { readonly [Part in CodedPart]: Code<State[Part]> } = {
  traits: {
    name: "t",
    write: (traits) => pairs(Object.entries(traits).filter(([, steps]) => steps !== 0)),
    read: (text, { traits }) => {
      const known = splitPairs(text).filter(([name]) => traits.some((trait) => trait.name === name));
      return Object.fromEntries(
        known.flatMap(([name, steps]) => numbersIn(steps, RANGES.trait).map((value) => [name, value])),
      );
    },
  },
  kind: choice("k", { discriminant: "d", mean_difference: "m" }),
  part: {
    name: "p",
    write: (part) => part,
    read: (text, model) => partsOf(model).find((part) => part === text),
  },
  from: {
    name: "w",
    write: String,
    read: (text, { walkers }) =>
      text === "own" || text === "average" ? text : indices(text, walkers.length)[0],
  },
  bias: {
    name: "b",
    write: (bias) => (bias ? pairs([[bias.trait, bias.steps]]) : ""),
    read: readBias,
  },
  keepSize: flag("size"),
  strengths: list("s", RANGES.strength, (model) => model.harmonics.length, 1),
  eigenwalkers: list("e", RANGES.eigenwalker, (model) => model.eigenwalkers.length, 0),
  tempo: number("v", RANGES.tempo),
  azimuth_deg: {
    name: "az",
    write: short,
    read: (text) => numbersIn(text, [-1e6, 1e6]).map(wrappedDegrees)[0],
  },
  elevation_deg: number("el", RANGES.elevation_deg),
  zoom: number("z", RANGES.zoom),
  perspective: flag("eye"),
  turning_deg_s: number("turn", RANGES.turning_deg_s),
  style: choice("as", { dots: "dots", sticks: "sticks", mannequin: "body" }),
  trails: flag("trails"),
  dark: flag("dark"),
  scene: choice("show", { one: "one", four: "four", side: "side", crowd: "crowd" }),
  walkers: {
    name: "who",
    write: (walkers) => walkers.join(","),
    read: (text, { walkers }) => {
      const numbers = indices(text, walkers.length).slice(0, MAX_SIDE_BY_SIDE);
      return numbers.length > 0 ? numbers : undefined;
    },
  },
  transforms: {
    name: "x",
    write: (transforms) => TRANSFORM_NAMES.flatMap((name) => writeTransform(name, transforms)).join(","),
    read: (text) => Object.fromEntries(text.split(",").flatMap(readTransform)) as Transforms,
  },
  cycle: number("at", RANGES.cycle),
};

const CODED_PARTS = Object.keys(CODES) as CodedPart[];

export function addressOf(state: State, model: Model): string {
  const initial = initialState(model);
  const words = CODED_PARTS.flatMap((part) => {
    const { name, write } = CODES[part] as Code<unknown>;
    const text = write(state[part]);
    return text === write(initial[part]) || (part === "cycle" && state.playing) ? [] : [`${name}=${text}`];
  });
  return [...words, ...(state.playing ? [] : ["still"])].join("&");
}

/** The state in a fragment; parts that it does not have are those of the initial state. */
export function stateOf(address: string, model: Model): State {
  const words = new Map(
    address.replace(/^#/, "").slice(0, 8000).split("&").map((word) => {
      const [name = "", ...others] = word.split("=");
      return [name, others.join("=")] as const;
    }),
  );
  const parts = CODED_PARTS.flatMap((part) => {
    const code = CODES[part] as Code<unknown>;
    const text = words.get(code.name);
    const value = text === undefined ? undefined : code.read(text, model);
    return value === undefined ? [] : [[part, value] as const];
  });
  return { ...initialState(model), ...Object.fromEntries(parts), playing: !words.has("still") };
}

/** A number with three decimals at most. */
function short(value: number): string {
  return String(Math.round(value * 1000) / 1000 + 0);
}

/** The number in a text, in its range; empty for an invalid text. */
function numbersIn(text: string, range: Range): number[] {
  const value = text.trim() === "" ? NaN : Number(text);
  return Number.isFinite(value) ? [clamped(range, value)] : [];
}

const indices = (text: string, below: number): number[] =>
  text.split(",").filter((word) => /^\d{1,6}$/.test(word)).map(Number).filter((value) => value < below);

function number(name: string, range: Range): Code<number> {
  return { name, write: short, read: (text) => numbersIn(text, range)[0] };
}

function flag(name: string): Code<boolean> {
  return {
    name,
    write: (value) => (value ? "1" : "0"),
    read: (text) => (text === "1" ? true : text === "0" ? false : undefined),
  };
}

function choice<Choice extends string>(name: string, words: Readonly<Record<Choice, string>>): Code<Choice> {
  return {
    name,
    write: (value) => words[value],
    read: (text) => (Object.keys(words) as Choice[]).find((choice) => words[choice] === text),
  };
}

/** Numbers in order, without the initial values at the end. */
function list(name: string, range: Range, size: (model: Model) => number, initial: number): Code<readonly number[]> {
  const end = new RegExp(`(^|,)${initial}(,${initial})*$`);
  return {
    name,
    write: (values) => values.map(short).join(",").replace(end, ""),
    read: (text, model) => {
      const words = text.split(",");
      return Array.from({ length: size(model) }, (_, i) => numbersIn(words[i] ?? "", range)[0] ?? initial);
    },
  };
}

const pairs = (entries: readonly (readonly [string, number])[]): string =>
  entries.map(([name, value]) => `${encodeURIComponent(name)}:${short(value)}`).join(",");

/** Names and values of a text like `a:1,b:2`. */
function splitPairs(text: string): [string, string][] {
  return text.split(",").map((word) => {
    const [name = "", value = ""] = word.split(":");
    return [decoded(name), value];
  });
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text; // a lone %
  }
}

function readBias(text: string, { traits }: Model): Bias | undefined {
  const [[name, steps] = ["", ""]] = splitPairs(text);
  const trait = traits.find((each) => each.name === name && each.means !== null);
  const [value] = numbersIn(steps, RANGES.bias);
  return trait && value !== undefined ? { trait: trait.name, steps: value } : undefined;
}

/** `scramble;keep:structure`: a name, and the parameters that differ from the initial ones. */
function writeTransform(name: TransformName, transforms: Transforms): string[] {
  if (!(name in transforms)) return [];
  const initial = initialSettings(name) as Record<string, unknown>;
  const changed = Object.entries(transforms[name] as Record<string, number | string>)
    .filter(([field, value]) => value !== initial[field])
    .map(([field, value]) => `;${field}:${typeof value === "number" ? short(value) : value}`);
  return [[name, ...changed].join("")];
}

function readTransform(text: string): [string, object][] {
  const [word, ...parts] = text.split(";");
  const name = TRANSFORM_NAMES.find((known) => known === word);
  if (!name) return [];
  const fields = fieldsOf(name);
  const settings = parts.flatMap((part) => {
    const [field = "", value = ""] = part.split(":");
    const known = entry(fields, field);
    return known ? readSetting(known, value).map((setting) => [field, setting] as const) : [];
  });
  return [[name, { ...initialSettings(name), ...Object.fromEntries(settings) }]];
}

function readSetting(field: Field, text: string): (number | string)[] {
  if ("choices" in field) return field.choices.filter((choice) => choice === text);
  const values = numbersIn(text, [field.low, field.high]);
  return Number.isInteger(field.step) && Number.isInteger(field.low) ? values.map(Math.round) : values;
}
