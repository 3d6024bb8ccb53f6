/** @vitest-environment jsdom */
/** Parts of the interactive page: sliders, files, texts. */

import { describe, expect, it, vi } from "vitest";
import { choice } from "../src/explorer/controls";
import { make, signed } from "../src/page/elements";
import { nearestPoint, nextPoint } from "../src/explorer/cloud";
import { Notices } from "../src/explorer/notices";
import { addressOf, stateOf } from "../src/model/address";
import { classOf, endLabels, plural, populationLabel, walkerLabel, warnings } from "../src/model/labels";
import { readModel } from "../src/model/readModel";
import { controlsOf } from "../src/widget/widget";
import { bundles, bundleName, openFiles } from "../src/explorer/openFile";
import { ownWalkerOf } from "../src/explorer/ownWalker";
import { axesOf } from "../src/explorer/axis";
import { plausibilityText, reachOf } from "../src/explorer/plausibility";
import { slider } from "../src/explorer/controls";
import { Store } from "../src/explorer/store";
import { goldenModel, posture, stimulusWith } from "./golden_model";
import { mixedVector } from "../src/model/mixing";
import { positionOf, walkerOf } from "../src/model/features";
import { initialState } from "../src/model/state";

describe("traits with names that every object has", () => {
  const names = ["constructor", "__proto__", "toString", "hasOwnProperty"];
  const golden = goldenModel();
  const traits = golden.traits.map((trait, i) => ({ ...trait, name: names[i] ?? trait.name, column: names[i] ?? trait.column }));
  const model = readModel(JSON.parse(JSON.stringify({ ...golden, traits })));

  it("stand at 0, move, and go into an address and back", () => {
    const axes = axesOf(model).slice(0, traits.length);
    let state = initialState(model);
    expect(axes.map((axis) => axis.value(state))).toEqual(axes.map(() => 0));
    axes.forEach((axis, i) => (state = { ...state, ...axis.moved(state, i + 1) }));
    const back = stateOf(addressOf(state, model), model);
    expect(axes.map((axis) => axis.value(back))).toEqual(axes.map((_, i) => i + 1));
    const plain = Object.fromEntries(axes.map(({ trait }, i) => [golden.traits[model.traits.indexOf(trait!)]!.name, i + 1]));
    expect(mixedVector(model, back)).toEqual(mixedVector(golden, { ...initialState(golden), traits: plain }));
    const position = positionOf(model, model.average);
    expect(axes.map((axis) => Math.abs(axis.at(position)) < 1e-6)).not.toContain(false);
  });

  it("are names alone where a walker lacks them, or an end is called so", () => {
    const [walker] = model.walkers;
    expect(walkerLabel({ ...walker!, traits: {} }, model)).toBe(walker!.name);
    expect(["positive", "negative"]).not.toContain(classOf({ ...model, walkers: [{ ...walker!, traits: {} }] }, 0));
    expect(endLabels({ ...model.traits[0]!, label: "sex", negative: "constructor" })[0]).toBe("constructor");
    expect(plural("toString")).toBe("toString walkers");
  });

  it("stand at 0 in a notebook", () => {
    const { element, show } = controlsOf(model, () => {});
    show(initialState(model));
    expect([...element.querySelectorAll("output")].map(({ textContent }) => textContent)).toEqual(traits.map(() => "0"));
  });
});

describe("a slider", () => {
  const made = (): { values: number[]; one: ReturnType<typeof slider> } => {
    const values: number[] = [];
    const one = slider({
      label: "Sex", ends: ["woman", "man"], min: -6, max: 6, step: 0.05, initial: 0,
      format: (value) => signed(value), onInput: (value) => values.push(value),
    });
    return { values, one };
  };
  const move = (input: HTMLInputElement, value: number): void => {
    input.value = String(value);
    input.dispatchEvent(new Event("input"));
  };

  it("says what it is moved to", () => {
    const { values, one } = made();
    move(one.input, -2.5);
    expect(values).toEqual([-2.5]);
    expect(one.input.getAttribute("aria-valuetext")).toBe("\u22122.5 towards woman");
  });

  it("goes back by a double click", () => {
    const { values, one } = made();
    move(one.input, 4);
    one.input.dispatchEvent(new Event("dblclick"));
    expect(values).toEqual([4, 0]);
    expect(one.input.value).toBe("0");
  });

  it("goes back by its button, which is there once it was moved", () => {
    const { values, one } = made();
    expect(one.element.classList.contains("changed")).toBe(false);
    move(one.input, 1);
    expect(one.element.classList.contains("changed")).toBe(true);
    one.element.querySelector("button")!.click();
    expect(values).toEqual([1, 0]);
  });

  it("is caught by its usual place only while it is dragged", () => {
    const { values, one } = made();
    move(one.input, 0.05);
    one.input.dispatchEvent(new Event("pointerdown"));
    move(one.input, -0.05);
    expect(values).toEqual([0.05, 0]);
  });

  it("stays where it was, where the finger on it scrolls the page", () => {
    const { values, one } = made();
    move(one.input, 2);
    one.input.dispatchEvent(new Event("pointerdown"));
    move(one.input, -1);
    one.input.dispatchEvent(new Event("pointercancel"));
    expect(values).toEqual([2, -1, 2]);
  });

  it("reports nothing when its value is set", () => {
    const { values, one } = made();
    one.show(3);
    expect(one.input.value).toBe("3");
    expect(values).toEqual([]);
  });
});

