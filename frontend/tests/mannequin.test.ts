// The pieces of the mannequin are where Python puts them.

import { expect, it } from "vitest";

import golden from "../../tests/golden/mannequin.json";
import { framesOf } from "../src/canvas/figureFrames";
import { readStimulus } from "../src/core/readStimulus";
import { bodyHeights, HULL, Hulls, mannequinOf } from "../src/mannequin/hulls";

const stimulus = readStimulus(golden.stimulus);

it("is as thick as in Python", () => {
  expect(bodyHeights(stimulus)).toHaveLength(golden.heights_mm.length);
  bodyHeights(stimulus).forEach((height, i) => expect(height).toBeCloseTo(golden.heights_mm[i]!, 6));
});

it("puts every ball where Python does", () => {
  const hulls = new Hulls();
  for (const [i, { moving, positions, visible }] of framesOf(stimulus)(golden.time_s).entries()) {
    hulls.add(mannequinOf(moving.body, bodyHeights(stimulus)[i]!), positions, visible, stimulus.view);
  }
  expect(hulls.count).toBe(golden.tones.length);
  golden.balls.forEach((balls, hull) => {
    const numbers = [...hulls.numbers.subarray(HULL * hull, HULL * (hull + 1))];
    [...balls.flat(), golden.tones[hull]!].forEach((wanted, i) =>
      expect(Math.abs(numbers[i]! - wanted)).toBeLessThan(1e-3), // single precision of metres
    );
  });
});

it("makes room for a crowd", () => {
  const hulls = new Hulls();
  const [{ moving, positions, visible }] = framesOf(stimulus)(0) as [ReturnType<ReturnType<typeof framesOf>>[0]];
  const pieces = mannequinOf(moving.body, 1700);
  for (let i = 0; i < 100; i++) hulls.add(pieces, positions, visible, stimulus.view);
  const first = hulls.numbers.slice(0, HULL * (hulls.count / 100));
  expect(hulls.numbers.slice(HULL * (hulls.count - hulls.count / 100), HULL * hulls.count)).toEqual(first);
  hulls.clear();
  expect(hulls.count).toBe(0);
});
