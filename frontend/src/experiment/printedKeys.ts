/** Keys by what is printed on them, also where a keyboard writes another letter, or a digit only with shift. */

const isForeignLetter = (key: string): boolean => /^\p{L}$/u.test(key) && !/^\p{Script=Latin}$/u.test(key);

/** The digit on a key of the upper row, or the Latin letter on one that writes another script. */
export function printedOn({ key, code }: Pick<KeyboardEvent, "key" | "code">): string | null {
  const digit = /^(?:Digit|Numpad)(\d)$/.exec(code)?.[1];
  if (digit !== undefined) return digit;
  return isForeignLetter(key) ? (/^Key([A-Z])$/.exec(code)?.[1]?.toLowerCase() ?? null) : null;
}

/**
 * Gives the keys of the whole page to the stage, to which alone jsPsych listens: those pressed, or let go of, while
 * something else has the focus, and those that are expected by what is printed on them. None that is part of a
 * command of the browser.
 */
export class StageKeys {
  private keys: readonly string[] = [];
  private readonly copies = new WeakSet<Event>();
  private readonly ending = new AbortController();

  constructor(private readonly stage: HTMLElement) {
    for (const type of ["keydown", "keyup"] as const) {
      window.addEventListener(type, (event) => this.give(event), { capture: true, signal: this.ending.signal });
    }
  }

  expect(keys: readonly string[]): void {
    this.keys = keys;
  }

  stop(): void {
    this.ending.abort();
  }

  private give(event: KeyboardEvent): void {
    const { type, code, repeat, timeStamp, target } = event;
    if (this.copies.has(event) || !(target instanceof Element)) return;
    if (type === "keydown" && (event.ctrlKey || event.metaKey || event.altKey)) return event.stopImmediatePropagation();
    if (type === "keydown" && target.closest("dialog")) return;
    const isKnown = this.keys.includes(event.key.toLowerCase());
    const printed = isKnown ? null : printedOn(event);
    const key = printed !== null && this.keys.includes(printed) ? printed : event.key;
    const isOnStage = this.stage.contains(target);
    if (isOnStage && key === event.key) return;
    if (isOnStage) event.stopImmediatePropagation();
    const copy = new KeyboardEvent(type, { key, code, repeat, bubbles: true, cancelable: true });
    Object.defineProperty(copy, "timeStamp", { value: timeStamp });
    this.copies.add(copy);
    (isOnStage ? target : this.stage).dispatchEvent(copy);
  }
}
