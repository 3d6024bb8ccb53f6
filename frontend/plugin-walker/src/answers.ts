/** Keys and buttons, with the moment at which the browser noticed them. */

import type { JsPsych } from "jspsych";

export interface Answer {
  readonly response: string | number;
  readonly by: "key" | "button";
  /** On the clock of `performance.now()`. */
  readonly timeMs: number;
}

type Keys = readonly string[] | "ALL_KEYS" | "NO_KEYS";

/** When an event came; where its stamp is of another clock, it is now. */
function momentOf(event: Event): number {
  const now = performance.now();
  return event.timeStamp > 0 && event.timeStamp <= now ? event.timeStamp : now;
}

/** Hand over each answer until the returned function is called. */
export function listen(
  jsPsych: JsPsych,
  keys: Keys,
  buttons: readonly HTMLButtonElement[],
  answered: (answer: Answer) => void,
): () => void {
  let pressedMs = 0;
  // jsPsych says which keys count, but not when the event came; so its moment is kept before.
  const note = (event: KeyboardEvent): void => {
    pressedMs = momentOf(event);
  };
  document.addEventListener("keydown", note, { capture: true });
  const listener =
    keys === "NO_KEYS"
      ? undefined
      : jsPsych.pluginAPI.getKeyboardResponse({
          valid_responses: keys === "ALL_KEYS" ? keys : [...keys],
          persist: true,
          allow_held_key: false,
          callback_function: ({ key }: { key: string }) => answered({ response: key, by: "key", timeMs: pressedMs }),
        });
  buttons.forEach((button, number) => {
    button.disabled = false;
    button.onclick = (event) => answered({ response: number, by: "button", timeMs: momentOf(event) });
  });
  return () => {
    document.removeEventListener("keydown", note, { capture: true });
    if (listener) jsPsych.pluginAPI.cancelKeyboardResponse(listener);
    for (const button of buttons) button.disabled = true;
  };
}
