/** Keys by what is printed on them, also where a keyboard writes another letter, or a digit only with shift. */

const isForeignLetter = (key: string): boolean => /^\p{L}$/u.test(key) && !/^\p{Script=Latin}$/u.test(key);

/** The digit on a key of the upper row, or the Latin letter on one that writes another script. */
export function printedOn({ key, code }: Pick<KeyboardEvent, "key" | "code">): string | null {
  const digit = /^(?:Digit|Numpad)(\d)$/.exec(code)?.[1];
  if (digit !== undefined) return digit;
  return isForeignLetter(key) ? (/^Key([A-Z])$/.exec(code)?.[1]?.toLowerCase() ?? null) : null;
}

/** Have such keys count as those that are expected, and none that is part of a command of the browser, until called. */
export function expectKeys(keys: readonly string[]): () => void {
  const ending = new AbortController();
  const onKey = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return event.stopImmediatePropagation();
    if (keys.includes(event.key.toLowerCase())) return;
    const printed = printedOn(event);
    if (printed === null || !keys.includes(printed)) return;
    event.stopImmediatePropagation();
    const { type, code, repeat, timeStamp } = event;
    const same = new KeyboardEvent(type, { key: printed, code, repeat, bubbles: true, cancelable: true });
    Object.defineProperty(same, "timeStamp", { value: timeStamp });
    event.target?.dispatchEvent(same);
  };
  for (const type of ["keydown", "keyup"] as const) {
    window.addEventListener(type, onKey, { capture: true, signal: ending.signal });
  }
  return () => ending.abort();
}
