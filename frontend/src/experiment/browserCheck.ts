/** What this page needs of a browser. */

const works = (test: () => unknown): boolean => {
  try {
    return Boolean(test());
  } catch {
    return false;
  }
};

/** What the browser lacks, in words of programmers: for the lab, and for whoever looks up a newer browser. */
export function missingInBrowser(): string[] {
  const needed: Readonly<Record<string, () => unknown>> = {
    canvas: () => document.createElement("canvas").getContext("2d"),
    crypto: () => crypto.getRandomValues(new Uint8Array(1)),
    "AbortSignal.timeout": () => AbortSignal.timeout,
    "Array.toSorted": () => [1].toSorted(),
    dialog: () => HTMLDialogElement.prototype.showModal,
  };
  const forMannequins = document.querySelector("script#mannequin") !== null;
  const all = forMannequins ? { ...needed, WebGL: () => document.createElement("canvas").getContext("webgl2") } : needed;
  return Object.entries(all)
    .filter(([, test]) => !works(test))
    .map(([name]) => name);
}
