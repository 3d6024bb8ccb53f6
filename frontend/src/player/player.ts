/** The stand-alone page: plays the stimulus that it holds, again and again. */

import { playLoop } from "../canvas/frameClock";
import { mannequinInPage, type MannequinPainter } from "../canvas/mannequinLoader";
import { painterOn, type Painter } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import type { Step, Stimulus } from "../core/stimulus";
import { find, make, messageOf } from "../page/elements";

const canvas = find("canvas", HTMLCanvasElement);
const footer = find("footer", HTMLElement);
const button = find("#play", HTMLButtonElement);
const slider = find("#time", HTMLInputElement);
const now = find("#now", HTMLOutputElement);
const details = find("details", HTMLDetailsElement);

/** `#t=0.5` stands still at that moment; `#bare` hides the controls, for a frame in another page. */
const options = new URLSearchParams(location.hash.slice(1));

/** The scale that fits the window, 1 at most. */
function scaleFor({ display }: Stimulus): number {
  const height = window.innerHeight - (footer.hidden ? 0 : footer.offsetHeight);
  return Math.min(1, window.innerWidth / display.width_px, Math.max(height, 1) / display.height_px);
}

function play(stimulus: Stimulus, mannequin?: MannequinPainter): void {
  const { duration_s, rate_hz } = stimulus.timing;
  const still = options.get("t");
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let time = Number(still ?? 0) || 0;
  let playing = false;
  let stop = (): void => {};
  let painter: Painter;

  const show = (at = time): void => {
    time = at;
    painter.paint(time);
    slider.value = String(time);
    now.value = `${time.toFixed(2)} s`;
  };
  const setPlaying = (on: boolean): void => {
    stop();
    playing = on;
    button.textContent = playing ? "Pause" : "Play";
    if (playing) stop = playLoop(time, duration_s, show);
  };
  const seek = (to: number): void => {
    setPlaying(false);
    show(Math.min(Math.max(to, 0), duration_s));
  };
  const layOut = (): void => {
    const scale = scaleFor(stimulus);
    painter = painterOn(canvas, stimulus, scale, mannequin);
    const facts = stimulusFacts(stimulus, scale).flatMap(([term, fact]) => [make("dt", {}, term), make("dd", {}, fact)]);
    find("dl", HTMLDListElement).replaceChildren(...facts);
    show();
  };

  document.body.style.background = stimulus.display.background;
  footer.hidden = options.has("bare");
  slider.max = String(duration_s);
  slider.step = String(1 / rate_hz);
  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => seek(Number(slider.value)));
  window.addEventListener("resize", layOut);
  details.addEventListener("toggle", layOut);
  document.addEventListener("keydown", (event) => {
    if (event.target !== document.body) return;
    if (event.key === " ") setPlaying(!playing);
    else if (event.key === "ArrowRight") seek(time + 1 / rate_hz);
    else if (event.key === "ArrowLeft") seek(time - 1 / rate_hz);
    else return;
    event.preventDefault();
  });
  layOut();
  setPlaying(still === null && !calm);
}

/** Play the stimulus in a JSON text, or show why that is not possible. */
async function playText(text: string): Promise<void> {
  try {
    const stimulus = readStimulus(JSON.parse(text));
    play(stimulus, stimulus.display.style === "mannequin" ? await mannequinInPage() : undefined);
  } catch (error) {
    const message = find("#trouble", HTMLParagraphElement);
    message.textContent = messageOf(error);
    message.hidden = false;
    canvas.hidden = true;
  }
}

/** Ask for a file, if the page holds no stimulus. */
function askForFile(): void {
  const form = find("#open", HTMLFormElement);
  form.hidden = false;
  canvas.hidden = true;
  form.addEventListener("change", () => {
    const file = find("#open input", HTMLInputElement).files?.[0];
    void file?.text().then((text) => {
      form.hidden = true;
      canvas.hidden = false;
      return playText(text);
    });
  });
}

const content = find("#stimulus", HTMLScriptElement).textContent ?? "null";
if (content.trim() === "null") askForFile();
else void playText(content);

export function stimulusFacts(stimulus: Stimulus, scale: number): [string, string][] {
  const { display, timing, view, provenance, transforms } = stimulus;
  const eye = view.eye_distance_mm === null ? "orthographic" : `eye at ${view.eye_distance_mm} mm`;
  const size = `${display.width_px} x ${display.height_px} px`;
  return [
    ["shown", `${timing.duration_s} s, again and again`],
    ["view", `${view.view_deg} degrees, elevation ${view.elevation_deg}, ${eye}`],
    ["size", scale < 1 ? `${size}, here at ${Math.round(100 * scale)} %` : size],
    ...transforms.map((step, i): [string, string] => [`transform ${i + 1}`, stepText(step)]),
    ...Object.entries(provenance),
  ];
}

/** A transform with its parameters, without the walker of a morph. */
function stepText({ name, ...parameters }: Step): string {
  const texts = Object.entries(parameters)
    .filter(([parameter, value]) => parameter !== "walker" && value !== null)
    .map(([parameter, value]) => `${parameter} ${Array.isArray(value) ? value.join(", ") : value}`);
  return texts.length > 0 ? `${name}: ${texts.join("; ")}` : name;
}
