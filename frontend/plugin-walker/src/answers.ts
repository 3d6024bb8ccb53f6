/** Answers by keys and buttons, with their times. */

import type { JsPsych } from "jspsych";

export interface Answer {
  readonly response: string | number;
  readonly by: "key" | "button";
  /** On the clock of `performance.now()`. */
  readonly timeMs: number;
}

type Keys = readonly string[] | "ALL_KEYS" | "NO_KEYS";

/** The time of an event; now, if its timestamp is of another clock. */
function timeOf(event: Event): number {
  const now = performance.now();
  return event.timeStamp > 0 && event.timeStamp <= now ? event.timeStamp : now;
}

/** Report each answer until the returned function is called. */
export function listen(
  jsPsych: JsPsych,
  keys: Keys,
  buttons: readonly HTMLButtonElement[],
  onAnswer: (answer: Answer) => void,
): () => void {
  let pressedMs = 0;
  // jsPsych reports which keys count, but not the time of the event, so it is noted before.
  const note = (event: KeyboardEvent): void => {
    pressedMs = timeOf(event);
  };
  document.addEventListener("keydown", note, { capture: true });
  const listener =
    keys === "NO_KEYS"
      ? undefined
      : jsPsych.pluginAPI.getKeyboardResponse({
          valid_responses: keys === "ALL_KEYS" ? keys : [...keys],
          persist: true,
          allow_held_key: false,
          callback_function: ({ key }: { key: string }) => onAnswer({ response: key, by: "key", timeMs: pressedMs }),
        });
  buttons.forEach((button, number) => {
    button.disabled = false;
    button.onclick = (event) => onAnswer({ response: number, by: "button", timeMs: timeOf(event) });
  });
  return () => {
    document.removeEventListener("keydown", note, { capture: true });
    if (listener) jsPsych.pluginAPI.cancelKeyboardResponse(listener);
    for (const button of buttons) button.disabled = true;
  };
}
