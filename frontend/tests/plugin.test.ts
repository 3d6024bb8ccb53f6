// @vitest-environment jsdom
// The jsPsych plugin in a made-up browser; what is drawn is tested in a real one.

import { initJsPsych } from "jspsych";
import { beforeEach, expect, it, vi } from "vitest";

import golden from "../../tests/golden/stimulus_plain.json";
import WalkerPlugin from "../plugin-walker/src/index";

const { stimulus } = golden;

const drawn = vi.fn<(what: string) => void>();

beforeEach(() => {
  drawn.mockClear();
  const called = (name: string) => () => {
    drawn(name);
    return { addColorStop: () => {} }; // of a gradient; nobody looks at what the rest gives
  };
  const context = new Proxy({}, { get: (_, name) => called(String(name)), set: () => true });
  // The frames of jsdom are on another clock than performance.now(); those of browsers are not.
  vi.stubGlobal("requestAnimationFrame", (draw: FrameRequestCallback) =>
    setTimeout(() => draw(performance.now()), 1000 / 60),
  );
  vi.stubGlobal("cancelAnimationFrame", clearTimeout);
  const contextOf = (kind: string): unknown => (kind === "2d" ? context : null);
  HTMLCanvasElement.prototype.getContext = contextOf as never;
});

/** Run one trial; `act` is called after a delay, once it is on the screen. */
async function run(
  parameters: object,
  act: (display: HTMLElement) => void = () => {},
  delayMs = 150,
): Promise<Record<string, any>> {
  const jsPsych = initJsPsych({ on_trial_start: () => setTimeout(() => act(jsPsych.getDisplayElement()), delayMs) });
  await jsPsych.run([{ type: WalkerPlugin, stimulus, ...parameters }]);
  return jsPsych.data.get().values()[0] as Record<string, any>;
}

const press = (key: string): void => {
  document.activeElement!.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
};

it("takes a key and counts from the first frame", async () => {
  const data = await run({ choices: ["f", "m"] }, () => {
    press("x");
    press("m");
  }, 1500); // the first drawing is slow on a busy machine
  expect(data).toMatchObject({ response: "m", response_by: "key" });
  expect(data["rt"]).toBeGreaterThan(0);
  expect(data["rt"]).toBeLessThan(1500);
  expect(data["frame_times"][0]).toBe(0);
  expect(data["frame_times"].length).toBeGreaterThan(2);
  expect(data["frame_interval"]).toBeGreaterThan(5);
});

it("takes a button, which waits for the first frame", async () => {
  let waited = false;
  const data = await run(
    {
      choices: "NO_KEYS",
      buttons: ["woman", "man"],
      on_load: () => (waited = document.querySelector("button")!.disabled),
    },
    (display) => display.querySelectorAll("button")[1]!.click(),
  );
  expect(waited).toBe(true);
  expect(data).toMatchObject({ response: 1, response_by: "button" });
});

it("shows the stimulus for its time and ends without a response", async () => {
  const data = await run({ stimulus_duration: 100, trial_duration: 300 });
  expect(data).toMatchObject({ response: null, response_by: null, rt: null });
  expect(Math.max(...data["frame_times"])).toBeLessThan(100);
});

it("goes on after a response where that does not end the trial", async () => {
  const data = await run({ trial_duration: 400, response_ends_trial: false }, () => {
    press("a");
    press("b");
  });
  expect(data["response"]).toBe("a");
  expect(Math.max(...data["frame_times"])).toBeGreaterThan(300);
});

/** Frames of a screen of 60 Hz whose clock jitters, as fast as this machine makes them; `late` frames are missed. */
function jitteringScreen(late: (frame: number) => boolean = () => false): void {
  let frame = 0;
  vi.stubGlobal("requestAnimationFrame", (draw: FrameRequestCallback) =>
    setTimeout(() => {
      do frame++;
      while (late(frame));
      draw((frame * 1000) / 60 + 0.4 * Math.sin(7 * frame));
    }),
  );
}

