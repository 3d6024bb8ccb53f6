/** The interactive page: reads its model, assembles its parts, and opens files. */

import { addressOf, stateOf } from "../model/address";
import { populationLabel, warnings } from "../model/labels";
import type { OwnWalker } from "../model/model";
import { modelSourceOf, withSize, type ModelSource } from "../model/modelSource";
import type { State } from "../model/state";
import { button, find, messageOf } from "../page/elements";
import { panels } from "./panels";
import {
  bundleName, bundles, openFiles, takeFiles, type DroppedFiles, type Opened,
} from "./openFile";
import { Notices } from "./notices";
import { Store, type View } from "./store";
import { toolbar } from "./toolbar";
import { mainSlider } from "./traitSliders";
import { viewerPanel } from "./viewerPanel";

interface Session {
  readonly source: ModelSource;
  readonly store: Store;
  readonly views: readonly View[];
}

/** The address changes after a pause of this length. */
const ADDRESS_PAUSE_MS = 250;
/** Elements that use the space bar themselves. */
const USES_SPACE = "button, select, summary, textarea, a, [role=listbox], input:not([type=range])";

const notices = new Notices();
let session: Session | null = null;
const chooseFiles = takeFiles((dropped) => void openDropped(dropped));

/** Open files; errors are shown, and the page stays as it was. */
async function openDropped({ files, folder }: DroppedFiles): Promise<void> {
  const errors: string[] = [];
  notices.clear();
  for (const bundle of bundles(files)) {
    const name = bundleName(bundle, folder);
    const done = notices.busy(`Reading ${name} \u2026`);
    try {
      const opened = await openFiles(bundle, session?.source ?? null, folder);
      if (opened.kind === "names") {
        notices.news(opened.messages.join(" "));
        continue;
      }
      const news = show(opened, name);
      const more = [...(opened.kind === "model" ? warnings(opened.source.model) : []), ...opened.messages];
      if (more.length > 0) notices.info([news, ...more]);
      else notices.news(news);
    } catch (error) {
      errors.push(messageOf(error));
      notices.error(...errors);
    } finally {
      done();
    }
  }
}

/** Show opened files; returns a sentence about them. */
function show(opened: Exclude<Opened, { kind: "names" }>, name: string): string {
  if (opened.kind === "own") {
    session?.store.setOwn(opened.own);
    return `${opened.own.name} walks.`;
  }
  const before = session;
  const address = before ? addressOf(before.store.state, before.source.model) : "";
  try {
    begin(opened.source, before?.store.state.dark === false ? "dark=0" : "");
  } catch (error) {
    if (before) begin(before.source, address, before.store.own);
    throw error;
  }
  const people = populationLabel(opened.source.model);
  return people.endsWith(name) ? `${people}.` : `${name}: ${people}.`;
}

function addressBar(): View {
  let timer = 0;
  return {
    show({ state, model }) {
      clearTimeout(timer);
      timer = window.setTimeout(() => {
        const address = addressOf(state, model);
        history.replaceState(null, "", address ? `#${address}` : location.pathname + location.search);
      }, ADDRESS_PAUSE_MS);
    },
    remove: () => clearTimeout(timer),
  };
}

/** Begins again with the same walkers, once they are to have their size or to lose it. */
const sizes = (source: ModelSource): View => ({
  show({ state, model, own }) {
    if (!source.other || state.keepSize === model.size_kept) return;
    queueMicrotask(() => begin(source, addressOf(state, model), own));
  },
});

/** The state in an address; without the visitor's own capture, and paused if motion is to be reduced. */
function stateFor(address: string, { model }: ModelSource, own: OwnWalker | null): State {
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const state = { ...stateOf(address, model), ...(calm && { playing: false }) };
  if (state.from !== "own" || own) return state;
  notices.info(["The walker of this link was a capture of one's own, which a link does not hold: drop it again."]);
  return { ...state, from: "average" };
}

/** Show a model in the state of an address. */
function begin(from: ModelSource, address: string, own: OwnWalker | null = null): void {
  session?.store.end();
  session?.views.forEach((view) => view.remove?.());
  const source = withSize(from, stateOf(address, from.model).keepSize);
  const keepSize = source.model.size_kept;
  const store = new Store(source.model, { ...stateFor(address, source, own), keepSize }, own);
  const main = mainSlider(store);
  find("#main-slider", HTMLDivElement).replaceChildren(main.element);
  const tools = toolbar(store, chooseFiles);
  const views = [viewerPanel(store), main, tools, panels(store, notices, chooseFiles), addressBar(), sizes(source)];
  session = { source, store, views };
  store.listen((now) => views.forEach((view) => view.show(now)));
  store.publish();
}

/** Space plays or pauses; Ctrl+Z undoes. */
function onKey(store: Store, event: KeyboardEvent): void {
  if (event.defaultPrevented || !(event.target instanceof Element)) return;
  const undoes = (event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "z";
  if (undoes) store.undo();
  else if (event.key !== " " || event.target.closest(USES_SPACE)) return;
  else store.play(!store.state.playing);
  event.preventDefault();
}

function start(): void {
  find("#notices", HTMLDivElement).append(notices.element);
  document.addEventListener("keydown", (event) => session && onKey(session.store, event));
  document.addEventListener("pointerdown", () => session?.store.setDragging(true), { capture: true });
  const drop = (): void => session?.store.setDragging(false);
  for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, drop);
  window.addEventListener("hashchange", () => {
    session?.store.change(stateFor(location.hash.slice(1), session.source, session.store.own));
  });
  try {
    const content: unknown = JSON.parse(find("#model", HTMLScriptElement).textContent ?? "null");
    if (content !== null) return begin(modelSourceOf(content), location.hash.slice(1));
    notices.error("This page holds no walkers yet: drop a model on it, or choose one.");
  } catch (error) {
    notices.caught(error);
  }
  find("#toolbar", HTMLDivElement).append(button("Choose a file", chooseFiles));
}

start();
