/** Files and folders that are dropped anywhere on the page, and files that are chosen. */

import { find } from "../page/elements";

const MAX_FILES = 500;

/** Files of one drop, and the name of their folder, if it was one. */
export interface DroppedFiles {
  readonly files: readonly File[];
  readonly folder: string;
}

/** Hand over files that are dropped or chosen; the returned function opens the dialog. */
export function takeFiles(take: (dropped: DroppedFiles) => void): () => void {
  const veil = find("#drop", HTMLDivElement);
  const input = find("#file", HTMLInputElement);
  const ifFiles = (handle: (event: DragEvent) => void) => (event: DragEvent): void => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    handle(event);
  };
  window.addEventListener("dragover", ifFiles(() => (veil.hidden = false)));
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) veil.hidden = true;
  });
  window.addEventListener("drop", ifFiles((event) => {
    veil.hidden = true;
    void filesOf(event.dataTransfer!).then(take);
  }));
  input.addEventListener("change", () => {
    take({ files: [...(input.files ?? [])], folder: "" });
    input.value = "";
  });
  return () => input.click();
}

/** The files of a drop, with those in folders. */
async function filesOf({ items, files }: DataTransfer): Promise<DroppedFiles> {
  const plain = { files: [...files], folder: "" };
  const entries = [...items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.some(({ isDirectory }) => isDirectory)) return plain;
  const found: File[] = [];
  for (const entry of entries) await collect(entry, found);
  return { files: found, folder: entries.length === 1 ? entries[0]!.name : "" };
}

async function collect(entry: FileSystemEntry, found: File[]): Promise<void> {
  if (found.length >= MAX_FILES || entry.name.startsWith(".")) return;
  if (entry.isFile) {
    found.push(await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject)));
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const next = (): Promise<FileSystemEntry[]> => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
  // A folder is read in batches; the last one is empty.
  for (let batch = await next(); batch.length > 0; batch = await next()) {
    for (const each of batch) await collect(each, found);
  }
}
