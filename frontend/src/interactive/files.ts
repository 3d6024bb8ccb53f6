/** Where files come in: dropped anywhere on the page, or chosen. */

import { find } from "./element";

/** Hand over files that are dropped or chosen; the returned function opens the choosing. */
export function takeFiles(take: (files: readonly File[]) => void): () => void {
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
    take([...(event.dataTransfer?.files ?? [])]);
  });
  input.addEventListener("change", () => {
    take([...(input.files ?? [])]);
    input.value = "";
  });
  return () => input.click();
}
