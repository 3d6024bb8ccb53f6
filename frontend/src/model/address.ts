/**
 * What was chosen as the end of an address, short: all that is as it was at first is left out.
 *
 * `sex:3,weight_kg:-2` reads `t=sex:3,weight_kg:-2`. An address comes from anybody: what is
 * unknown or no number is passed over, and numbers are brought within their ranges.
 */

import { partsOf } from "./mixing";
import type { Model } from "./model";
import {
  initialState, MOST_SIDE_BY_SIDE, RANGES, TRANSFORM_NAMES, TRANSFORMS, usualSettings, within,
  wrappedDegrees, type Bias, type Field, type State, type TransformName, type Transforms,
} from "./state";

type Range = readonly [number, number];

/** Writes a part of the state, and reads it; undefined for what says nothing. */
interface Code<T> {
  readonly name: string;
  write(value: T): string;
  read(text: string, model: Model): T | undefined;
}

type Coded = Exclude<keyof State, "playing">;

const CODES: { readonly [Part in Coded]: Code<State[Part]> } = {
  traits: {
    name: "t",
    write: (traits) => pairs(Object.entries(traits).filter(([, steps]) => steps !== 0)),
    read: (text, model) => {
      const known = split(text).filter(([name]) => model.traits.some((trait) => trait.name === name));
      return Object.fromEntries(
        known.flatMap(([name, steps]) => numeric(steps, RANGES.trait).map((value) => [name, value])),
      );
    },
  },
  kind: chosen("k", { discriminant: "d", mean_difference: "m" }),
  part: {
    name: "p",
    write: (part) => part,
    read: (text, model) => partsOf(model).find((part) => part === text),
  },
  from: {
    name: "w",
    write: String,
    read: (text, model) => {
      if (text === "own" || text === "average") return text;
      return wholes(text, model.walkers.length)[0];
    },
  },
  bias: {
    name: "b",
    write: (bias) => (bias ? pairs([[bias.trait, bias.steps]]) : ""),
    read: biasOf,
  },
  strengths: list("s", RANGES.strength, (model) => model.harmonics.length, 1),
  eigenwalkers: list("e", RANGES.eigenwalker, (model) => model.eigenwalkers.length, 0),
  tempo: amount("v", RANGES.tempo),
  azimuth_deg: {
    name: "az",
    write: short,
    read: (text) => numeric(text, [-1e6, 1e6]).map(wrappedDegrees)[0],
  },
  elevation_deg: amount("el", RANGES.elevation_deg),
  perspective: truth("eye"),
  turning_deg_s: amount("turn", RANGES.turning_deg_s),
  style: chosen("as", { dots: "dots", sticks: "sticks", mannequin: "body" }),
  trails: truth("trails"),
  dark: truth("dark"),
  scene: chosen("show", { one: "one", four: "four", side: "side", crowd: "crowd" }),
  walkers: {
    name: "who",
    write: (walkers) => walkers.join(","),
    read: (text, model) => {
      const found = wholes(text, model.walkers.length).slice(0, MOST_SIDE_BY_SIDE);
      return found.length > 0 ? found : undefined;
    },
  },
  transforms: {
    name: "x",
    write: (transforms) => TRANSFORM_NAMES.filter((name) => name in transforms).map((name) => written(name, transforms)).join(","),
    read: (text) => Object.fromEntries(text.split(",").flatMap(transformOf)) as Transforms,
  },
  cycle: amount("at", RANGES.cycle),
};

const PARTS = Object.keys(CODES) as Coded[];

/** The end of an address, without "#"; nothing where nothing was changed. */
export function addressOf(state: State, model: Model): string {
  const usual = initialState(model);
  const said = PARTS.flatMap((part) => {
    const { name, write } = CODES[part] as Code<unknown>;
    const text = write(state[part]);
    return text === write(usual[part]) || (part === "cycle" && state.playing) ? [] : [`${name}=${text}`];
  });
  return [...said, ...(state.playing ? [] : ["still"])].join("&");
}

