/** The page: reads the model that it holds, puts its parts together, and takes what is brought. */

import { addressOf } from "../model/address";
import type { Own } from "../model/model";
import type { State } from "../model/state";
import { peopleIn, warnings } from "./about";
import { address, stateAt } from "./addressBar";
import { corner } from "./toolbar";
import { find, make } from "../page/element";
import { takeFiles, type Brought } from "./fileDrop";
import { pageKeys } from "./keyboard";
import { Notices, sentenceOf } from "./notices";
import { onStage } from "./viewerPanel";
import { bundles, callIt, heldIn, openFiles, type Held, type Opened } from "./openFile";
import { panels } from "./panels";
import { Session, type Shown } from "./store";
import { mainSlider } from "./traitSliders";

/** What is shown, and all that shows it. */
interface Visit {
  readonly held: Held;
  readonly session: Session;
  readonly parts: readonly Shown[];
}

const notices = new Notices();
let visit: Visit | null = null;
const choose = takeFiles((brought) => void take(brought));

/** Open what is brought; what cannot be read is said, and all else stays. */
async function take({ files, folder }: Brought): Promise<void> {
  const troubles: string[] = [];
  notices.clear();
  for (const bundle of bundles(files)) {
    const name = callIt(bundle, folder);
    const done = notices.busy(`Reading ${name} \u2026`);
    try {
      const opened = await openFiles(bundle, visit?.held ?? null, folder);
      const walks = show(opened, name);
      const mind = opened.kind === "model" ? warnings(opened.held.model) : [];
      const told = [...mind, ...opened.messages];
      if (told.length > 0) notices.told([walks, ...told]);
      else notices.news(walks);
    } catch (error) {
      troubles.push(sentenceOf(error));
      notices.trouble(...troubles);
    } finally {
      done();
    }
  }
}

/** Show what was opened; returns what to say of it. */
function show(opened: Opened, name: string): string {
  if (opened.kind === "own") {
    visit?.session.take(opened.own);
    return `${opened.own.name} walks.`;
  }
  const before = visit && { ...visit, address: addressOf(visit.session.state, visit.held.model) };
  try {
    begin(opened.held, visit?.session.state.dark === false ? "dark=0" : "");
  } catch (error) {
    if (before) begin(before.held, before.address, before.session.own);
    throw error;
  }
  const people = peopleIn(opened.held.model);
  return people.endsWith(name) ? `${people}.` : `${name}: ${people}.`;
}

/** What an address tells; a capture of one's own is in no address. */
function wanted(told: string, { model }: Held, own: Own | null): State {
  const state = stateAt(told, model);
  if (state.from !== "own" || own) return state;
  notices.told(["The walker of this link was a capture of one's own, which a link does not hold: drop it again."]);
  return { ...state, from: "average" };
}

/** Show a model as an address tells. */
function begin(held: Held, told: string, own: Own | null = null): void {
  visit?.session.end();
  visit?.parts.forEach((part) => part.leave?.());
  const session = new Session(held.model, wanted(told, held, own), own);
  const hero = mainSlider(session);
  find("#hero", HTMLDivElement).replaceChildren(hero.element);
  const parts = [onStage(session), hero, corner(session, choose), panels(session, notices, choose), address()];
  visit = { held, session, parts };
  session.listen((now) => parts.forEach((part) => part.show(now)));
  session.tell();
}

/** The model that the page holds; null where it holds none. */
function inPage(): Held | null {
  const content: unknown = JSON.parse(find("#model", HTMLScriptElement).textContent ?? "null");
  return content === null ? null : heldIn(content);
}

function start(): void {
  find("#notices", HTMLDivElement).append(notices.element);
  document.addEventListener("keydown", (event) => visit && pageKeys(visit.session)(event));
  document.addEventListener("pointerdown", () => visit?.session.hold(true), { capture: true });
  for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, () => visit?.session.hold(false));
  window.addEventListener("hashchange", () => {
    visit?.session.change(wanted(location.hash.slice(1), visit.held, visit.session.own));
  });
  try {
    const inside = inPage();
    if (inside) return begin(inside, location.hash.slice(1));
    notices.trouble("This page holds no walkers yet: drop a model on it, or choose one.");
  } catch (error) {
    notices.caught(error);
  }
  const ask = make("button", { type: "button" }, "Choose a file");
  ask.addEventListener("click", choose);
  find("#corner", HTMLDivElement).append(ask);
}

start();
