/** Saving and sharing: the address, files of the present picture, and Python code. */

import { addressOf } from "../model/address";
import { pythonCode } from "../model/pythonCode";
import { button, make } from "../page/elements";
import { chooseEncoding } from "../viewer/filmEncoder";
import {
  download, filmFile, pageFile, pictureFile, stimulusFile,
  type SavedFile, type Snapshot,
} from "../viewer/saving";
import type { Notices } from "./notices";
import { note } from "./parts";
import { hasServer, makeFilm } from "./server";
import type { Part, Store } from "./store";

/** The movement of the first walker, for programs of animation. */
const MOVEMENTS = ["bvh", "glb"] as const;
const FORMATS =
  "A picture is PNG, a film MP4 or WebM, a page one file of HTML that plays by itself; a stimulus is JSON.";
const WITH_SERVER = " BVH and GLB hold the first walker's movement, for programs of animation.";

export function share(store: Store, notices: Notices): Part {
  const python = make("pre", { class: "line", tabindex: 0, "aria-label": "Python that makes this walker" });
  const copyLink = (): void => {
    const address = addressOf(store.state, store.model);
    const what = store.state.from === "own" ? "Link, which does not hold your own capture," : "Link";
    void copy(location.href.split("#")[0] + (address && `#${address}`), what, notices);
  };
  const film = filmButton(store, notices);
  const saveButton = (label: string, fileOf: (snapshot: Snapshot) => SavedFile | Promise<SavedFile>) =>
    button(label, async () => {
      try {
        save(await fileOf(snapshotOf(store)), notices);
      } catch (error) {
        notices.caught(error);
      }
    });
  return {
    element: make("div", {},
      make("div", { class: "row" },
        button("Copy link", copyLink, { class: "main-button" }),
        button("Copy Python", () => void copy(python.textContent ?? "", "Python", notices)),
      ),
      make("div", { class: "row" },
        saveButton("Picture", pictureFile),
        film.button,
        saveButton("Page", pageFile),
        saveButton("Stimulus", stimulusFile),
        ...(hasServer() ? MOVEMENTS : []).map((format) => saveButton(format.toUpperCase(), (now) => served(now, format))),
      ),
      film.progress,
      note(FORMATS + (hasServer() ? WITH_SERVER : "")),
      python,
    ),
    show: ({ model, state, own }) => void (python.textContent = pythonCode(model, state, own)),
  };
}

function snapshotOf(store: Store): Snapshot {
  return { ...store.now(), phase: store.viewer?.phase ?? 0, mannequin: store.viewer?.mannequin ?? null };
}

function save(file: SavedFile, notices: Notices): void {
  download(file);
  notices.news([`${file.name} saved.`, file.note ?? ""].join(" ").trim());
}

/** A button that makes a film, and a progress bar; meanwhile the button stops the film. */
function filmButton(store: Store, notices: Notices): { button: HTMLButtonElement; progress: HTMLProgressElement } {
  const progress = make("progress", { max: 1, value: 0, hidden: true, "aria-label": "Film" });
  let current: AbortController | null = null;
  const film = button("Film", () => {
    if (current) current.abort();
    else void begin(new AbortController());
  });
  const setCurrent = (next: AbortController | null): void => {
    current = next;
    progress.hidden = !next;
    progress.value = 0;
    film.textContent = next ? "Stop the film" : "Film";
  };
  const begin = async (stop: AbortController): Promise<void> => {
    setCurrent(stop);
    try {
      const onProgress = (share: number): void => void (progress.value = share);
      save(await makeFilmFile(snapshotOf(store), { progress: onProgress, signal: stop.signal }), notices);
    } catch (error) {
      if (!stop.signal.aborted) notices.caught(error);
    } finally {
      setCurrent(null);
    }
  };
  return { button: film, progress };
}

/** The browser makes the film, unless only the server can make an MP4. */
async function makeFilmFile(snapshot: Snapshot, options: Parameters<typeof filmFile>[1]): Promise<SavedFile> {
  const encoding = await chooseEncoding({ width: 720, height: 720, rateHz: 60 }).catch(() => null);
  if (!hasServer() || encoding?.suffix === "mp4") return filmFile(snapshot, options);
  return served(snapshot, "mp4");
}

/** The server makes the file of the stimulus. */
async function served(snapshot: Snapshot, format: Parameters<typeof makeFilm>[1]): Promise<SavedFile> {
  const { name, blob } = stimulusFile(snapshot);
  return { name: name.replace(/json$/, format), blob: await makeFilm(await blob.text(), format) };
}

async function copy(text: string, what: string, notices: Notices): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    notices.news(`${what} copied.`);
  } catch {
    notices.error(`This browser lets the page copy nothing. ${what}: ${text}`);
  }
}