/** The state that the end of an address describes; what it does not tell is as usual. */
export function stateOf(address: string, model: Model): State {
  const given = new Map(
    address.replace(/^#/, "").slice(0, 8000).split("&").map((word) => {
      const [name = "", ...others] = word.split("=");
      return [name, others.join("=")] as const;
    }),
  );
  const read = PARTS.flatMap((part) => {
    const code = CODES[part] as Code<unknown>;
    const text = given.get(code.name);
    const value = text === undefined ? undefined : code.read(text, model);
    return value === undefined ? [] : [[part, value] as const];
  });
  return { ...initialState(model), ...Object.fromEntries(read), playing: !given.has("still") };
}

/** A number with as many decimals as anyone sets by hand. */
function short(value: number): string {
  return String(Math.round(value * 1000) / 1000 + 0);
}

/** The number in a text, in its range; nothing where there is none. */
function numeric(text: string, range: Range): number[] {
  const value = text.trim() === "" ? NaN : Number(text);
  return Number.isFinite(value) ? [within(range, value)] : [];
}

const wholes = (text: string, below: number): number[] =>
  text.split(",").filter((word) => /^\d{1,6}$/.test(word)).map(Number).filter((value) => value < below);

function amount<Name extends string>(name: Name, range: Range): Code<number> {
  return { name, write: short, read: (text) => numeric(text, range)[0] };
}

function truth(name: string): Code<boolean> {
  return {
    name,
    write: (value) => (value ? "1" : "0"),
    read: (text) => (text === "1" ? true : text === "0" ? false : undefined),
  };
}

function chosen<Choice extends string>(name: string, words: Readonly<Record<Choice, string>>): Code<Choice> {
  return {
    name,
    write: (value) => words[value],
    read: (text) => (Object.keys(words) as Choice[]).find((choice) => words[choice] === text),
  };
}

/** Numbers in order, those at the end that are as usual left out. */
function list(name: string, range: Range, size: (model: Model) => number, usual: number): Code<readonly number[]> {
  return {
    name,
    write: (values) => values.map(short).join(",").replace(new RegExp(`(^|,)${usual}(,${usual})*$`), ""),
    read: (text, model) => {
      const words = text.split(",");
      return Array.from({ length: size(model) }, (_, i) => numeric(words[i] ?? "", range)[0] ?? usual);
    },
  };
}

const pairs = (entries: readonly (readonly [string, number])[]): string =>
  entries.map(([name, value]) => `${encodeURIComponent(name)}:${short(value)}`).join(",");

/** Names and what is said of them. */
function split(text: string): [string, string][] {
  return text.split(",").map((word) => {
    const [name = "", value = ""] = word.split(":");
    return [decoded(name), value];
  });
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text; // a lone %, which nobody meant
  }
}

function biasOf(text: string, model: Model): Bias | undefined {
  const [[name, steps] = ["", ""]] = split(text);
  const trait = model.traits.find((each) => each.name === name && each.means !== null);
  const [value] = numeric(steps, RANGES.bias);
  return trait && value !== undefined ? { trait: trait.name, steps: value } : undefined;
}

/** `scramble;keep:structure`: a name, and the parameters that are not as usual. */
function written(name: TransformName, transforms: Transforms): string {
  const usual = usualSettings(name) as Record<string, unknown>;
  const settings = Object.entries(transforms[name] as Record<string, number | string>);
  const said = settings
    .filter(([field, value]) => value !== usual[field])
    .map(([field, value]) => `;${field}:${typeof value === "number" ? short(value) : value}`);
  return [name, ...said].join("");
}

function transformOf(text: string): [string, object][] {
  const [word, ...said] = text.split(";");
  const name = TRANSFORM_NAMES.find((known) => known === word);
  if (!name) return [];
  const fields = TRANSFORMS[name] as Readonly<Record<string, Field>>;
  const settings = said.flatMap((part) => {
    const [field = "", value = ""] = part.split(":");
    const known = Object.hasOwn(fields, field) ? fields[field] : undefined;
    return known ? settingOf(known, value).map((setting) => [field, setting] as const) : [];
  });
  return [[name, { ...usualSettings(name), ...Object.fromEntries(settings) }]];
}

function settingOf(field: Field, text: string): (number | string)[] {
  if ("choices" in field) return field.choices.filter((choice) => choice === text);
  const values = numeric(text, [field.low, field.high]);
  return Number.isInteger(field.step) && Number.isInteger(field.low) ? values.map(Math.round) : values;
}
