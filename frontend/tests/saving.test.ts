// @vitest-environment jsdom
// What is kept of the stage; films and pictures are made in a real browser, see test_interactive.

import { beforeEach, describe, expect, it } from "vitest";

import golden from "../../tests/golden/model.json";
import { readStimulus } from "../src/core/readStimulus";
import { castOf } from "../src/model/figures";
import { readModel } from "../src/model/readModel";
import { initialState, TRANSFORM_NAMES, usualSettings, type State } from "../src/model/state";
import { encodeFilm, NoFilm } from "../src/viewer/filmEncoder";
import { pageFile, stimulusFile, type Kept } from "../src/viewer/saving";

const model = readModel(golden.model);
const PLAYER =
  "<!doctype html><meta content=\"script-src 'unsafe-inline'\">" +
  '<script id="stimulus" type="application/json">null</script><script>$&</script>';

function kept(part: Partial<State> = {}): Kept {
  const state = { ...initialState(model), ...part };
  return { model, state, cast: castOf(model, state) };
}

function hold(id: string, text: string): void {
  const script = document.createElement("script");
  script.id = id;
  script.type = "text/plain";
  script.textContent = text;
  document.head.append(script);
}

beforeEach(() => document.head.replaceChildren());

const all = (names: readonly (typeof TRANSFORM_NAMES)[number][]): State["transforms"] =>
  Object.fromEntries(names.map((name) => [name, usualSettings(name)]));

describe("stimulus files", () => {
  it.each<[string, Partial<State>]>([
    ["one walker", {}],
    ["four panels in perspective", { scene: "four", perspective: true, azimuth_deg: -120, elevation_deg: 40 }],
    ["four side by side, faster", { scene: "side", tempo: 1.5, style: "sticks" }],
    ["a crowd upside down", { scene: "crowd", transforms: { invert: {} } }],
    ["one that turns among noise", { turning_deg_s: 30, transforms: all(["mask"]) }],
    ...TRANSFORM_NAMES.map((name): [string, Partial<State>] => [name, { transforms: all([name]) }]),
    ["four through all but limb dots", { scene: "four", transforms: all(TRANSFORM_NAMES.filter((n) => n !== "limb_dots")) }],
  ])("of %s keep to their schema", async (_, part) => {
    const { name, blob } = stimulusFile(kept(part));
    const stimulus = readStimulus(JSON.parse(await blob.text()));
    expect(stimulus.figures.length).toBe(kept(part).cast.length);
    expect(name).toMatch(/^[\w.+-]+\.json$/);
  });

  it("hold as many walkers as a file may, and say so", async () => {
    const { cast, ...others } = kept({ scene: "crowd" });
    const many = Array.from({ length: 100 }, (_, i) => cast[i % cast.length]!);
    const { blob, told } = stimulusFile({ ...others, cast: many });
    expect(JSON.parse(await blob.text()).figures.length).toBe(64);
    expect(told).toContain("36");
  });

  it("have names that any disk takes", () => {
    const { cast, ...others } = kept({ traits: { sex: -2.5 } });
    const named = { ...others, cast: [{ ...cast[0]!, name: "../../etc/passwd\u0000 <b>" }] };
    expect(stimulusFile(named).name).toBe("etc-passwd-b-_sex-2.5.json");
  });
});

describe("pages", () => {
  it("hold the stimulus as text that ends no script", async () => {
    hold("player", JSON.stringify(PLAYER));
    const odd = { ...model, provenance: { source: "</script><script>alert(1)</script>$&" } };
    const html = await pageFile({ ...kept(), model: odd }).blob.text();
    expect(html.split("</script>").length).toBe(PLAYER.split("</script>").length);
    const page = new DOMParser().parseFromString(html, "text/html");
    const stimulus = readStimulus(JSON.parse(page.querySelector("#stimulus")!.textContent!));
    expect(stimulus.provenance["source"]).toBe(odd.provenance.source);
  });

  it("take the mannequin along where it is asked for, and only then", async () => {
    hold("player", JSON.stringify(PLAYER));
    expect(() => pageFile(kept({ style: "mannequin" }))).toThrow("mannequin");
    hold("mannequin", "export const mannequinPainter = 1;");
    const carved = await pageFile(kept({ style: "mannequin" })).blob.text();
    expect(carved).toContain("export const mannequinPainter = 1;");
    expect(carved).toContain("script-src 'unsafe-inline' blob:");
    expect(await pageFile(kept()).blob.text()).not.toContain("mannequinPainter");
  });

  it("cannot be made where there is no player", () => {
    expect(() => pageFile(kept())).toThrow("stimulus file");
  });
});

it("says what makes films where the browser does not", async () => {
  const wish = { width: 64, height: 64, frames: 1, rateHz: 60, draw: () => {} };
  await expect(encodeFilm(wish)).rejects.toThrow(NoFilm);
  await expect(encodeFilm(wish)).rejects.toThrow("eigenwalker serve");
});
