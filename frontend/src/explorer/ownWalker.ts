/** The walker of a stimulus file as a feature vector of the model. */

import type { Stimulus, Walker } from "../core/stimulus";
import { blockOf } from "../model/features";
import type { Model, OwnWalker } from "../model/model";

/** The first walker of a stimulus, with the model's markers, origin of time and signs of postures. */
export function ownWalkerOf(model: Model, { figures }: Stimulus, name: string): OwnWalker {
  const walker = figures.find((figure) => figure.walker)?.walker;
  if (!walker) throw new Error(`${name} holds no walker, only trajectories.`);
  const sorted = withMarkers(model, walker, name);
  const signed = withSigns(model, withOrigin(sorted));
  return { name: name.replace(/\.json$/i, ""), vector: vectorOf(model, signed, name) };
}

function withMarkers({ markers, harmonics }: Model, walker: Walker, name: string): Walker {
  const order = markers.map((marker) => walker.markers.indexOf(marker));
  const missing = markers.find((_, i) => order[i]! < 0);
  if (missing !== undefined) throw new Error(`${name}: its walker lacks ${missing}, which all walkers here have.`);
  if (walker.harmonics.join() !== harmonics.join()) {
    const [its, here] = [walker.harmonics, harmonics].map((each) => each.join(", "));
    throw new Error(`${name}: its postures ride on the harmonics ${its}; here they are ${here}.`);
  }
  const sort = <T>(posture: readonly T[]): T[] => order.map((i) => posture[i]!);
  return { ...walker, markers, p0: sort(walker.p0), p: walker.p.map(sort) };
}

/** The walker with a first phase of 0. */
function withOrigin(walker: Walker): Walker {
  const { harmonics, phases } = walker;
  const [first, base] = [phases[0] ?? 0, harmonics[0] ?? 1];
  return { ...walker, phases: phases.map((phase, i) => phase - (harmonics[i]! / base) * first) };
}

/** Each posture with the sign of the average walker's; another sign is half a cycle of its phase. */
function withSigns(model: Model, walker: Walker): Walker {
  const flipped = walker.p.map((posture, i) => {
    const [start] = blockOf(model, `p${i + 1}`) ?? [0];
    return posture.flat().reduce((sum, value, j) => sum + value * model.average[start + j]!, 0) < 0;
  });
  // The first phase is 0 by the choice of the origin: flipping its posture shifts all by half a cycle.
  const later = flipped[0] ? Math.PI / walker.harmonics[0]! : 0;
  const phases = walker.phases.map((phase, i) => phase + walker.harmonics[i]! * later + (flipped[i] ? Math.PI : 0));
  const p = walker.p.map((posture, i) =>
    flipped[i] ? posture.map(([x, y, z]) => [-x, -y, -z] as const) : posture,
  );
  return { ...walker, p, phases };
}

function vectorOf(model: Model, walker: Walker, name: string): number[] {
  const vector = [...model.average];
  const put = (block: string, values: readonly number[]): void => {
    const [start] = blockOf(model, block) ?? [0];
    values.forEach((value, i) => (vector[start + i] = value));
  };
  put("p0", walker.p0.flat());
  walker.p.forEach((posture, i) => put(`p${i + 1}`, posture.flat()));
  put("frequency", [walker.frequency_hz]);
  walker.phases.forEach((phase, i) => {
    const fixed = model.fixed_phases[i] ?? null;
    if (fixed !== null && Math.abs(Math.sin((phase - fixed) / 2)) > 1e-6) {
      throw new Error(`${name}: phase ${i + 1} of its walker is free; here it is fixed.`);
    }
  });
  const [start, stop] = blockOf(model, "phases") ?? [0, 0];
  const free = walker.phases.slice(1, 1 + stop - start);
  put("phases", free.map((phase, i) => nearTo(model.average[start + i]!, phase)));
  return vector;
}

/** The same angle, within half a turn of another. */
const nearTo = (other: number, angle: number): number =>
  angle - 2 * Math.PI * Math.round((angle - other) / (2 * Math.PI));
