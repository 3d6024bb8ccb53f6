/** The page: reads the model that it holds, puts its parts together, and takes what is brought. */

import { addressOf } from "../model/address";
import { peopleIn } from "./about";
import { address, stateAt } from "./address";
import { corner } from "./corner";
import { find, make } from "./element";
import { takeFiles } from "./files";
import { pageKeys } from "./keyboard";
import { Notices } from "./notices";
import { onStage } from "./onstage";
import { bundles, heldIn, openFiles, type Held, type Opened } from "./opening";
import { panels } from "./panels";
import { Session, type Shown } from "./session";
import { mainSlider } from "./traits";

/** What is shown, and all that shows it. */
interface Visit {
  readonly held: Held;
  readonly session: Session;
  readonly parts: readonly Shown[];
}

const notices = new Notices();
let visit: Visit | null = null;
const choose = takeFiles((files) => void take(files));

/** Open what is brought; what cannot be read is said, and all else stays. */
async function take(files: readonly File[]): Promise<void> {
  for (const bundle of bundles(files)) {
    const name = bundle.length === 1 ? bundle[0]!.name : `${bundle.length} files`;
    const done = notices.busy(`Reading ${name} \u2026`);
    try {
      const opened = await openFiles(bundle, visit?.held ?? null);
      const walks = show(opened, name);
      if (opened.told.length > 0) notices.told([walks, ...opened.told]);
      else notices.news(walks);
    } catch (error) {
      notices.caught(error);
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
  const before = visit && { held: visit.held, address: addressOf(visit.session.state, visit.held.model) };
  try {
    begin(opened.held, visit?.session.state.dark === false ? "dark=0" : "");
  } catch (error) {
    if (before) begin(before.held, before.address);
    throw error;
  }
  return `${name}: ${peopleIn(opened.held.model)}.`;
}

/** Show a model as an address tells. */
function begin(held: Held, told: string): void {
  visit?.session.end();
  visit?.parts.forEach((part) => part.leave?.());
  const session = new Session(held.model, stateAt(told, held.model));
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
  window.addEventListener("hashchange", () => {
    visit?.session.change(stateAt(location.hash.slice(1), visit.held.model));
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
