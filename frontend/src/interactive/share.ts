/** Keep and share: the address, files of what is shown, and the Python that makes this walker. */

import { pythonLine } from "../model/python";
import { button } from "./choice";
import { make } from "./element";
import type { Notices } from "./notices";
import type { Part, Session } from "./session";

export function share(session: Session, notices: Notices): Part {
  const python = make("pre", { class: "line", tabindex: 0, "aria-label": "Python that makes this walker" });
  const copy = async (text: string, what: string): Promise<void> => {
    try {
      await navigator.clipboard.writeText(text);
      notices.news(`${what} copied.`);
    } catch {
      notices.trouble(`This browser lets no page copy. ${what}: ${text}`);
    }
  };
  return {
    element: make("div", {},
      make("div", { class: "row" },
        button("Copy link", () => void copy(location.href, "Link")),
      ),
      python,
      make("div", { class: "row" }, button("Copy Python", () => void copy(python.textContent ?? "", "Python"))),
    ),
    show: ({ model, state }) => void (python.textContent = pythonLine(model, state)),
  };
}
