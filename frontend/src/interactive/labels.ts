/** Who is who, where several walk: a name below each. */

import { stagingOf } from "../stage/staging";
import { roomFor } from "../stage/stimulus";
import { make } from "./element";
import type { Now } from "./session";
import { many } from "./words";

/** More names than these would be in each other's way. */
const MOST_NAMED = 4;

/** Write the names of those on a stage of some size into an element that lies over it. */
export function label(element: HTMLElement, { model, cast, state }: Now, width: number, height: number): void {
  if (cast.length < 2 || cast.length > MOST_NAMED || width === 0 || height === 0) {
    element.replaceChildren();
    return;
  }
  const room = roomFor(model, cast);
  const { columns, rows } = stagingOf(cast.length, room, { width_px: width, height_px: height }, state.elevation_deg);
  const names = cast.map(({ name }, i) => {
    const row = Math.floor(i / columns);
    const inRow = Math.min(columns, cast.length - row * columns);
    const name_ = make("span", {}, inWords(name));
    name_.style.left = `${50 + (100 * ((i % columns) - (inRow - 1) / 2)) / columns}%`;
    name_.style.top = `${(100 * (row + 1)) / rows}%`;
    return name_;
  });
  element.replaceChildren(...names);
}

/** "female tripled" as "women, tripled". */
function inWords(name: string): string {
  const [first = "", ...others] = name.split(" ");
  const class_ = many(first);
  if (class_.endsWith(" walkers")) return name;
  return [class_, ...others].join(", ").replace(/, (\d+)$/, " $1");
}
