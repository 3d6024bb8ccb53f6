// A state as an address and back.

import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

import { uniforms } from "../src/core/randomStream";
import { addressOf, stateOf } from "../src/model/address";
import { mixedVector } from "../src/model/mixing";
import { readModel } from "../src/model/readModel";
import {
  initialState, RANGES, TRANSFORM_NAMES, TRANSFORMS, initialSettings, wrappedDegrees,
  type Field, type State,
} from "../src/model/state";

const file = new URL("../../tests/golden/model.json", import.meta.url);
const model = readModel(JSON.parse(readFileSync(file, "utf8")).model);
const initial = initialState(model);

/** A state with everything drawn at random, in steps that a slider has. */
function drawnState(seed: number): State {
  let drawn = 0;
  const u = (): number => uniforms([1, seed, drawn++, 0], 1)[0]!;
  const between = ([low, high]: readonly [number, number], step = 0.001): number =>
    Math.round((low + u() * (high - low)) / step) * step;
  const tidy = (value: number): number => Math.round(value * 1000) / 1000 + 0;
  const one = <T>(values: readonly T[]): T => values[Math.floor(u() * values.length)]!;
  const setting = (field: Field): number | string =>
    "choices" in field ? one(field.choices) : tidy(between([field.low, field.high], field.step));
  const transforms = TRANSFORM_NAMES.filter(() => u() < 0.4).map((name) => {
    const fields = Object.entries<Field>(TRANSFORMS[name].fields);
    return [name, Object.fromEntries(fields.map(([field, kind]) => [field, setting(kind)]))];
  });
  return {
    traits: Object.fromEntries(model.traits.filter(() => u() < 0.7).map(({ name }) => [name, tidy(between(RANGES.trait) || 1)])),
    kind: one(["discriminant", "mean_difference"]),
    part: one(Object.keys(model.traits[0]!.steps.discriminant)),
    from: one(["average", "own", 0, 5]),
    bias: u() < 0.5 ? null : { trait: "sex", steps: tidy(between(RANGES.bias)) },
    keepSize: u() < 0.5,
    strengths: model.harmonics.map(() => tidy(between(RANGES.strength))),
    eigenwalkers: model.eigenwalkers.map(() => tidy(between(RANGES.eigenwalker))),
    tempo: tidy(between(RANGES.tempo)),
    azimuth_deg: tidy(between([-180, 179.9])),
    elevation_deg: tidy(between(RANGES.elevation_deg)),
    zoom: tidy(between(RANGES.zoom)),
    perspective: u() < 0.5,
    turning_deg_s: tidy(between(RANGES.turning_deg_s)),
    style: one(["dots", "sticks", "mannequin"]),
    trails: u() < 0.5,
    dark: u() < 0.5,
    scene: one(["one", "four", "side", "crowd"]),
    walkers: [0, 1, 2, 3].map(() => Math.floor(u() * model.walkers.length)),
    transforms: Object.fromEntries(transforms),
    playing: false,
    cycle: tidy(u() * 0.999),
  };
}

