// @vitest-environment jsdom
// The viewer draws what its stimulus file describes, continues strides, and rests while hidden.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import golden from "../../tests/golden/model.json";
import { framesOf } from "../src/canvas/figureFrames";
import { uniforms } from "../src/core/randomStream";
import { observerAxes } from "../src/core/vector";
import { figuresOf, type SceneFigure } from "../src/model/figures";
import { readModel } from "../src/model/readModel";
import { initialState, initialSettings, type State } from "../src/model/state";
import { animationOf, strideRates, type AnimationSpec } from "../src/viewer/animation";
import { Viewer, type ViewerEvents } from "../src/viewer/viewer";
import { arrange } from "../src/viewer/arrangement";
import { arrangementFor, arrangedStimulus, stimulusOf } from "../src/viewer/viewedStimulus";
import { WalkerBatch } from "../src/viewer/walkerBatch";

const model = readModel(golden.model);
const chosen = (part: Partial<State> = {}): State => ({ ...initialState(model), ...part });
const SIZE = { width_px: 900, height_px: 600 };

/** The specification of an animation that begins at 0 s. */
function specOf(part: Partial<State>, others: Partial<AnimationSpec> = {}): AnimationSpec {
  const state = chosen(part);
  const figures = figuresOf(model, state);
  const arrangement = arrangementFor({ model, figures, state }, SIZE);
  const phases = figures.map(() => 0);
  return { model, figures, state, size: SIZE, arrangement, phases, time: 0, turned_deg: 0, mannequin: null, ...others };
}

/** Where the batch has all dots at a time. */
function batchPlaces({ figures, state, arrangement }: AnimationSpec, time: number): Float64Array {
  const batch = new WalkerBatch(figures.map(({ walker }) => walker));
  strideRates({ figures, state }).forEach((rate, i) => (batch.rates[i] = rate));
  const axes = observerAxes(state.azimuth_deg + state.turning_deg_s * time, state.elevation_deg);
  const view = { axes, eyeMm: state.perspective ? arrangement.eyeMm : null };
  batch.project(time, view, arrangement, SIZE);
  return batch.places;
}

const apart = (actual: ArrayLike<number>, expected: ArrayLike<number>): number => {
  expect(actual.length).toBe(expected.length);
  return Array.from(actual).reduce((most, value, i) => Math.max(most, Math.abs(value - expected[i]!)), 0);
};

describe("what is drawn quickly is what the stimulus says", () => {
  it.each<[string, Partial<State>]>([
    ["one walker", {}],
    ["a caricature, faster", { traits: { sex: 5 }, tempo: 1.7, azimuth_deg: 71 }],
    ["from above, in perspective", { elevation_deg: 35, perspective: true, azimuth_deg: -140 }],
    ["one that turns by itself", { turning_deg_s: 40 }],
    ["four panels in perspective", { scene: "four", perspective: true, azimuth_deg: 20, elevation_deg: -15 }],
    ["four at one tempo", { scene: "side", walkers: [0, 3, 5, 7] }],
    ["one near", { zoom: 3, elevation_deg: 10 }],
    ["four far away in perspective", { scene: "four", perspective: true, zoom: 0.4 }],
    ["a crowd", { scene: "crowd", traits: { weight_kg: 2 }, elevation_deg: 50 }],
  ])("%s", (_, part) => {
    const spec = specOf(part);
    const { arrangement } = spec;
    const frames = framesOf(arrangedStimulus(spec, SIZE, arrangement));
    for (const time of [0, 0.3, 1.7]) {
      const expected = frames(time).flatMap(({ places }) => [...places]);
      expect(apart(batchPlaces(spec, time), expected)).toBeLessThan(1e-6);
    }
  });
});

