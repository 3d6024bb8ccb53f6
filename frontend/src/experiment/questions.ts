/** Questions before and after the trials. */

import { make } from "../page/elements";
import type { Pages } from "./pages";
import type { Question } from "./session";

/** Ask questions on one page; returns the answers by the names of the questions. Any may be left out. */
export async function askQuestions(pages: Pages, questions: readonly Question[]): Promise<Readonly<Record<string, string>>> {
  const fields = questions.map((question) => ({ question, field: fieldOf(pages, question) }));
  await pages.ask([pages.title(), ...fields.map(({ field }) => field)], [["continue", "continue"]]);
  return Object.fromEntries(fields.map(({ question, field }) => [question.name, valueOf(field)]));
}

function fieldOf(pages: Pages, { name, kind, options }: Question): HTMLElement {
  const text = pages.text(`question_${name}`);
  if (kind !== "choice") {
    const input = make("input", { type: kind === "number" ? "number" : "text", id: `question-${name}`, maxlength: 1000 });
    return make("div", { class: "question" }, make("label", { for: input.id }, text), input);
  }
  const choices = options.map((option) => {
    const id = `question-${name}-${option}`;
    const input = make("input", { type: "radio", name, id, value: option });
    return make("p", { class: "option" }, input, make("label", { for: id }, pages.text(`option_${option}`)));
  });
  return make("fieldset", {}, make("legend", {}, text), ...choices);
}

const valueOf = (field: HTMLElement): string =>
  field.querySelector<HTMLInputElement>("input:checked, input:not([type=radio])")?.value ?? "";
