// @vitest-environment jsdom
// Files of the picture in the viewer; films and pictures are tested in a real browser, see test_page.py.

import { beforeEach, describe, expect, it } from "vitest";

import golden from "../../tests/golden/model.json";
import { readStimulus } from "../src/core/readStimulus";
import { figuresOf } from "../src/model/figures";
import { readModel } from "../src/model/readModel";
import { initialState, TRANSFORM_NAMES, initialSettings, type State } from "../src/model/state";
import { encodeFilm, FilmError } from "../src/viewer/filmEncoder";
import { pageFile, stimulusFile, type Snapshot } from "../src/viewer/saving";

const model = readModel(golden.model);
const PLAYER =
  "<!doctype html><meta content=\"script-src 'unsafe-inline'\">" +
  '<script id="stimulus" type="application/json">null</script><script>$&</script>';

function snapshot(part: Partial<State> = {}): Snapshot {
  const state = { ...initialState(model), ...part };
  return { model, state, figures: figuresOf(model, state) };
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
  Object.fromEntries(names.map((name) => [name, initialSettings(name)]));

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
    const { name, blob } = stimulusFile(snapshot(part));
    const stimulus = readStimulus(JSON.parse(await blob.text()));
    expect(stimulus.figures.length).toBe(snapshot(part).figures.length);
    expect(name).toMatch(/^[\w.+-]+\.json$/);
  });

  it("hold as many walkers as a file may, and say so", async () => {
    const { figures, ...others } = snapshot({ scene: "crowd" });
    const many = Array.from({ length: 100 }, (_, i) => figures[i % figures.length]!);
    const { blob, note } = stimulusFile({ ...others, figures: many });
    expect(JSON.parse(await blob.text()).figures.length).toBe(64);
    expect(note).toContain("36");
  });

  it("have names that any disk takes", () => {
    const { figures, ...others } = snapshot({ traits: { sex: -2.5 } });
    const named = { ...others, figures: [{ ...figures[0]!, name: "../../etc/passwd\u0000 <b>" }] };
    expect(stimulusFile(named).name).toBe("etc-passwd-b-_sex-2.5.json");
  });
});

describe("pages", () => {
  it("hold the stimulus as text that ends no script", async () => {
    hold("player", JSON.stringify(PLAYER));
    const odd = { ...model, provenance: { source: "</script><script>alert(1)</script>$&" } };
    const html = await pageFile({ ...snapshot(), model: odd }).blob.text();
    expect(html.split("</script>").length).toBe(PLAYER.split("</script>").length);
    const page = new DOMParser().parseFromString(html, "text/html");
    const stimulus = readStimulus(JSON.parse(page.querySelector("#stimulus")!.textContent!));
    expect(stimulus.provenance["source"]).toBe(odd.provenance.source);
  });

  it("take the mannequin along where it is asked for, and only then", async () => {
    hold("player", JSON.stringify(PLAYER));
    expect(() => pageFile(snapshot({ style: "mannequin" }))).toThrow("mannequin");
    hold("mannequin", "export const mannequinPainter = 1;");
    const page = await pageFile(snapshot({ style: "mannequin" })).blob.text();
    expect(page).toContain("export const mannequinPainter = 1;");
    expect(page).toContain("script-src 'unsafe-inline' blob:");
    expect(await pageFile(snapshot()).blob.text()).not.toContain("mannequinPainter");
  });

  it("cannot be made where there is no player", () => {
    expect(() => pageFile(snapshot())).toThrow("stimulus file");
  });
});

it("says what makes films where the browser does not", async () => {
  const spec = { width: 64, height: 64, frames: 1, rateHz: 60, draw: () => {} };
  await expect(encodeFilm(spec)).rejects.toThrow(FilmError);
  await expect(encodeFilm(spec)).rejects.toThrow("eigenwalker serve");
});
