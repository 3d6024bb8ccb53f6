// The golden file that Python wrote: walkers made of choices, and what is place of them, agree.

import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

import { uniforms } from "../src/core/randomStream";
import { InvalidFile } from "../src/core/schema";
import { walking } from "../src/core/movingDots";
import { figuresOf } from "../src/model/figures";
import { captionOf } from "../src/model/captions";
import { measuresOf, type MeasureName } from "../src/model/measures";
import { partsOf, mixedVector } from "../src/model/mixing";
import type { Model } from "../src/model/model";
import { cloudPositions, positionOf, traitPosition, walkerOf } from "../src/model/features";
import { pythonCode } from "../src/model/pythonCode";
import { readModel } from "../src/model/readModel";
import { initialState, type State } from "../src/model/state";

const CLOSE = 1e-6;

interface Case {
  state: Partial<State>;
  vector: number[];
  positions_mm: number[][][];
  measures: Record<MeasureName, number | null>;
  distance: number;
  percentile: number;
  positions: Record<string, number>;
}

interface Golden {
  model: any;
  cycles: number[];
  cases: Case[];
}

const golden = (): Golden =>
  JSON.parse(readFileSync(new URL("../../tests/golden/model.json", import.meta.url), "utf8"));
const { cycles, cases } = golden();
const model = readModel(golden().model);
const chosen = (part: Partial<State>): State => ({ ...initialState(model), ...part });

const apart = (actual: ArrayLike<number>, expected: ArrayLike<number>): number => {
  expect(actual.length).toBe(expected.length);
  return Array.from(actual).reduce((most, value, i) => Math.max(most, Math.abs(value - expected[i]!)), 0);
};

describe("walkers are made as in Python", () => {
  it.each(cases.map((each) => [JSON.stringify(each.state), each] as const))("%s", (_, expected) => {
    const vector = mixedVector(model, chosen(expected.state));
    expect(apart(vector, expected.vector)).toBeLessThan(CLOSE);
    const walker = walkerOf(model, vector);
    cycles.forEach((cycle, i) => {
      const { positions } = walking(walker, [], []).at(cycle / walker.frequency_hz);
      expect(apart(positions, expected.positions_mm[i]!.flat())).toBeLessThan(CLOSE);
    });
    const measures = measuresOf(walker, model.speed_factor);
    expect(Object.keys(measures)).toEqual(Object.keys(expected.measures));
    for (const [name, value] of Object.entries(expected.measures)) {
      expect(measures[name as MeasureName]).toBeCloseTo(value ?? NaN, 6);
    }
    const place = positionOf(model, vector);
    expect(place.distance).toBeCloseTo(expected.distance, 6);
    expect(place.percentile).toBeCloseTo(expected.percentile, 6);
    for (const [name, value] of Object.entries(expected.positions)) {
      expect(place.traits[name]).toBeCloseTo(value, 6);
    }
  });
});

describe("places among the walkers", () => {
  const at = (part: Partial<State>) => positionOf(model, mixedVector(model, chosen(part)));

  it("puts the average walker in the middle of all axes", () => {
    const { scores, traits, distance, percentile } = at({});
    expect([...scores, ...Object.values(traits)].every((z) => Math.abs(z) < 1e-4)).toBe(true);
    expect([distance, percentile]).toEqual([0, 0]);
  });

  it("goes one deviation for each step of a slider, for random steps", () => {
    for (let seed = 0; seed < 20; seed++) {
      const [first, second, third] = uniforms([1, seed, 0, 0], 3).map((u) => 12 * u - 6) as unknown as number[];
      const moved = at({ traits: { sex: first! }, eigenwalkers: [0, 0, 0] });
      expect(moved.traits["sex"]).toBeCloseTo(first!, 3);
      const { scores } = at({ eigenwalkers: [first!, second!, third!] });
      expect(apart(scores.slice(0, 3), [first!, second!, third!])).toBeLessThan(1e-4);
    }
  });

  it("finds the walkers of the population where the cloud has them", () => {
    const trait = model.traits[0]!;
    const cloud = cloudPositions(model, trait); // of scores with two decimals
    model.cloud.walker.forEach((number, point) => {
      const { vector } = model.walkers[number]!;
      expect(cloud[point]).toBeCloseTo(traitPosition(trait, vector), 1);
      expect(apart(positionOf(model, vector).scores, model.cloud.scores[point]!)).toBeLessThan(0.0051);
    });
  });
});

