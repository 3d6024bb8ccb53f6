/** The walker itself, how it is played, and all that is written around it. */

import { captionOf } from "../model/captions";
import { Stage } from "../viewer/viewer";
import { peopleIn } from "./about";
import { find, put } from "../page/element";
import { stageKeys } from "./keyboard";
import { label } from "./figureLabels";
import type { Now, Session, Shown } from "./store";
import { transport } from "./playback";

/** A screen reader hears what is seen once the sliders have rested so long. */
const REST_MS = 1200;

export function onStage(session: Session): Shown {
  const host = find("#stage", HTMLDivElement);
  const hint = find("#hint", HTMLParagraphElement);
  const labels = find("#labels", HTMLDivElement);
  const people = find("#people", HTMLParagraphElement);
  const tools = transport(session);
  let last: Now | undefined;
  const stage = new Stage(find("#stage canvas", HTMLCanvasElement), {
    turned: (azimuth_deg, elevation_deg) => {
      hint.classList.add("done");
      session.change({ azimuth_deg, elevation_deg });
    },
    ticked: (cycle) => tools.tick(cycle),
    picked: (known) => session.change({ from: known, scene: "one" }),
    laid: (boxes) => label(labels, last?.cast ?? [], boxes),
  });
  session.stage = stage;
  const keys = stageKeys(session);
  host.addEventListener("keydown", keys);
  find("#tools", HTMLDivElement).replaceChildren(tools.element);
  const say = caption();
  return {
    show(now) {
      last = now;
      stage.show(now.model, now.cast, now.state);
      tools.show(now);
      people.textContent = [peopleIn(now.model), ...whoWalks(now)].join(" \u00b7 ");
      const degrees = Math.round(now.state.azimuth_deg);
      put(host, { "aria-valuenow": degrees, "aria-valuetext": `${degrees} degrees` });
      say(now);
    },
    leave() {
      stage.remove();
      host.removeEventListener("keydown", keys);
    },
  };
}

/** Who it is, where it is somebody. */
const whoWalks = ({ state, cast }: Now): string[] =>
  state.scene === "one" && state.from !== "average" ? [cast[0]!.name] : [];

/** Says what is seen, a moment later and never twice. */
function caption(): (now: Now) => void {
  const element = find("#caption", HTMLParagraphElement);
  let timer = 0;
  return ({ model, state, own }) => {
    clearTimeout(timer);
    timer = window.setTimeout(() => {
      const said = captionOf(model, state, own);
      if (element.textContent !== said) element.textContent = said;
    }, REST_MS);
  };
}