describe("walkers stay in their boxes", () => {
  it("however they are turned, for random states", () => {
    for (let seed = 0; seed < 40; seed++) {
      const [sex, azimuth, elevation, time, which] = [...uniforms([1, seed, 0, 0], 5)] as [number, number, number, number, number];
      const scene = (["one", "four", "side", "crowd"] as const)[Math.floor(4 * which)]!;
      const spec = specOf({
        scene,
        traits: { sex: 12 * sex - 6 },
        azimuth_deg: 360 * azimuth - 180,
        elevation_deg: 120 * elevation - 30,
      });
      const places = batchPlaces(spec, 3 * time);
      const boxes = spec.arrangement.boxes;
      const perWalker = places.length / boxes.length;
      boxes.forEach(({ left, top, width, height }, i) => {
        const own = places.subarray(i * perWalker, (i + 1) * perWalker);
        own.forEach((place, j) => {
          const [low, size] = j % 2 === 0 ? [left, width] : [top, height];
          expect(place).toBeGreaterThan(low);
          expect(place).toBeLessThan(low + size);
        });
      });
    }
  });

  it("and the boxes fill the picture without overlap", () => {
    for (let count = 1; count <= 100; count++) {
      const boxes = arrange(count, { radius: 450, height: 1750 }, SIZE, 10).boxes;
      expect(boxes.length).toBe(count);
      const area = boxes.reduce((sum, { width, height }) => sum + width * height, 0);
      expect(area).toBeLessThanOrEqual(SIZE.width_px * SIZE.height_px * 1.000001);
      boxes.forEach(({ left, top, width, height }) => {
        expect(left).toBeGreaterThan(-1e-6);
        expect(left + width).toBeLessThan(SIZE.width_px + 1e-6);
        expect(top).toBeGreaterThan(-1e-6);
        expect(top + height).toBeLessThan(SIZE.height_px + 1e-6);
      });
    }
  });
});

it("zooms about the middle of the picture, walkers and places alike", () => {
  const extent = { radius: 450, height: 1750 };
  const [once, twice] = [1, 2].map((zoom) => arrange(3, extent, SIZE, 10, zoom));
  expect(twice!.pxPerMm).toBeCloseTo(2 * once!.pxPerMm);
  expect(twice!.eyeMm).toBeCloseTo(once!.eyeMm);
  expect(twice!.offsets).toEqual(once!.offsets);
  const middle = ({ left, width }: { left: number; width: number }): number => left + width / 2 - SIZE.width_px / 2;
  twice!.boxes.forEach((box, i) => expect(middle(box)).toBeCloseTo(2 * middle(once!.boxes[i]!)));
});

describe("the chain", () => {
  const steps = (part: Partial<State>) => {
    const state = chosen(part);
    return stimulusOf({ model, state, figures: figuresOf(model, state) }).transforms;
  };

  it("is empty for a walker as it is", () => expect(steps({})).toEqual([]));

  it("acts in one order, whatever was switched on first", () => {
    const names = ["mask", "scramble", "invert", "mirror", "arm_swing"] as const;
    const on = (order: readonly (typeof names)[number][]): State["transforms"] =>
      Object.fromEntries(order.map((name) => [name, initialSettings(name)]));
    const actual = steps({ transforms: on(names), tempo: 2, turning_deg_s: 20 }).map(({ name }) => name);
    expect(actual).toEqual(["speed", "gain", "mirror", "invert", "scramble", "rotate", "mask"]);
    const other = steps({ transforms: on([...names].reverse()), tempo: 2, turning_deg_s: 20 });
    expect(other.map(({ name }) => name)).toEqual(actual);
  });

  it("draws dots, blobs and boxes as large for all walkers", () => {
    const transforms = Object.fromEntries(
      (["scramble", "blur", "mask"] as const).map((name) => [name, initialSettings(name)]),
    );
    const sizes = [-6, 0, 6].map((sex) => {
      const state = chosen({ transforms, traits: { sex }, azimuth_deg: 15 * sex });
      const { display, transforms: chain } = stimulusOf({ model, state, figures: figuresOf(model, state) });
      const boxes = chain.flatMap((step) => ("box_mm" in step ? step.box_mm.map((side) => side * display.px_per_mm) : []));
      const blobs = chain.flatMap((step) => (step.name === "blur" ? [step.sd_px!] : []));
      return { scale: display.px_per_mm, drawn: [display.dot_px, ...blobs, ...boxes].map((size) => size.toFixed(2)) };
    });
    expect(sizes[0]!.scale).not.toBe(sizes[2]!.scale);
    expect(sizes[0]!.drawn.length).toBe(6);
    for (const { drawn } of sizes) expect(drawn).toEqual(sizes[0]!.drawn);
  });

  it("begins all saved walkers at one phase of the stride", () => {
    for (const sex of [-6, 0, 6]) {
      const state = chosen({ traits: { sex } });
      const walker = stimulusOf({ model, state, figures: figuresOf(model, state) }).figures[0]!.walker!;
      const [left, right] = ["left_ankle", "right_ankle"].map((name) => walker.markers.indexOf(name));
      let cosine = 0;
      walker.p.forEach((posture, i) => {
        if (walker.harmonics[i] === 1) cosine += (posture[left!]![0] - posture[right!]![0]) * Math.sin(walker.phases[i]!);
      });
      expect(Math.abs(cosine)).toBeLessThan(1e-6);
    }
  });

  it("names the figures of a mask one by one", () => {
    const masks = steps({ scene: "four", transforms: { mask: initialSettings("mask") } });
    expect(masks.map(({ figures }) => figures)).toEqual([[0], [1], [2], [3]]);
  });
});

