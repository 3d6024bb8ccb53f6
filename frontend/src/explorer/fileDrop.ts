/** Where files come in: dropped anywhere on the page, folders too, or chosen. */

import { find } from "../page/element";

/** More than these at once is a mistake. */
const MOST_FILES = 500;

/** Files that came together, and the folder in which they lay, if it was one. */
export interface Brought {
  readonly files: readonly File[];
  readonly folder: string;
}

/** Hand over files that are dropped or chosen; the returned function opens the choosing. */
export function takeFiles(take: (brought: Brought) => void): () => void {
  const veil = find("#drop", HTMLDivElement);
  const input = find("#file", HTMLInputElement);
  const brings = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
  window.addEventListener("dragover", (event) => {
    if (!brings(event)) return;
    event.preventDefault();
    veil.hidden = false;
  });
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) veil.hidden = true;
  });
  window.addEventListener("drop", (event) => {
    if (!brings(event)) return;
    event.preventDefault();
    veil.hidden = true;
    void dropped(event.dataTransfer!).then(take);
  });
  input.addEventListener("change", () => {
    take({ files: [...(input.files ?? [])], folder: "" });
    input.value = "";
  });
  return () => input.click();
}

/** What was dropped, with all that is in folders. */
async function dropped({ items, files }: DataTransfer): Promise<Brought> {
  const plain = { files: [...files], folder: "" };
  const entries = [...items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.some(({ isDirectory }) => isDirectory)) return plain;
  const found: File[] = [];
  for (const entry of entries) await gather(entry, found);
  return { files: found, folder: entries.length === 1 ? entries[0]!.name : "" };
}

async function gather(entry: FileSystemEntry, found: File[]): Promise<void> {
  if (found.length >= MOST_FILES || entry.name.startsWith(".")) return;
  if (entry.isFile) {
    found.push(await new Promise<File>((take, fail) => (entry as FileSystemFileEntry).file(take, fail)));
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const some = (): Promise<FileSystemEntry[]> => new Promise((take, fail) => reader.readEntries(take, fail));
  // A folder is read in pieces, the last of which is empty.
  for (let inside = await some(); inside.length > 0; inside = await some()) {
    for (const each of inside) await gather(each, found);
  }
}
