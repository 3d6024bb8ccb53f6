// What is no stimulus is refused, in words; what may be left out is filled in.

import { readFileSync } from "node:fs";
import { expect, it } from "vitest";

import { frameTiming } from "../src/canvas/clock";
import { NoStimulus, readStimulus } from "../src/core/check";

const file = new URL("../../tests/golden/stimulus_plain.json", import.meta.url);
const plain = (): any => JSON.parse(readFileSync(file, "utf8")).stimulus;

it("fills in what was left out", () => {
  const content = plain();
  delete content.transforms;
  delete content.timing.rate_hz;
  delete content.figures[0].position_mm;
  content.transforms = [{ name: "rotate", angle_deg: 30 }];
  const stimulus = readStimulus(content);
  expect(stimulus.timing.rate_hz).toBe(60);
  expect(stimulus.figures[0]!.position_mm).toEqual([0, 0, 0]);
  expect(stimulus.figures[0]!.trajectories).toBe(null);
  expect(stimulus.transforms[0]).toEqual({
    name: "rotate",
    axis: "z",
    angle_deg: 30,
    speed_deg_s: 0,
    figures: null,
  });
});

it("leaves what it is given as it was", () => {
  const content = plain();
  readStimulus(content);
  expect(content).toEqual(plain());
});

it.each([
  ["another version", (s: any) => (s.version = 2), "stimulus.version"],
  ["an unknown name", (s: any) => (s.colour = "red"), "colour"],
  ["a name every object has", (s: any) => (s["constructor"] = 1), "constructor"],
  ["an unknown transform", (s: any) => (s.transforms = [{ name: "fold" }]), "fold"],
  ["a number out of range", (s: any) => (s.timing.duration_s = -1), "duration_s"],
  ["text for a number", (s: any) => (s.view.view_deg = "30"), "view_deg"],
  ["a seed that is not whole", (s: any) => (s.transforms = [{ name: "phase_scramble", seed: 0.5 }]), "seed"],
  ["dots that are not there", (s: any) => (s.transforms = [{ name: "occlude", markers: ["tail"] }]), "tail"],
  ["figures that are not there", (s: any) => (s.transforms = [{ name: "invert", figures: [1] }]), "figure 1"],
  ["a posture of too few dots", (s: any) => s.figures[0].walker.p0.pop(), "postures"],
  ["no figures", (s: any) => (s.figures = []), "figures"],
  ["nothing", () => undefined, "null"],
])("refuses %s", (name, spoil, said) => {
  const content = name === "nothing" ? null : plain();
  spoil(content);
  expect(() => readStimulus(content)).toThrow(NoStimulus);
  expect(() => readStimulus(content)).toThrow(said);
});

it("counts the frames that were dropped", () => {
  expect(frameTiming([0, 10, 20, 50, 60])).toMatchObject({ interval: 10, dropped: 2 });
  expect(frameTiming([0])).toMatchObject({ interval: null, dropped: 0 });
});
