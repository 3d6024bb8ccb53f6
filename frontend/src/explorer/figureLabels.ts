/** Who is who, where several walk: a name below each. */

import type { Cast } from "../model/figures";
import type { Box } from "../viewer/viewer";
import { make } from "../page/element";
import { many } from "./labels";

/** More names than these would be in each other's way. */
const MOST_NAMED = 4;

/** Write the names of a few walkers below where they stand. */
export function label(element: HTMLElement, cast: readonly Cast[], boxes: readonly Box[]): void {
  const few = cast.length > 1 && cast.length <= MOST_NAMED;
  const names = (few ? cast : []).flatMap(({ name }, i) => {
    const box = boxes[i];
    if (!box) return [];
    const tag = make("span", {}, inWords(name));
    tag.style.left = `${box.left + box.width / 2}px`;
    tag.style.top = `${box.top + box.height}px`;
    return [tag];
  });
  element.replaceChildren(...names);
}

/** "woman tripled" as "women × 3". */
function inWords(name: string): string {
  const [first = "", ...others] = name.split(" ");
  const people = many(first);
  if (people.endsWith(" walkers") || /^\d+$/.test(others[0] ?? "")) return name;
  return [people, ...others].join(" ").replace("tripled", "\u00d7 3");
}