describe("points that are chosen", () => {
  const points = [{ x: 0, y: 0 }, { x: 10, y: 1 }, { x: 3, y: 9 }, { x: -5, y: 0 }];

  it("are the nearestPoint to the pointer, where one is near", () => {
    expect(nearestPoint(points, { x: 9, y: 3 }, 5)).toBe(1);
    expect(nearestPoint(points, { x: 50, y: 50 }, 5)).toBe(-1);
    expect(nearestPoint([], { x: 0, y: 0 }, 5)).toBe(-1);
  });

  it("follow one another the way of an arrow, and the last stays", () => {
    expect(nextPoint(points, 0, [1, 0])).toBe(1);
    expect(nextPoint(points, 0, [-1, 0])).toBe(3);
    expect(nextPoint(points, 0, [0, 1])).toBe(2);
    expect(nextPoint(points, 1, [1, 0])).toBe(1);
  });
});

it("one of a row of choices is checked at a time", () => {
  const values = vi.fn();
  const row = choice("View", [{ value: 0, label: "Front" }, { value: 90, label: "Side" }], values);
  document.body.append(row.element);
  row.show(90);
  const [front, side] = [...row.element.querySelectorAll("input")];
  expect([front!.checked, side!.checked]).toEqual([false, true]);
  front!.click();
  expect(values).toHaveBeenCalledExactlyOnceWith(0);
  expect(side!.checked).toBe(false);
});

it("text of a hostile file stays text", () => {
  const notices = new Notices();
  notices.error("<img src=x onerror=alert(1)>");
  expect(notices.element.querySelector("img")).toBeNull();
  expect(notices.element.querySelector("[role=alert]")!.textContent).toContain("<img");
  expect(make("p", { title: '"><b>' }).outerHTML).not.toContain("<b>");
});

it("trouble stays until it is sent away", () => {
  const notices = new Notices();
  notices.error("This is no capture.");
  notices.element.querySelector("button")!.click();
  expect(notices.element.textContent).toBe("");
});

describe("a file that is opened", () => {
  const model = goldenModel();
  const held = { model, other: null, population: "" };
  const file = (content: unknown, name = "a.json"): File =>
    new File([typeof content === "string" ? content : JSON.stringify(content)], name);

  it.each([
    ["{", /not JSON/],
    ["null", /neither a model nor a stimulus/],
    ['{"format": "eigenwalker model"}', /no model of walkers/],
    ['{"format": "eigenwalker stimulus", "version": 1}', /no stimulus/],
  ])("is refused in a sentence where it is %s", async (text, sentence) => {
    await expect(openFiles([file(text)], held)).rejects.toThrow(sentence);
  });

  it("is told about the server where only Python can read it", async () => {
    await expect(openFiles([file("", "walk.c3d")], held)).rejects.toThrow(/eigenwalker serve/);
    await expect(openFiles([file("", "people.nc")], held)).rejects.toThrow(/eigenwalker serve/);
  });

  it("is opened together where it is captures, and alone where it is not", () => {
    const names = (bundle: readonly File[]): string[] => bundle.map(({ name }) => name);
    const brought = ["a.amc", "m.json", "a.asf", "p.nc"].map((name) => file("", name));
    expect(bundles(brought).map(names)).toEqual([["m.json"], ["p.nc"], ["a.amc", "a.asf"]]);
  });

  it("walks, where it is a stimulus", async () => {
    const walker = walkerOf(model, model.walkers[0]!.vector);
    const opened = await openFiles([file(stimulusWith(walker))], held);
    expect(opened.kind).toBe("own");
  });
});

describe("a walker of a stimulus", () => {
  const model = goldenModel();
  const vector = model.walkers[0]!.vector;

  it("comes back as the vector it was made of", () => {
    const own = ownWalkerOf(model, stimulusWith(walkerOf(model, vector)), "mine.json");
    expect(own.name).toBe("mine");
    own.vector.forEach((value, i) => expect(value).toBeCloseTo(vector[i]!, 9));
  });

  it("comes back whatever its origin of time and the signs of its postures", () => {
    const walker = walkerOf(model, vector);
    const flip = [1, -1, 1, -1];
    const other = {
      ...walker,
      p: walker.p.map((p, i) => p.map((at) => at.map((x) => x * flip[i]!) as unknown as typeof at)),
      phases: walker.phases.map((phase, i) => phase + walker.harmonics[i]! * 0.7 + (flip[i]! < 0 ? Math.PI : 0)),
    };
    const own = ownWalkerOf(model, stimulusWith(other), "mine.json");
    own.vector.forEach((value, i) => expect(value).toBeCloseTo(vector[i]!, 9));
  });

  it("walks as it did, half a stride later, where its first posture has the other sign", () => {
    const walker = walkerOf(model, vector);
    const other = {
      ...walker,
      p: walker.p.map((p, i) => (i === 0 ? p.map((at) => at.map((x) => -x) as unknown as typeof at) : p)),
    };
    const own = walkerOf(model, ownWalkerOf(model, stimulusWith(other), "mine.json").vector);
    const [was, is] = [posture(other, 0.1), posture(own, 0.1 + 0.5 / own.frequency_hz)];
    is.forEach((value, i) => expect(value).toBeCloseTo(was[i]!, 6));
  });

  it("is refused where it lacks a marker", () => {
    const walker = walkerOf(model, vector);
    const other = { ...walker, markers: walker.markers.map((name) => `${name}_of_mine`) };
    expect(() => ownWalkerOf(model, stimulusWith(other), "mine.json")).toThrow(/lacks head/);
  });
});

