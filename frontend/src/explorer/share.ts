/** Keep and share: the address, files of what is shown, and the Python that makes this walker. */

import { addressOf } from "../model/address";
import { pythonLine } from "../model/pythonCode";
import { download, filmFile, pageFile, pictureFile, stimulusFile, type Kept, type SavedFile } from "../viewer/saving";
import { button } from "./choice";
import { make } from "../page/element";
import type { Notices } from "./notices";
import { hasServer, makeFilm } from "./server";
import type { Part, Session } from "./store";

const FORMATS =
  "A picture is PNG, a film MP4 or WebM, a page one file of HTML that plays by itself; a stimulus is JSON.";

export function share(session: Session, notices: Notices): Part {
  const python = make("pre", { class: "line", tabindex: 0, "aria-label": "Python that makes this walker" });
  const copy = (text: string, what: string): void => void copied(text, what, notices);
  const link = (): void => {
    const address = addressOf(session.state, session.model);
    const what = session.state.from === "own" ? "Link, which does not hold your own capture," : "Link";
    copy(location.href.split("#")[0] + (address && `#${address}`), what);
  };
  const film = filming(session, notices);
  const saves = (label: string, file: (kept: Kept) => SavedFile | Promise<SavedFile>): HTMLButtonElement =>
    button(label, async () => {
      try {
        saved(await file(kept(session)), notices);
      } catch (error) {
        notices.caught(error);
      }
    });
  return {
    element: make("div", {},
      make("div", { class: "row" },
        button("Copy link", link, "main-button"),
        button("Copy Python", () => copy(python.textContent ?? "", "Python")),
      ),
      make("div", { class: "row" },
        saves("Picture", pictureFile),
        film.button,
        saves("Page", pageFile),
        saves("Stimulus", stimulusFile),
      ),
      film.progress,
      make("p", { class: "note" }, FORMATS),
      python,
    ),
    show: ({ model, state, own }) => void (python.textContent = pythonLine(model, state, own)),
  };
}

/** What is on the stage, with all that is needed to draw it. */
function kept(session: Session): Kept {
  const { model, cast, state } = session.now();
  return { model, cast, state, cycle: session.stage?.cycle ?? 0, mannequin: session.stage?.mannequin ?? null };
}

function saved(file: SavedFile, notices: Notices): void {
  download(file);
  notices.news([`${file.name} saved.`, file.told ?? ""].join(" ").trim());
}

/** A button that makes a film, and how far it is; while it is made, the button stops it. */
function filming(session: Session, notices: Notices): { button: HTMLButtonElement; progress: HTMLProgressElement } {
  const progress = make("progress", { max: 1, value: 0, hidden: true, "aria-label": "Film" });
  let making: AbortController | null = null;
  const film = button("Film", () => {
    if (making) making.abort();
    else void begin();
  });
  const show = (is: AbortController | null): void => {
    making = is;
    progress.hidden = !is;
    progress.value = 0;
    film.textContent = is ? "Stop the film" : "Film";
  };
  const begin = async (): Promise<void> => {
    const stop = new AbortController();
    show(stop);
    try {
      const told = (share: number): void => void (progress.value = share);
      saved(await filmed(kept(session), { progress: told, signal: stop.signal }), notices);
    } catch (error) {
      if (!stop.signal.aborted) notices.caught(error);
    } finally {
      show(null);
    }
  };
  return { button: film, progress };
}

/** The browser makes the film, unless only the server can make an MP4. */
async function filmed(kept: Kept, how: Parameters<typeof filmFile>[1]): Promise<SavedFile> {
  if (!hasServer() || (await makesMp4())) return filmFile(kept, how);
  const { name, blob } = stimulusFile(kept);
  return { name: name.replace(/json$/, "mp4"), blob: await makeFilm(await blob.text(), "mp4") };
}

async function makesMp4(): Promise<boolean> {
  if (typeof VideoEncoder === "undefined") return false;
  const wish = { codec: "avc1.42003e", width: 720, height: 720 };
  const { supported } = await VideoEncoder.isConfigSupported(wish).catch(() => ({ supported: false }));
  return supported === true;
}

async function copied(text: string, what: string, notices: Notices): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    notices.news(`${what} copied.`);
  } catch {
    notices.trouble(`This browser lets the page copy nothing. ${what}: ${text}`);
  }
}
