/** A stimulus in a notebook: shown as it is, again and again. */

import { everyFrame } from "../canvas/frameClock";
import { painterOn } from "../canvas/painter";
import { readStimulus } from "../core/readStimulus";
import type { Shared } from "./widget";

export function film(shared: Shared, box: HTMLElement): () => void {
  const stimulus = readStimulus(shared.get("_stimulus"));
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "A moving figure");
  const button = document.createElement("button");
  button.type = "button";
  const bar = document.createElement("div");
  bar.className = "bar";
  bar.append(button);
  box.replaceChildren(canvas, ...(shared.get("controls") ? [bar] : []));
  const scale = Math.min(1, Number(shared.get("height_px")) / stimulus.display.height_px);
  const painter = painterOn(canvas, stimulus, scale);
  let time = 0;
  let stop = (): void => {};
  const show = (): void => {
    stop();
    const playing = Boolean(shared.get("playing"));
    button.textContent = playing ? "Pause" : "Play";
    const from = time;
    painter.paint(time);
    if (!playing) return;
    stop = everyFrame((elapsedMs) => {
      time = (from + elapsedMs / 1000) % stimulus.timing.duration_s;
      painter.paint(time);
      return true;
    });
  };
  button.addEventListener("click", () => {
    shared.set("playing", !shared.get("playing"));
    shared.save_changes();
  });
  shared.on("change:playing", show);
  show();
  return () => {
    stop();
    shared.off("change:playing", show);
  };
}