describe("mixing", () => {
  it("adds up: steps of two traits, in either order", () => {
    const steps = (traits: State["traits"]) => mixedVector(model, chosen({ traits }));
    const both = steps({ sex: 2, weight_kg: -1 });
    expect(apart(both, steps({ weight_kg: -1, sex: 2 }))).toBeLessThan(1e-9);
    const sum = steps({ sex: 2 }).map((x, i) => x + steps({ weight_kg: -1 })[i]! - model.average[i]!);
    expect(apart(both, sum)).toBeLessThan(1e-9);
  });

  it("leaves what a classifier did not know as it was", () => {
    const vector = mixedVector(model, chosen({ traits: { sex: 6 }, part: "p2" }));
    const [start, end] = model.layout["p2"]!;
    const changed = [...vector.keys()].filter((i) => vector[i] !== model.average[i]);
    expect(changed.length).toBeGreaterThan(0);
    expect(changed.every((i) => i >= start && i < end)).toBe(true);
  });

  it("reaches the mean walkers of both classes with a bias of one", () => {
    const { means } = model.traits.find(({ name }) => name === "sex")!;
    const middle = means!.negative.map((low, i) => (low + means!.positive[i]!) / 2);
    const own = { name: "middle", vector: middle };
    const biased = (steps: number) =>
      mixedVector(model, chosen({ from: "own", bias: { trait: "sex", steps } }), own);
    expect(apart(biased(1), means!.positive)).toBeLessThan(1e-9);
    expect(apart(biased(-1), means!.negative)).toBeLessThan(1e-9);
  });

  it("passes over names that are not the model's", () => {
    const odd = { traits: { constructor: 3, __proto__: 2, tail: 1 } as never, part: "toString", from: 99 };
    expect(apart(mixedVector(model, chosen(odd)), model.average)).toBe(0);
  });

  it("lets nobody walk backwards in time", () => {
    const vector = Float64Array.from(model.average);
    vector[model.layout["frequency"]![0]] = -1;
    expect(walkerOf(model, vector).frequency_hz).toBeGreaterThan(0);
  });
});

describe("figures", () => {
  const figures = (part: Partial<State>) => figuresOf(model, chosen(part));

  it("shows women and men, and three times their difference (M5)", () => {
    const { means } = model.traits[0]!;
    const [she, he, her, him] = figures({ scene: "four" }).map(({ vector }) => vector);
    expect(apart(she!, means!.negative)).toBeLessThan(1e-9);
    expect(apart(he!, means!.positive)).toBeLessThan(1e-9);
    expect(apart(him!.map((x, i) => x - her![i]!), he!.map((x, i) => 3 * (x - she![i]!)))).toBeLessThan(1e-9);
  });

  it("brings those side by side to one tempo (M1)", () => {
    const four = figures({ scene: "side", walkers: [0, 2, 4, 7] });
    expect(new Set(four.map(({ walker }) => walker.frequency_hz)).size).toBe(1);
    expect(four.map(({ known }) => known)).toEqual([0, 2, 4, 7]);
  });

  it("changes a whole crowd at once (W7)", () => {
    const plain = figures({ scene: "crowd" });
    const men = figures({ scene: "crowd", traits: { sex: 4 } });
    expect(men.length).toBe(model.walkers.length);
    const step = mixedVector(model, chosen({ traits: { sex: 4 } })).map((x, i) => x - model.average[i]!);
    men.forEach(({ vector }, i) => {
      expect(apart(vector.map((x, j) => x - plain[i]!.vector[j]!), step)).toBeLessThan(1e-9);
    });
  });

  it("is the same object until something that makes it changes", () => {
    const state = chosen({ scene: "crowd" });
    const before = figuresOf(model, state);
    expect(figuresOf(model, { ...state, azimuth_deg: 90, playing: false })).toBe(before);
    expect(figuresOf(model, { ...state, traits: { sex: 1 } })).not.toBe(before);
  });
});