/** The plugin as a page on such a screen loads it: it has seen no other, and no clock of this machine. */
async function pluginOnJitteringScreen(): Promise<typeof WalkerPlugin> {
  await run({ trial_duration: 20 }); // the plugin of the other tests has measured its screen, and takes no more frames
  jitteringScreen();
  vi.resetModules();
  return (await import("../plugin-walker/src/index")).default;
}

it("shows as many whole frames as fit best, whatever the clock's jitter", async () => {
  const type = await pluginOnJitteringScreen();
  const jsPsych = initJsPsych();
  const trial = { type, stimulus, choices: "NO_KEYS", trial_duration: 120 };
  const shown = { 100: 6, 94: 6, 50: 3, 1: 1 };
  const durations = Object.keys(shown).map(Number);
  await jsPsych.run(Array.from({ length: 60 }, (_, i) => ({ ...trial, stimulus_duration: durations[i % 4] })));
  jsPsych.data.get().values().forEach((data: Record<string, any>, i: number) => {
    const planned = shown[durations[i % 4] as keyof typeof shown];
    expect(data).toMatchObject({ frames_shown: planned, frames_planned: planned, frames_dropped: 0 });
    expect(data["frame_times"].length).toBe(planned);
    expect(data["shown_for"]).toBeCloseTo((planned * 1000) / 60, -0.5);
    expect(data["refresh_rate"]).toBeCloseTo(60, 0);
  });
});

it("says which frames were missed, also the one that should have ended it", async () => {
  const type = await pluginOnJitteringScreen();
  await run({ type, trial_duration: 50 }); // which waits until the screen is measured
  for (const missed of [[4], [4, 5, 9], [12]]) {
    jitteringScreen((frame) => missed.includes(frame - 1)); // frame 1 is the first of the trial
    const data = await run({ type, stimulus_duration: 200, trial_duration: 300 });
    const inside = missed.filter((frame) => frame < 12).length;
    expect(data).toMatchObject({ frames_planned: 12, frames_shown: 12 - inside, frames_dropped: missed.length });
    expect(data["frame_interval_max"]).toBeGreaterThan(missed[0] === 12 ? 15 : 30);
  }
});

it("says what answers were given with, and whether the page was left", async () => {
  const data = await run({ choices: "NO_KEYS", buttons: ["woman", "man"] }, (display) => {
    window.dispatchEvent(new Event("blur"));
    display.querySelectorAll("button")[0]!.click();
  }, 300);
  expect(data).toMatchObject({ response: 0, response_device: "keyboard", focus_lost: 1, clock_isolated: false });
});

it("says what is wrong with a stimulus", async () => {
  await expect(run({ stimulus: { format: "film" } })).rejects.toThrow("no stimulus");
});

it("can be simulated", async () => {
  const jsPsych = initJsPsych();
  await jsPsych.simulate([{ type: WalkerPlugin, stimulus, choices: ["f", "m"] }], "data-only");
  expect(["f", "m"]).toContain(jsPsych.data.get().values()[0].response);
});

it("can be simulated on the screen", async () => {
  const jsPsych = initJsPsych();
  const trial = { type: WalkerPlugin, stimulus, choices: "NO_KEYS", buttons: ["a", "b"] };
  const options = { default: { data: { response: 1, rt: 120 } } };
  await jsPsych.simulate([trial], "visual", options);
  const [data] = jsPsych.data.get().values();
  expect(data).toMatchObject({ response: 1, response_by: "button" });
  expect(data.rt).toBeGreaterThan(50);
});

it("loads the mannequin's module for a mannequin, and then begins", async () => {
  for (const level of ["warn", "error"] as const) {
    vi.spyOn(console, level).mockImplementation(() => {}); // jsdom has no WebGL: it is drawn flat
  }
  let loaded = 0;
  const mannequin = { ...stimulus, display: { ...stimulus.display, style: "mannequin" } };
  const data = await run({ stimulus: mannequin, trial_duration: 200, on_load: () => loaded++ });
  expect(loaded).toBe(1);
  expect(data["frame_times"].length).toBeGreaterThan(2);
  expect(drawn).toHaveBeenCalledWith("createLinearGradient");
});
