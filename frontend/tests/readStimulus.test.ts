// Invalid stimuli are refused with a message; defaults are filled in.

import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

import { frameTiming } from "../src/canvas/frameClock";
import { MAX_WORK, readStimulus } from "../src/core/readStimulus";
import { InvalidFile } from "../src/core/schema";

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
])("refuses %s", (name, spoil, message) => {
  const content = name === "nothing" ? null : plain();
  spoil(content);
  expect(() => readStimulus(content)).toThrow(InvalidFile);
  expect(() => readStimulus(content)).toThrow(message);
});

describe("a chain that no browser could play in time", () => {
  const clocks = (n: number): any => ({
    ...plain(),
    transforms: Array.from({ length: n }, (_, seed) => ({ name: "phase_scramble", seed })),
  });

  it("is refused with Python's sentence", () => {
    expect(() => readStimulus(clocks(4))).not.toThrow(); // 15^5 dots
    expect(() => readStimulus(clocks(5))).toThrow(
      "This is no stimulus: its chain computes 11390625 dots for one moment, and no more than 1000000 are " +
        "shown in time; use fewer dots or fewer transforms that give each dot a clock.",
    );
  });

  it("counts what masks compute", () => {
    const content = { ...plain(), transforms: [
      { name: "delay", markers: ["head"], phase_deg: 10 },
      { name: "mask", kind: "scrambled", number: 4000, phases: true, box_mm: [900, 900], centre_mm: [0, 0, 900], seed: 1 },
      { name: "mask", kind: "scrambled", number: 4000, phases: true, box_mm: [900, 900], centre_mm: [0, 0, 900], seed: 2 },
    ] };
    expect(() => readStimulus(content)).not.toThrow();
    content.transforms.push(...content.transforms.slice(1), ...content.transforms.slice(1));
    content.transforms.push(...content.transforms.slice(1, 5));
    expect(() => readStimulus(content)).toThrow("computes 1240030 dots");
  });

  it("has Python's bound", () => {
    const python = readFileSync(new URL("../../src/eigenwalker/stimulus/schema.py", import.meta.url), "utf8");
    expect(Number(/^MAX_WORK = ([\d_]+)$/m.exec(python)![1]!.replaceAll("_", ""))).toBe(MAX_WORK);
  });
});

it("counts the frames that were dropped", () => {
  expect(frameTiming([0, 10, 20, 50, 60], 10)).toMatchObject({ interval: 10, dropped: 2 });
  expect(frameTiming([0, 20, 40], 10, 70)).toMatchObject({ interval: 20, longest: 20, dropped: 4 });
  expect(frameTiming([0], 10)).toMatchObject({ interval: null, dropped: 0 });
});