describe("strides go on", () => {
  beforeEach(() => {
    HTMLCanvasElement.prototype.getContext = (() => silentContext) as never;
  });

  it.each<[string, Partial<State>]>([
    ["as they are", {}],
    ["in a chain", { transforms: { invert: {} } }],
    ["backwards", { transforms: { reverse: {} }, tempo: 1.4 }],
  ])("%s", (_, part) => {
    const spec = specOf({ ...part, scene: "side" }, { phases: [0.1, 0.2, 5.3, -0.4], time: 7.7 });
    const animation = animationOf(spec);
    const rates = strideRates(spec);
    spec.phases.forEach((cycle, i) => {
      expect(animation.phase(i, 7.7)).toBeCloseTo(cycle, 9);
      expect(animation.phase(i, 8.2) - cycle).toBeCloseTo(0.5 * rates[i]!, 9);
    });
  });

  it("into a chain and out of it with every dot where it was", () => {
    // Twice a mirror image of walkers is they themselves, but through the chain.
    const spec = specOf({ azimuth_deg: 50 }, { phases: [0.37], time: 3 });
    const { figures, arrangement } = spec;
    const clock = 360 * (0.37 - strideRates(spec)[0]! * 3);
    const start = { name: "start", phase_deg: clock, figures: [0] } as const;
    const chained = framesOf(arrangedStimulus(spec, SIZE, arrangement, [start]))(3);
    const batch = new WalkerBatch(figures.map(({ walker }) => walker));
    batch.starts[0] = 0.37 - batch.rates[0]! * 3;
    batch.project(3, { axes: observerAxes(50, 0), eyeMm: null }, arrangement, SIZE);
    expect(apart(batch.places, chained[0]!.places)).toBeLessThan(1e-6);
  });
});

/** A canvas that counts what is drawn on it. */
let dots: [number, number][] = [];
const counted = vi.fn<(what: string) => void>();
const silentContext: object = new Proxy({}, {
  get: (_, name) => {
    if (name === "canvas") return { width: 1, height: 1 };
    return (...given: number[]) => {
      counted(String(name));
      if (name === "arc") dots.push([given[0]!, given[1]!]);
      return silentContext;
    };
  },
  set: () => true,
});