describe("what is no model is refused, in a sentence", () => {
  it.each<[string, (content: any) => void, string]>([
    ["another format", (m) => (m.format = "eigenwalker stimulus"), "model.format"],
    ["text for a number", (m) => (m.average[3] = "12"), "model.average[3]"],
    ["a number that is none", (m) => (m.average[3] = null), "model.average[3]"],
    ["a vector too short", (m) => m.walkers[1].vector.pop(), "model.walkers[1].vector"],
    ["a step of another part", (m) => m.traits[0].steps.discriminant.p1.pop(), "steps.discriminant.p1"],
    ["a part that is none", (m) => (m.traits[0].steps.discriminant.tail = []), "tail"],
    ["links to nowhere", (m) => (m.segments[0] = ["head", "tail"]), "model.segments[0]"],
    ["blocks with a gap", (m) => (m.layout.phases = [300, 303]), "model.layout"],
    ["a block too small", (m) => (m.layout.p1 = [45, 46]), "model.layout.p1"],
    ["scores of other eigenwalkers", (m) => m.cloud.scores[0].pop(), "model.cloud.scores[0]"],
    ["a walker that is not there", (m) => (m.cloud.walker[0] = 999), "model.cloud.walker[0]"],
  ])("%s", (_, spoil, place) => {
    const content = golden().model;
    spoil(content);
    expect(() => readModel(content)).toThrow(InvalidFile);
    expect(() => readModel(content)).toThrow(place);
  });

  it.each([null, 3, "model", [], {}])("%j", (content) => {
    expect(() => readModel(content)).toThrow(InvalidFile);
  });

  it("survives a model with any of its values replaced", () => {
    const odd = [null, -1, 1e308, "x", [], {}, true];
    for (let seed = 0; seed < 300; seed++) {
      const content = golden().model;
      const drawn = uniforms([1, seed, 1, 0], 12);
      let [place, depth]: [any, number] = [content, 0];
      for (;;) {
        const keys = Object.keys(place);
        const key = keys[Math.floor(drawn[depth++]! * keys.length)]!;
        const inside = place[key];
        if (inside && typeof inside === "object" && Object.keys(inside).length > 0 && drawn[depth]! < 0.8) {
          place = inside;
          continue;
        }
        place[key] = odd[Math.floor(drawn[11]! * odd.length)];
        break;
      }
      let read: Model;
      try {
        read = readModel(content);
      } catch (error) {
        expect(error).toBeInstanceOf(InvalidFile);
        continue;
      }
      expect(mixedVector(read, initialState(read)).length).toBe(read.average.length);
    }
  });
});

describe("words", () => {
  it("names parts that all traits know", () => {
    expect(partsOf(model)).toContain("structure");
    expect(partsOf(model)).toContain("all");
  });

  it("says in one sentence what is seen", () => {
    expect(captionOf(model, initialState(model))).toBe("The average walker, from 30 degrees.");
    const state = chosen({ traits: { sex: -3 }, strengths: [1, 2, 1, 1], transforms: { invert: {} } });
    expect(captionOf(model, { ...state, azimuth_deg: 90 })).toBe(
      "The average walker, 3 SD towards woman, sway times 2, from the side, upside down.",
    );
  });

  it("writes Python that names all that was chosen", () => {
    const lines = pythonCode(model, chosen({
      traits: { sex: 3, weight_kg: 0 },
      part: "structure",
      kind: "mean_difference",
      from: 2,
      bias: { trait: "sex", steps: -1 },
      eigenwalkers: [0, 2],
      strengths: [1, 1.5, 1, 1],
    }));
    expect(lines).toContain("vector = people.X[2].copy()");
    expect(lines).toContain('3 * ew.trait_axis(people, "sex", part="structure", kind="mean_difference").step');
    expect(lines).toContain("-1 * (people.X[contrast.rows[contrast.y > 0]]");
    expect(lines).toContain("explained_variance_[1] ** 0.5 * space.eigenwalkers_[1]");
    expect(lines).toContain('vector[people.layout.blocks["p2"]] *= 1.5');
    expect(lines).not.toContain("weight");
  });
});
