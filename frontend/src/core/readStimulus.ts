/** Stimulus files checked against their published schema, with defaults filled in. */

import schema from "../../../src/eigenwalker/stimulus/schema.json";
import { checked, explained, InvalidFile, type Schema } from "./schema";
import type { Figure, Step, Stimulus, Walker } from "./stimulus";
import { addsFigure } from "./scene";

const SCHEMA = schema as Schema<Stimulus>;

/** Limit of the dots that are computed for one moment, as in Python's `stimulus/schema.py`. */
export const MAX_WORK = 1_000_000;

/**
 * The stimulus in the parsed content of a file.
 *
 * Throws `InvalidFile` with the first problem.
 */
export const readStimulus = (content: unknown): Stimulus =>
  explained("This is no stimulus", () => {
    const stimulus = checked(content, SCHEMA, "stimulus");
    stimulus.figures.forEach((figure, number) => checkFigure(figure, `figures[${number}]`));
    checkChain(stimulus);
    return stimulus;
  });

const STEP = { ...SCHEMA.properties!["transforms"]!.items, $defs: SCHEMA.$defs } as Schema<Step>;

/** A step with the defaults of its schema. */
export const completeStep = (step: object): Step => checked(step, STEP, "transform");

function ensure(holds: boolean, message: string): void {
  if (!holds) throw new InvalidFile(message);
}

const dotsOf = ({ walker, trajectories }: Figure): readonly string[] => (walker ?? trajectories)!.markers;

function checkFigure(figure: Figure, where: string): void {
  const { walker, trajectories, segments, pairs } = figure;
  ensure((walker === null) !== (trajectories === null), `${where}: expected either walker or trajectories.`);
  if (walker) checkWalker(walker, `${where}.walker`);
  const markers = dotsOf(figure);
  for (const name of [...segments, ...pairs].flat()) {
    ensure(markers.includes(name), `${where}: there is no dot "${name}".`);
  }
  for (const { length } of trajectories?.samples ?? []) {
    ensure(length === markers.length, `${where}: ${markers.length} dots, but a frame of ${length}.`);
  }
}

function checkWalker({ markers, p0, p, harmonics, phases }: Walker, where: string): void {
  const fits = [p0, ...p].every(({ length }) => length === markers.length);
  ensure(fits, `${where}: ${markers.length} dots, but postures of another number.`);
  const alike = p.length === harmonics.length && p.length === phases.length;
  ensure(alike, `${where}: postures, harmonics and phases differ in number.`);
}

/** Follow the dots through the chain: transforms must name figures and dots that exist. */
function checkChain({ figures, transforms }: Stimulus): void {
  const dots = figures.map(dotsOf);
  const joined = figures.map(({ segments }) => segments.length > 0);
  const evaluations = figures.map(() => 1);
  let work = 0;
  transforms.forEach((step, number) => {
    const where = `transforms[${number}] (${step.name})`;
    ensure(!addsFigure(step) || (step.figures ?? figures).length <= 1, `${where}: name one figure, as in figures: [0].`);
    for (const figure of step.figures ?? figures.keys()) {
      const known = dots[figure];
      if (!known) throw new InvalidFile(`${where}: there is no figure ${figure}.`);
      const missing = requiredDots(step).find((name) => !known.includes(name));
      ensure(missing === undefined, `${where}: there is no dot "${missing}".`);
      if (step.name === "morph") {
        checkWalker(step.walker, `${where}.walker`);
        const fits = known.every((name) => step.walker.markers.includes(name)) && step.end_s > step.start_s;
        ensure(fits, `${where}: the other walker lacks dots, or it ends before it starts.`);
      } else if (step.name === "limb_dots") {
        const fits = step.places !== "limbs" || joined[figure]!;
        ensure(fits, `${where}: the figure has no segments to put dots on; use joints.`);
        dots[figure] = Array.from({ length: step.number }, (_, dot) => `dot_${dot + 1}`);
        joined[figure] = false;
      } else if (step.name === "blur") {
        ensure((step.sd_mm === null) !== (step.sd_px === null), `${where}: expected either sd_mm or sd_px.`);
      } else if (step.name === "mask") {
        work += step.number + (step.phases ? step.number : 1) * evaluations[figure]! * known.length;
      }
      evaluations[figure] = moreEvaluations(step, evaluations[figure]!, known.length);
    }
  });
  work += dots.reduce((sum, { length }, figure) => sum + evaluations[figure]! * length, 0);
  ensure(
    work <= MAX_WORK,
    `its chain computes ${work} dots for one moment, and no more than ${MAX_WORK} are ` +
      "shown in time; use fewer dots or fewer transforms that give each dot a clock.",
  );
}

/** How often a figure is computed for one moment, after one more transform. */
function moreEvaluations({ name }: Step, before: number, nDots: number): number {
  if (name === "phase_scramble") return before * nDots;
  if (name === "delay" || name === "morph") return before * 2;
  return name === "limb_dots" ? before + 1 : before;
}

/** Dots that a transform needs. */
function requiredDots(step: Step): readonly string[] {
  if (step.name === "conflict" || step.name === "ellipses") {
    return ["left_shoulder", "right_shoulder", "left_hip", "right_hip"];
  }
  return "markers" in step ? step.markers : [];
}
