/** The stand-alone page: plays the stimulus that it holds, again and again. */

import { everyFrame } from "../canvas/frameClock";
import { heldMannequin, type MannequinPainter } from "../canvas/mannequinLoader";
import { painterOn, type Painter } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import type { Stimulus } from "../core/stimulus";
import { aboutStimulus } from "./stimulusFacts";

function find<Kind extends Element>(selector: string, kind: new () => Kind): Kind {
  const found = document.querySelector(selector);
  if (!(found instanceof kind)) throw new Error(`The page lacks ${selector}.`);
  return found;
}

const canvas = find("canvas", HTMLCanvasElement);
const footer = find("footer", HTMLElement);
const button = find("#play", HTMLButtonElement);
const slider = find("#time", HTMLInputElement);
const now = find("#now", HTMLOutputElement);
const details = find("details", HTMLDetailsElement);

/** `#t=0.5` stands still at that moment; `#bare` leaves out the controls, for a frame in a page. */
const wish = new URLSearchParams(location.hash.slice(1));

/** How large the stimulus can be shown, 1 at most. */
function room({ display }: Stimulus): number {
  const height = window.innerHeight - (footer.hidden ? 0 : footer.offsetHeight);
  return Math.min(1, window.innerWidth / display.width_px, Math.max(height, 1) / display.height_px);
}

function play(stimulus: Stimulus, mannequin?: MannequinPainter): void {
  const { duration_s, rate_hz } = stimulus.timing;
  const still = wish.get("t");
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let time = Number(still ?? 0) || 0;
  let playing = false;
  let stop = (): void => {};
  let painter: Painter;

  const show = (): void => {
    painter.paint(time);
    slider.value = String(time);
    now.value = `${time.toFixed(2)} s`;
  };
  const setPlaying = (wanted: boolean): void => {
    stop();
    playing = wanted;
    button.textContent = playing ? "Pause" : "Play";
    const from = time;
    if (!playing) return;
    stop = everyFrame((elapsedMs) => {
      time = (from + elapsedMs / 1000) % duration_s;
      show();
      return true;
    });
  };
  const stand = (at: number): void => {
    setPlaying(false);
    time = Math.min(Math.max(at, 0), duration_s);
    show();
  };
  const layOut = (): void => {
    const scale = room(stimulus);
    painter = painterOn(canvas, stimulus, scale, mannequin);
    describe(stimulus, scale);
    show();
  };

  document.body.style.background = stimulus.display.background;
  footer.hidden = wish.has("bare");
  slider.max = String(duration_s);
  slider.step = String(1 / rate_hz);
  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => stand(Number(slider.value)));
  window.addEventListener("resize", layOut);
  details.addEventListener("toggle", layOut);
  document.addEventListener("keydown", (event) => {
    if (event.target !== document.body) return;
    if (event.key === " ") setPlaying(!playing);
    else if (event.key === "ArrowRight") stand(time + 1 / rate_hz);
    else if (event.key === "ArrowLeft") stand(time - 1 / rate_hz);
    else return;
    event.preventDefault();
  });
  layOut();
  setPlaying(still === null && !calm);
}

function describe(stimulus: Stimulus, scale: number): void {
  const entries = aboutStimulus(stimulus, scale).flatMap(([term, said]) => {
    const dt = document.createElement("dt");
    const dd = document.createElement("dd");
    dt.textContent = term;
    dd.textContent = said;
    return [dt, dd];
  });
  find("dl", HTMLDListElement).replaceChildren(...entries);
}

/** Play what a text of JSON describes, or say why it cannot be played. */
async function playText(text: string): Promise<void> {
  try {
    const stimulus = readStimulus(JSON.parse(text));
    play(stimulus, stimulus.display.style === "mannequin" ? await heldMannequin() : undefined);
  } catch (error) {
    const trouble = find("#trouble", HTMLParagraphElement);
    trouble.textContent = error instanceof Error ? error.message : String(error);
    trouble.hidden = false;
    canvas.hidden = true;
  }
}

/** Ask for a file, where the page holds no stimulus. */
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

const held = find("#stimulus", HTMLScriptElement).textContent ?? "null";
if (held.trim() === "null") askForFile();
else void playText(held);
