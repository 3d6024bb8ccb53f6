/** The page: reads the model that it holds and puts its parts together. */

import { addressOf, stateOf } from "../model/address";
import { captionOf } from "../model/captions";
import { Stage } from "../stage/stage";
import { classifier } from "./classifier";
import { changes } from "./changes";
import { cloud } from "./cloud";
import { about, peopleIn } from "./about";
import { find, icon, make, put } from "./element";
import { takeFiles } from "./files";
import { pageKeys, stageKeys } from "./keyboard";
import { label } from "./labels";
import { look, transforms } from "./look";
import { bias, strengths } from "./moler";
import { Notices } from "./notices";
import { bundles, heldIn, openFiles, type Held } from "./opening";
import { plausible } from "./plausible";
import { scenes } from "./scenes";
import { section, words, type Fold } from "./section";
import { Session, type Now, type Part } from "./session";
import { share } from "./share";
import { theme } from "./theme";
import { eigenwalkerSliders, mainSlider, otherTraits } from "./traits";
import { transport } from "./transport";
import { who } from "./who";

/** The address follows after so long a rest. */
const REST_MS = 250;
/** There is room for a panel on the left as well. */
const WIDE = window.matchMedia("(min-width: 100rem)");

const notices = new Notices();
let held: Held | null = null;
let session: Session | null = null;
/** Ends what belongs to the session shown. */
let leave = (): void => {};

const canvas = find("#stage canvas", HTMLCanvasElement);
const host = find("#stage", HTMLDivElement);
const choose = takeFiles((files) => void take(files));

/** Open what is brought; what cannot be read is said, and all else stays. */
async function take(files: readonly File[]): Promise<void> {
  for (const bundle of bundles(files)) {
    const name = bundle.length === 1 ? bundle[0]!.name : `${bundle.length} files`;
    const done = notices.busy(`Reading ${name} \u2026`);
    try {
      const opened = await openFiles(bundle, held);
      if (opened.kind === "model") begin(opened.held);
      else session?.take(opened.own);
      const walks = opened.kind === "model" ? `${name}: ${peopleIn(opened.held.model)}.` : `${opened.own.name} walks.`;
      if (opened.told.length > 0) notices.told([walks, ...opened.told]);
      else notices.news(walks);
    } catch (error) {
      notices.caught(error);
    } finally {
      done();
    }
  }
}

/** Show a model, from its start or as the address says. */
function begin(next: Held, address = ""): void {
  leave();
  held = next;
  const { model } = next;
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const start = stateOf(address, model);
  const dark = session?.state.dark ?? start.dark;
  const now = new Session(model, { ...start, dark, playing: start.playing && !calm });
  session = now;
  const parts = [stagePart(now), ...furnish(now), addressPart(now)];
  now.listen((moment) => parts.forEach((part) => part.show(moment)));
  now.tell();
}

/** The walker itself, and all that is written on the stage. */
function stagePart(session: Session): Pick<Part, "show"> {
  const tools = transport(session);
  const hint = find("#hint", HTMLParagraphElement);
  const labels = find("#labels", HTMLDivElement);
  const caption = find("#caption", HTMLParagraphElement);
  const people = find("#people", HTMLParagraphElement);
  const stage = new Stage(canvas, {
    turned: (azimuth_deg, elevation_deg) => {
      hint.classList.add("done");
      session.change({ azimuth_deg, elevation_deg });
    },
    ticked: (cycle) => tools.tick(cycle),
    picked: (known) => session.change({ from: known, scene: "one" }),
    laid: (boxes) => label(labels, last?.cast ?? [], boxes),
  });
  session.stage = stage;
  let last: Now | undefined;
  const keys = stageKeys(session);
  host.addEventListener("keydown", keys);
  find("#tools", HTMLDivElement).replaceChildren(tools.element);
  put(host, { tabindex: 0, role: "slider", "aria-label": "Walker, seen from", "aria-valuemin": -180, "aria-valuemax": 180 });
  let saying = 0;
  leave = () => {
    stage.remove();
    host.removeEventListener("keydown", keys);
    session.end();
  };
  return {
    show(now) {
      last = now;
      stage.show(now.model, now.cast, now.state);
      tools.show(now);
      const who = now.state.scene === "one" && now.state.from !== "average" ? [now.cast[0]!.name] : [];
      people.textContent = [peopleIn(now.model), ...who].join(" \u00b7 ");
      const degrees = Math.round(now.state.azimuth_deg);
      put(host, { "aria-valuenow": degrees, "aria-valuetext": `${degrees} degrees` });
      clearTimeout(saying);
      saying = window.setTimeout(() => {
        const said = captionOf(now.model, now.state, now.own);
        if (caption.textContent !== said) caption.textContent = said;
      }, 1200);
    },
  };
}

