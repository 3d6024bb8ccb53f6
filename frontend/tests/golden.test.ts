// The golden files that Python wrote: positions after every transform agree to 1e-6 mm.

import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

import { permutation, randomWords, uniforms } from "../src/core/randomStream";
import { readStimulus } from "../src/core/readStimulus";
import { inPicture, scene } from "../src/core/scene";

const FOLDER = new URL("../../tests/golden/", import.meta.url);
const CLOSE_MM = 1e-6;

interface Golden {
  stimulus: unknown;
  times_s: number[];
  dots: string[];
  figures: number[];
  positions_mm: (number | null)[][][];
  visible: number[][];
  picture_mm: (number | null)[][][];
}

const read = (name: string): unknown => JSON.parse(readFileSync(new URL(name, FOLDER), "utf8"));
const names = readdirSync(FOLDER).filter((name) => /^stimulus_.*\.json$/.test(name));

/** The greatest distance on any axis; infinite where one is known and the other is not. */
function apart(actual: Float64Array, expected: (number | null)[]): number {
  expect(actual.length).toBe(expected.length);
  return expected.reduce<number>((most, value, i) => {
    if (value === null) return Number.isNaN(actual[i]!) ? most : Infinity;
    const distance = Math.abs(actual[i]! - value);
    return Number.isNaN(distance) ? Infinity : Math.max(most, distance);
  }, 0);
}

describe("stimuli play as in Python", () => {
  it("finds the golden files", () => expect(names.length).toBeGreaterThan(30));

  it.each(names)("%s", (name) => {
    const golden = read(name) as Golden;
    const stimulus = readStimulus(golden.stimulus);
    const shown = scene(stimulus);
    expect(shown.flatMap((moving) => moving.body.dots)).toEqual(golden.dots);
    const figures = shown.flatMap((moving, number) => moving.body.dots.map(() => number));
    expect(figures).toEqual(golden.figures);
    golden.times_s.forEach((time, i) => {
      const moments = shown.map((moving) => moving.at(time));
      const positions = Float64Array.from(moments.flatMap((moment) => [...moment.positions]));
      const visible = moments.flatMap((moment) => [...moment.visible]);
      const picture = inPicture(positions, stimulus.view);
      expect(apart(positions, golden.positions_mm[i]!.flat())).toBeLessThan(CLOSE_MM);
      expect(apart(picture.places, golden.picture_mm[i]!.flat())).toBeLessThan(CLOSE_MM);
      expect(visible.map((seen, dot) => seen & picture.seen[dot]!)).toEqual(golden.visible[i]);
    });
  });
});

describe("random numbers are those of Python", () => {
  const { streams } = read("random.json") as { streams: Record<string, number & number[]>[] };
  it.each(streams)("stream $purpose $seed $index $life", (stream) => {
    const { purpose, seed, index, life } = stream as Record<string, number>;
    const key = [purpose!, seed!, index!, life!] as const;
    expect([...randomWords(key, 8)]).toEqual(stream["words"]);
    expect([...uniforms(key, 4)]).toEqual(stream["uniforms"]);
    expect(permutation(purpose!, seed!, index!, 10)).toEqual(stream["permutation_of_10"]);
  });
});
