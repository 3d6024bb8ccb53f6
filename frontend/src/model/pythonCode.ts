/** The lines of Python that make the walker now made, to be copied. */

import { startOf, vectorOf } from "./mixing";
import type { Model, Own } from "./model";
import type { State } from "./state";
import { blockOf } from "./layout";
import { SLOWEST_HZ } from "./features";

/** A program whose `walker` is the one that is seen. */
export function pythonLine(model: Model, state: State, own: Own | null = null): string {
  const changes = [
    ...Object.entries(state.traits).flatMap(([name, steps]) => traitLines(model, state, name, steps)),
    ...biasLines(model, state),
    ...eigenwalkerLines(model, state),
    ...strengthLines(state),
    ...frequencyLines(model, state, own),
  ];
  const start = startLine(model, state, own);
  return [
    "import eigenwalker as ew",
    ...(start.includes("np.") ? ["import numpy as np"] : []),
    "",
    `people = ew.load_population(${model.source === "" ? "" : quoted(model.source)})${made(model)}`,
    start,
    ...changes,
    "walker = people.walker(vector)",
  ].join("\n");
}

/** How to get the file, where there is none yet. */
const made = ({ captures }: Model): string =>
  captures === undefined ? "" : `  # as eigenwalker fit makes it of ${captures.replace(/\s+/g, " ")}`;

/** As near as a millionth of a millimetre, as numbers of the page are. */
const near = (value: number): number => Number(value.toFixed(7));

function startLine(model: Model, state: State, own: Own | null): string {
  const known = typeof state.from === "number" ? model.walkers[state.from] : undefined;
  if (known) return `vector = people.X[${known.row}].copy()  # ${known.name.replace(/\s+/g, " ")}`;
  if (state.from === "own" && own) return `vector = np.array([${startOf(model, state, own).map(near).join(", ")}])`;
  return "vector = people.average.copy()";
}

function traitLines(model: Model, { kind, part }: State, name: string, steps: number): string[] {
  const trait = model.traits.find((each) => each.name === name);
  if (!trait || steps === 0 || !Object.hasOwn(trait.steps[kind], part)) return [];
  const options = [
    quoted(name),
    ...(part === "all" ? [] : [`part=${quoted(part)}`]),
    ...(kind === "discriminant" ? [] : [`kind=${quoted(kind)}`]),
  ];
  return [`vector += ${steps} * ew.trait_axis(people, ${options.join(", ")}).step`];
}

function biasLines({ traits }: Model, { bias }: State): string[] {
  const trait = traits.find(({ name }) => name === bias?.trait);
  if (!bias || bias.steps === 0 || !trait?.means) return [];
  const mean = (sign: string): string => `people.X[asked.rows[asked.y ${sign} 0]].mean(axis=0)`;
  return [
    `asked = ew.trait_axis(people, ${quoted(bias.trait)}).contrast`,
    `vector += ${bias.steps} * (${mean(">")} - ${mean("<")}) / 2`,
  ];
}

function eigenwalkerLines({ n_flagged }: Model, { eigenwalkers }: State): string[] {
  const moved = eigenwalkers.flatMap((steps, i) => (steps === 0 ? [] : [{ steps, i }]));
  if (moved.length === 0) return [];
  return [
    `space = ew.WalkerSpace().fit(people.X${n_flagged > 0 ? "[~people.flagged]" : ""})`,
    ...moved.map(
      ({ steps, i }) =>
        `vector += ${steps} * space.explained_variance_[${i}] ** 0.5 * space.eigenwalkers_[${i}]`,
    ),
  ];
}

const strengthLines = ({ strengths }: State): string[] =>
  strengths.flatMap((strength, i) =>
    strength === 1 ? [] : [`vector[people.layout.blocks["p${i + 1}"]] *= ${strength}`],
  );

/** A caricature may have got a frequency that nothing walks at. */
function frequencyLines(model: Model, state: State, own: Own | null): string[] {
  const found = vectorOf(model, state, own)[blockOf(model, "frequency")![0]]!;
  return found < SLOWEST_HZ ? [`vector[people.layout.blocks["frequency"]] = ${SLOWEST_HZ}`] : [];
}

/** JSON's texts are Python's. */
const quoted = (text: string): string => JSON.stringify(text);