/** Controls and plots, in their places. */
function furnish(session: Session): Pick<Part, "show">[] {
  const hero = mainSlider(session);
  find("#hero", HTMLDivElement).replaceChildren(hero.element);
  const corner = cornerOf(session);
  find("#corner", HTMLDivElement).replaceChildren(corner.element);
  const insight: Fold[] = [
    section("What changes", [plausible(session), changes(session)], true),
    section("Among the others", [cloud(session)], WIDE.matches),
  ];
  const others = otherTraits(session);
  const controls: Fold[] = [
    ...(others.element.childElementCount > 0 ? [section("More traits", [others], true)] : []),
    section("Who walks", [who(session, choose)], WIDE.matches),
    section("Several at once", [scenes(session)], WIDE.matches),
    ...(session.model.traits.length > 0 ? [section("Body or motion", [classifier(session)], WIDE.matches)] : []),
    section("Stride, sway, hop, bounce", [strengths(session), bias(session)]),
    section("Eigenwalkers", [words("What varies most from walker to walker, whatever it means."), eigenwalkerSliders(session)]),
    section("Look", [look(session), transforms(session)]),
    section("Keep and share", [share(session, notices)]),
  ];
  place(insight, controls);
  const move = (): void => place(insight, controls);
  WIDE.addEventListener("change", move);
  const before = leave;
  leave = () => {
    WIDE.removeEventListener("change", move);
    before();
  };
  return [hero, corner, ...insight, ...controls];
}

/** What changes stands on the left where there is room, else after the traits. */
function place(insight: readonly Fold[], controls: readonly Fold[]): void {
  const left = find("#insight", HTMLElement);
  const right = find("#panel", HTMLElement);
  const said = about(session!.model);
  const [first, ...others] = controls.map(({ element }) => element);
  const plots = insight.map(({ element }) => element);
  left.hidden = !WIDE.matches;
  left.replaceChildren(...(WIDE.matches ? plots : []));
  right.replaceChildren(first!, ...(WIDE.matches ? [] : plots), ...others, said);
}

/** Open, undo, all as it was, dark or light. */
function cornerOf(session: Session): Part {
  const act = (name: "undo" | "back" | "open", words: string, does: () => void): HTMLButtonElement => {
    const button = make("button", { type: "button", class: "quiet", "aria-label": words, title: words }, icon(name));
    button.addEventListener("click", does);
    return button;
  };
  const undo = act("undo", "Undo", () => session.undo());
  const switchTheme = theme(session);
  return {
    element: make("div", { class: "row" },
      act("open", "Open a file", choose),
      undo,
      act("back", "Reset all", () => session.reset()),
      switchTheme.element,
    ),
    show(now) {
      undo.disabled = !session.canUndo;
      switchTheme.show(now);
    },
  };
}

/** The address tells what is shown, a moment later. */
function addressPart(session: Session): Pick<Part, "show"> {
  let timer = 0;
  return {
    show({ state, model }) {
      clearTimeout(timer);
      timer = window.setTimeout(() => {
        const address = addressOf(state, model);
        const here = location.pathname + location.search;
        if (session === current()) history.replaceState(null, "", address ? `#${address}` : here);
      }, REST_MS);
    },
  };
}

const current = (): Session | null => session;

/** The model that the page holds; null where it holds none. */
function inPage(): Held | null {
  const text = find("#model", HTMLScriptElement).textContent ?? "null";
  const content: unknown = JSON.parse(text);
  return content === null ? null : heldIn(content);
}

function start(): void {
  find("#notices", HTMLDivElement).append(notices.element);
  document.addEventListener("keydown", (event) => session && pageKeys(session)(event));
  window.addEventListener("hashchange", () => {
    if (session) session.change(stateOf(location.hash.slice(1), session.model));
  });
  try {
    const inside = inPage();
    if (inside) begin(inside, location.hash.slice(1));
    else {
      notices.trouble("This page holds no walkers yet: drop a model on it, or choose one.");
      find("#corner", HTMLDivElement).append(askForFile());
    }
  } catch (error) {
    notices.caught(error);
  }
}

function askForFile(): HTMLButtonElement {
  const button = make("button", { type: "button" }, "Choose a file");
  button.addEventListener("click", choose);
  return button;
}

start();