describe("an address", () => {
  it("is empty where nothing was chosen", () => {
    expect(addressOf(initial, model)).toBe("");
    expect(stateOf("", model)).toEqual(initial);
    expect(stateOf("#", model)).toEqual(initial);
  });

  it("is short", () => {
    expect(addressOf({ ...initial, traits: { sex: 3, weight_kg: 0 } }, model)).toBe("t=sex:3");
    const state = { ...initial, strengths: [1, 1.5, 1, 1], transforms: { invert: {}, scramble: initialSettings("scramble") } };
    expect(addressOf({ ...state, azimuth_deg: 90 }, model)).toBe("s=1,1.5&az=90&x=invert,scramble");
    expect(addressOf({ ...initial, playing: false }, model)).toBe("still");
  });

  it("brings back any state", () => {
    for (let seed = 0; seed < 200; seed++) {
      const state = drawnState(seed);
      expect(stateOf(`#${addressOf(state, model)}`, model)).toEqual(state);
    }
  });

  it("survives a browser, which writes some letters as numbers", () => {
    for (let seed = 0; seed < 50; seed++) {
      const address = new URL(`http://h/#${addressOf(drawnState(seed), model)}`).hash;
      expect(addressOf(stateOf(address, model), model)).toBe(addressOf(drawnState(seed), model));
    }
  });

  it("names traits with any letters", () => {
    const odd = "a:b,c=d&e #%+\u00e9";
    const named = { ...model, traits: [{ ...model.traits[0]!, name: odd }] };
    const state = { ...initialState(named), traits: { [odd]: 2 }, bias: { trait: odd, steps: 1 } };
    expect(stateOf(new URL(`http://h/#${addressOf(state, named)}`).hash, named)).toEqual(state);
  });

  it.each([
    "t=sex:1e9,tail:3,constructor:2,__proto__:4",
    "t=sex:Infinity,weight_kg:NaN",
    "t=%,%zz:3&w=-1&w=999",
    "w=1.5", "w=constructor", "w=__proto__",
    "p=toString", "p=p9", "k=x", "as=constructor", "show=__proto__",
    "s=9e99,,x,-50", "e=1,2,3,4,5,6,7,8,9,10,11,12,13,14",
    "b=sex:99", "b=weight_kg:1", "b=:", "b",
    "az=1e300", "az=720.5", "el=-1e5", "v=0", "v=-3", "turn=1e9", "at=7", "at=-1",
    "who=1,999999999,2,3,4,5,6", "who=,,,",
    "x=scramble;seed:-1;keep:constructor,fold,mask;number:1e9;number:2.5",
    "x=__proto__,constructor;a:b", "=&=&&==", "#".repeat(5000), "%".repeat(20000),
  ])("makes a state within its bounds: %.60s", (address) => {
    const state = stateOf(address, model);
    expect(Object.keys(state).sort()).toEqual(Object.keys(initial).sort());
    const inside = ([low, high]: readonly [number, number], ...values: readonly number[]): void =>
      values.forEach((value) => expect(value >= low && value <= high).toBe(true));
    inside(RANGES.trait, ...Object.values(state.traits));
    inside(RANGES.strength, ...state.strengths);
    inside(RANGES.eigenwalker, ...state.eigenwalkers);
    inside(RANGES.bias, state.bias?.steps ?? 0);
    inside(RANGES.tempo, state.tempo);
    inside(RANGES.azimuth_deg, state.azimuth_deg);
    inside(RANGES.elevation_deg, state.elevation_deg);
    inside(RANGES.cycle, state.cycle);
    expect(state.strengths.length).toBe(model.harmonics.length);
    expect(state.eigenwalkers.length).toBe(model.eigenwalkers.length);
    expect(state.walkers.every((number) => model.walkers[number])).toBe(true);
    expect(Object.keys(state.traits).every((name) => model.traits.some((trait) => trait.name === name))).toBe(true);
    for (const [name, settings] of Object.entries(state.transforms)) {
      expect(Object.keys(settings)).toEqual(Object.keys(TRANSFORMS[name as "mask"].fields));
    }
    expect(mixedVector(model, state).every(Number.isFinite)).toBe(true);
  });

  it("of letters drawn at random makes a state too", () => {
    const letters = "tsexvbpkw=:,;&.-019%#az";
    for (let seed = 0; seed < 500; seed++) {
      const text = [...uniforms([1, seed, 0, 0], 40)].map((u) => letters[Math.floor(u * letters.length)]).join("");
      expect(mixedVector(model, stateOf(text, model)).every(Number.isFinite)).toBe(true);
    }
  });
});

it("wraps angles", () => {
  expect([190, -190, 540, 180, 0].map(wrappedDegrees)).toEqual([-170, 170, -180, -180, 0]);
});
