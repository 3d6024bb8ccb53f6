/** Python code that makes the present walker, to be copied. */

import { blockOf, MIN_FREQUENCY_HZ } from "./features";
import { mixedVector, startVector, traitOf } from "./mixing";
import type { Model, OwnWalker } from "./model";
import type { State } from "./state";

/** A program whose variable `walker` is the present walker. */
export function pythonCode(model: Model, state: State, own: OwnWalker | null = null): string {
  const start = startLine(model, state, own);
  return [
    "import eigenwalker as ew",
    ...(start.includes("np.") ? ["import numpy as np"] : []),
    "",
    `people = ew.load_population(${model.source === "" ? "" : quoted(model.source)})${size(model)}${sourceComment(model)}`,
    start,
    ...Object.entries(state.traits).flatMap(([name, steps]) => traitLines(model, state, name, steps)),
    ...biasLines(model, state),
    ...eigenwalkerLines(model, state),
    ...strengthLines(state),
    ...frequencyLines(model, state, own),
    "walker = people.walker(vector)",
  ].join("\n");
}

const size = ({ size_kept }: Model): string => (size_kept ? "" : ".size_normalised()");

/** How to make the file of the population, if it does not exist yet. */
const sourceComment = ({ captures }: Model): string =>
  captures === undefined ? "" : `  # as eigenwalker fit makes it of ${oneLine(captures)}`;

const oneLine = (text: string): string => text.replace(/\s+/g, " ");

/** A number with the precision of the page: a millionth of a millimetre. */
const rounded = (value: number): number => Number(value.toFixed(7));

function startLine(model: Model, state: State, own: OwnWalker | null): string {
  const known = typeof state.from === "number" ? model.walkers[state.from] : undefined;
  if (known) return `vector = people.X[${known.row}].copy()  # ${oneLine(known.name)}`;
  if (state.from !== "own" || !own) return "vector = people.average.copy()";
  return `vector = np.array([${startVector(model, state, own).map(rounded).join(", ")}])`;
}

function traitLines(model: Model, { kind, part }: State, name: string, steps: number): string[] {
  const trait = traitOf(model, name);
  if (!trait || steps === 0 || !Object.hasOwn(trait.steps[kind], part)) return [];
  const options = [
    quoted(name),
    ...(part === "all" ? [] : [`part=${quoted(part)}`]),
    ...(kind === "discriminant" ? [] : [`kind=${quoted(kind)}`]),
  ];
  return [`vector += ${steps} * ew.trait_axis(people, ${options.join(", ")}).step`];
}

function biasLines(model: Model, { bias }: State): string[] {
  if (!bias || bias.steps === 0 || !traitOf(model, bias.trait)?.means) return [];
  const mean = (sign: string): string => `people.X[contrast.rows[contrast.y ${sign} 0]].mean(axis=0)`;
  return [
    `contrast = ew.trait_axis(people, ${quoted(bias.trait)}).contrast`,
    `vector += ${bias.steps} * (${mean(">")} - ${mean("<")}) / 2`,
  ];
}

function eigenwalkerLines({ n_flagged }: Model, { eigenwalkers }: State): string[] {
  const lines = eigenwalkers.flatMap((steps, i) =>
    steps === 0 ? [] : [`vector += ${steps} * space.explained_variance_[${i}] ** 0.5 * space.eigenwalkers_[${i}]`],
  );
  const rows = n_flagged > 0 ? "[~people.flagged]" : "";
  return lines.length > 0 ? [`space = ew.WalkerSpace().fit(people.X${rows})`, ...lines] : [];
}

const strengthLines = ({ strengths }: State): string[] =>
  strengths.flatMap((strength, i) =>
    strength === 1 ? [] : [`vector[people.layout.blocks["p${i + 1}"]] *= ${strength}`],
  );

/** The lower limit of the frequency, where a caricature is below it. */
function frequencyLines(model: Model, state: State, own: OwnWalker | null): string[] {
  const frequencyHz = mixedVector(model, state, own)[blockOf(model, "frequency")![0]]!;
  return frequencyHz < MIN_FREQUENCY_HZ ? [`vector[people.layout.blocks["frequency"]] = ${MIN_FREQUENCY_HZ}`] : [];
}

/** JSON text is valid Python text. */
const quoted = (text: string): string => JSON.stringify(text);