describe("plausibility", () => {
  const model = goldenModel();
  const reach = reachOf(model, axesOf(model));
  const textFor = (traits: Record<string, number>): string => {
    const vector = mixedVector(model, { ...initialState(model), traits });
    return plausibilityText(reach, positionOf(model, vector));
  };

  it("of the average walker is that of nobody and everybody", () => {
    expect(textFor({})).toMatch(/average walker/);
  });

  it("is lost where a slider goes farther than anyone, however near the average that is", () => {
    expect(textFor({ sex: 6 })).toMatch(/^(A caricature|Nobody walks so): 6\.0 SD towards man; the farthest walker is at \d\.\d\.$/);
    expect(textFor({ sex: -6 })).toMatch(/ SD towards woman; /);
  });

  it("of one's own capture is never called a caricature", () => {
    const vector = mixedVector(model, { ...initialState(model), traits: { sex: 6 } });
    expect(plausibilityText(reach, positionOf(model, vector), true)).toMatch(/^Unlike anyone here: 6\.0 SD/);
  });

  it("is had by everyone of the population", () => {
    for (const { vector } of model.walkers) {
      expect(plausibilityText(reach, positionOf(model, vector))).toMatch(/^Plausible/);
    }
  });
});

describe("notices", () => {
  it("are two at most: what is new of a kind takes the place of what was", () => {
    const notices = new Notices();
    notices.error("One.");
    notices.error("Two.", "And a half.");
    notices.info(["Three."]);
    notices.news("Four.");
    const textFor = [...notices.element.querySelectorAll(".notice")].map(({ textContent }) => textContent);
    expect(textFor).toEqual(["Two.And a half.", "Four."]);
  });

  it("of work that goes on come back after others, and end with it", () => {
    const notices = new Notices();
    const done = notices.busy("Reading.");
    notices.info(["Saved."]);
    expect(notices.element.textContent).toBe("Saved.");
    notices.element.querySelector("button")!.click();
    expect(notices.element.textContent).toBe("Reading.");
    done();
    expect(notices.element.textContent).toBe("");
  });
});

describe("captures that were made to a population", () => {
  it("are named by their folder, else one by one", () => {
    const files = ["a.c3d", "b.c3d", "c.c3d", "d.c3d"].map((name) => new File([""], name));
    expect(bundleName(files, "walks")).toBe("walks/");
    expect(bundleName(files)).toBe("a.c3d, b.c3d and 2 more");
    expect(bundleName(files.slice(0, 3))).toBe("a.c3d, b.c3d, c.c3d");
    expect(bundleName(files.slice(0, 1), "walks")).toBe("a.c3d");
  });

  it("are textFor in place of a file that is not there, and that they are few", () => {
    const model = { ...goldenModel(), n_walkers: 3, traits: [], source: "people.nc", captures: "walks/" };
    expect(populationLabel(model)).toMatch(/^3 .*walkers of walks\/$/);
    expect(warnings(model)).toEqual([
      expect.stringMatching(/^3 walkers are few/),
      expect.stringMatching(/^No trait/),
    ]);
    expect(warnings(goldenModel()).length).toBe(goldenModel().n_walkers < 10 ? 1 : 0);
  });
});

describe("a store", () => {
  it("calls its listeners once for each frame in which something changed", async () => {
    const store = new Store(goldenModel());
    const listener = vi.fn();
    store.listen(listener);
    store.change({ tempo: 2 });
    store.change({ tempo: 3 });
    await vi.waitFor(() => expect(listener).toHaveBeenCalledOnce());
    expect(listener.mock.calls[0]![0].state.tempo).toBe(3);
    store.change({ tempo: 3 });
    store.end();
    store.change({ tempo: 1 });
    await new Promise((done) => setTimeout(done, 50));
    expect(listener).toHaveBeenCalledOnce();
  });

  it("undoes a drag as one step, and keeps playback and theme", () => {
    const store = new Store(goldenModel());
    store.setDragging(true);
    store.change({ azimuth_deg: 40 });
    store.change({ azimuth_deg: 50 });
    store.setDragging(false);
    store.change({ dark: false, playing: false });
    store.undo();
    expect(store.state).toMatchObject({ azimuth_deg: 30, dark: false, playing: false });
    expect(store.canUndo).toBe(false);
  });
});
