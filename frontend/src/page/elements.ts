/** Elements of a page, built from their parts; all text is text, never HTML. */

type Value = string | number | boolean | undefined;
type Attributes = Readonly<Record<string, Value>>;
type Content = Node | string;

/** An HTML element with its attributes; `false` and `undefined` leave an attribute out. */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...content: readonly Content[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  setAttributes(element, attributes);
  element.append(...content);
  return element;
}

export function draw<Tag extends keyof SVGElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...content: readonly Content[]
): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  setAttributes(element, attributes);
  element.append(...content);
  return element;
}

/** Set attributes; `true` gives an empty one. */
export function setAttributes(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) element.removeAttribute(name);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
}

export function find<Kind extends Element>(selector: string, kind: new () => Kind): Kind {
  const element = document.querySelector(selector);
  if (!(element instanceof kind)) throw new Error(`The page lacks ${selector}.`);
  return element;
}

export function button(content: Content, onClick: () => unknown, attributes: Attributes = {}): HTMLButtonElement {
  const element = make("button", { type: "button", ...attributes }, content);
  element.addEventListener("click", onClick);
  return element;
}

let count = 0;

/** An id that no other element has. */
export const freshId = (): string => `part-${++count}`;

/** A number with its sign, as print has it. */
export function signed(value: number, digits = 1): string {
  const size = Math.abs(value).toFixed(digits);
  if (Number(size) === 0) return "0";
  return (value < 0 ? "\u2212" : "+") + size;
}

export const messageOf = (error: unknown): string =>
  error instanceof Error && error.message ? error.message : String(error);

const ICONS = {
  play: "M7 4.5v15l12.5-7.5z",
  pause: "M7 5h3.5v14H7zM13.5 5H17v14h-3.5z",
  back: "M9 7H5V3M5.5 7a8 8 0 1 1-1 7",
  undo: "M8.5 5 4 9.5 8.5 14M4.5 9.5H14a5 5 0 0 1 0 10h-3",
  sun: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8M12 2v2M12 20v2M2 12h2M20 12h2M5 5l1.4 1.4M17.6 17.6 19 19M5 19l1.4-1.4M17.6 6.4 19 5",
  moon: "M20 14.5A8.5 8.5 0 0 1 9.5 4a8.5 8.5 0 1 0 10.5 10.5z",
  open: "M12 15V4M7.5 8.5 12 4l4.5 4.5M4 15v5h16v-5",
  whole: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  close: "M6 6l12 12M18 6 6 18",
} as const;

export type Icon = keyof typeof ICONS;

/** A small drawing, which screen readers ignore. */
export function icon(name: Icon): SVGSVGElement {
  const solid = name === "play" || name === "pause";
  return draw(
    "svg",
    { viewBox: "0 0 24 24", class: solid ? "icon solid" : "icon", "aria-hidden": "true" },
    draw("path", { d: ICONS[name] }),
  );
}