describe("the viewer", () => {
  let frames: FrameRequestCallback[] = [];
  let now = 0;
  let view: ((inSight: boolean) => void) | undefined;
  let canvas: HTMLCanvasElement;

  beforeEach(() => {
    [frames, now] = [[], 0];
    counted.mockClear();
    HTMLCanvasElement.prototype.getContext = (() => silentContext) as never;
    HTMLCanvasElement.prototype.setPointerCapture = () => {};
    vi.stubGlobal("requestAnimationFrame", (draw: FrameRequestCallback) => frames.push(draw));
    vi.stubGlobal("cancelAnimationFrame", () => (frames = []));
    vi.stubGlobal("matchMedia", () => ({ matches: false }));
    vi.stubGlobal("ResizeObserver", class { observe(): void {} disconnect(): void {} });
    vi.stubGlobal(
      "IntersectionObserver",
      class {
        constructor(seen: (entries: { isIntersecting: boolean }[]) => void) {
          view = (isIntersecting) => seen([{ isIntersecting }]);
        }
        observe(): void {}
        disconnect(): void {}
      },
    );
    canvas = document.createElement("canvas");
    Object.defineProperties(canvas, { clientWidth: { value: 900 }, clientHeight: { value: 600 } });
  });
  afterEach(() => vi.unstubAllGlobals());

  /** Show a number of frames. */
  function run(count: number): void {
    for (let i = 0; i < count; i++) {
      const due = frames;
      frames = [];
      now += 1000 / 60;
      for (const draw of due) draw(now);
    }
  }

  function staged(part: Partial<State> = {}, hooks: ViewerEvents = {}): { viewer: Viewer; show: (part: Partial<State>) => void } {
    const viewer = new Viewer(canvas, hooks);
    const show = (part: Partial<State>): void => {
      const state = chosen(part);
      const figures: readonly SceneFigure[] = figuresOf(model, state);
      viewer.show({ model, figures, state });
    };
    show(part);
    return { viewer, show };
  }

  const drawnSince = (action: () => void): number => {
    counted.mockClear();
    action();
    return counted.mock.calls.filter(([what]) => what === "fillRect").length;
  };

  it("draws each frame while it plays, and none while it is paused, hidden or gone", () => {
    const { viewer, show } = staged();
    expect(drawnSince(() => run(10))).toBe(10);
    show({ playing: false });
    run(2);
    expect(drawnSince(() => run(10))).toBe(0);
    expect(frames.length).toBe(0);
    show({});
    expect(drawnSince(() => run(10))).toBe(10);
    view?.(false);
    expect(drawnSince(() => run(10))).toBe(0);
    view?.(true);
    expect(drawnSince(() => run(10))).toBe(10);
    viewer.remove();
    expect(drawnSince(() => run(10))).toBe(0);
    expect(frames.length).toBe(0);
  });

  it("draws once where something changes while it is paused", () => {
    const { show } = staged({ playing: false });
    run(5);
    expect(drawnSince(() => (show({ playing: false, traits: { sex: 1 } }), run(5)))).toBe(1);
  });

  it("goes on where it was in the stride when the frequency changes, and when it is paused", () => {
    const { viewer, show } = staged();
    run(31);
    for (const part of [{ traits: { sex: 5 } }, { tempo: 2.5 }, { transforms: { invert: {} } }, { playing: false }]) {
      const before = viewer.phase;
      show(part);
      expect(viewer.phase).toBeCloseTo(before, 9);
      run(3);
    }
  });

  it("stands where the state says when it is scrubbed", () => {
    const { viewer, show } = staged();
    run(20);
    show({ playing: false, cycle: 0.25 });
    expect(viewer.phase).toBeCloseTo(0.25, 9);
    show({ playing: false, cycle: 0.75, tempo: 2, traits: { sex: -3 } });
    expect(viewer.phase).toBeCloseTo(0.75, 9);
  });

  it("lets several go on as they were to each other when it is paused and scrubbed", () => {
    const { viewer, show } = staged({ scene: "four" });
    run(100);
    const seen = (): number[] => (dots = [], run(2), dots.slice(-60).flat());
    show({ scene: "four", playing: false });
    const paused = seen();
    show({ scene: "four", playing: false, cycle: viewer.phase });
    expect(apart(seen(), paused)).toBeLessThan(1e-6);
    const { phase: cycle } = viewer;
    show({ scene: "four", playing: false, cycle: (cycle + 0.4) % 1 });
    expect(apart(seen(), paused)).toBeGreaterThan(1);
    show({ scene: "four", playing: false, cycle });
    expect(apart(seen(), paused)).toBeLessThan(1e-6);
  });

  /** A pointer that moves every 30 ms. */
  let time = 0;
  const pointer = (type: string, x: number, y: number): void => {
    const event = new MouseEvent(type, { clientX: x, clientY: y, button: 0 });
    Object.defineProperties(event, { pointerId: { value: 1 }, timeStamp: { value: (time += 30) } });
    canvas.dispatchEvent(event);
  };

  it("reports how much nearer the wheel brings it", () => {
    const zoomed = vi.fn();
    staged({}, { zoomed });
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -120 }));
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: 120 }));
    const [near = 0, far = 0] = zoomed.mock.calls.flat();
    expect(near).toBeGreaterThan(1.1);
    expect(near * far).toBeCloseTo(1);
  });

  it("is turned by dragging, and reports it", () => {
    const turned = vi.fn();
    staged({ azimuth_deg: 170 }, { turned });
    pointer("pointerdown", 100, 100);
    pointer("pointermove", 140, 110);
    pointer("pointermove", 160, 400);
    expect(turned.mock.calls[0]).toEqual([-170, 5]);
    expect(turned.mock.lastCall).toEqual([-160, 90]);
  });

  it("turns on a little when it is thrown, and comes to rest", () => {
    const turned = vi.fn();
    staged({ playing: false }, { turned });
    pointer("pointerdown", 100, 100);
    for (let x = 110; x <= 200; x += 10) pointer("pointermove", x, 100);
    pointer("pointerup", 200, 100);
    const [let_go] = turned.mock.lastCall as [number];
    run(200);
    const [rests] = turned.mock.lastCall as [number];
    expect(rests).toBeGreaterThan(let_go);
    expect(drawnSince(() => run(20))).toBe(0);
  });

  it("says who was tapped among several", () => {
    const picked = vi.fn();
    const boxes: unknown[] = [];
    staged({ scene: "side", walkers: [1, 3, 5, 7] }, { picked, arranged: (arranged) => boxes.push(arranged) });
    expect((boxes.at(-1) as unknown[]).length).toBe(4);
    pointer("pointerdown", 890, 300);
    pointer("pointerup", 891, 301);
    expect(picked).toHaveBeenCalledExactlyOnceWith(7);
    pointer("pointerdown", 10, 300);
    pointer("pointermove", 60, 300);
    pointer("pointerup", 60, 300);
    expect(picked).toHaveBeenCalledTimes(1);
  });

  it.each<[string, (change: (part: Partial<State>) => void) => void]>([
    ["turning is switched off", (change) => change({ turning_deg_s: 0 })],
    ["it is held", () => pointer("pointerdown", 10, 10)],
  ])("stays where it came to by turning itself when %s", (_, action) => {
    let state: Partial<State> = { turning_deg_s: 60, azimuth_deg: 0 };
    const change = (part: Partial<State>): void => show((state = { ...state, ...part }));
    const { show } = staged(state, { turned: (azimuth_deg) => change({ azimuth_deg }) });
    const seen = (): [number, number][] => (dots = [], run(2), dots.slice(-15));
    run(31);
    change({ playing: false });
    const before = seen();
    action(change);
    expect(state.azimuth_deg).toBeCloseTo(30, 6);
    expect(apart(seen().flat(), before.flat())).toBeLessThan(1e-6);
  });

  it("draws the mannequin flat where its module is not to be had", async () => {
    const mannequinMissing = vi.fn();
    const { show } = staged({ style: "mannequin" }, { mannequinMissing });
    await vi.waitFor(() => expect(mannequinMissing).toHaveBeenCalledOnce());
    show({ style: "mannequin", playing: false });
    expect(drawnSince(() => run(3))).toBeGreaterThan(0);
  });
});
