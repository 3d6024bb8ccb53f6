/**
 * Random numbers that Python and the browser draw alike: sfc32, reached at any place at once.
 *
 * Every place that draws has a stream of its own, named by four words: what it is for, the seed,
 * the number of the dot, the number of its life. `docs/stimulus-format.md` says it bit by bit.
 */

/** Words thrown away before the first is used. */
const WARM_UP = 20;

/** What a stream is for, so that two transforms with one seed draw different numbers. */
export const Purpose = {
  test: 1,
  scramble: 2,
  phaseScramble: 3,
  limbDots: 4,
  mask: 5,
} as const;

/** The first 32-bit words of a stream of sfc32 (Doty-Humphrey, PractRand). */
export function randomWords(
  purpose: number,
  seed: number,
  index: number,
  life: number,
  count: number,
): Uint32Array {
  let a = seed >>> 0;
  let b = index >>> 0;
  let c = life >>> 0;
  let counter = purpose >>> 0;
  const words = new Uint32Array(count);
  for (let turn = -WARM_UP; turn < count; turn++) {
    const word = (a + b + counter) >>> 0;
    counter = (counter + 1) >>> 0;
    a = b ^ (b >>> 9);
    b = (c + (c << 3)) >>> 0;
    c = (((c << 21) | (c >>> 11)) + word) >>> 0;
    if (turn >= 0) words[turn] = word;
  }
  return words;
}

/** Numbers from 0 to below 1, of 53 bits, each from two words of a stream. */
export function uniforms(
  purpose: number,
  seed: number,
  index: number,
  life: number,
  count: number,
): Float64Array {
  const words = randomWords(purpose, seed, index, life, 2 * count);
  return Float64Array.from(
    { length: count },
    (_, i) => ((words[2 * i]! >>> 5) * 2 ** 26 + (words[2 * i + 1]! >>> 6)) / 2 ** 53,
  );
}

/** Normally distributed numbers, by Box and Muller (1958), two from two uniform ones. */
export function normals(
  purpose: number,
  seed: number,
  index: number,
  life: number,
  count: number,
): Float64Array {
  const drawn = uniforms(purpose, seed, index, life, 2 * Math.ceil(count / 2));
  return Float64Array.from({ length: count }, (_, i) => {
    const pair = i - (i % 2);
    const radius = Math.sqrt(-2 * Math.log(1 - drawn[pair]!));
    const angle = 2 * Math.PI * drawn[pair + 1]!;
    return radius * (i % 2 === 0 ? Math.cos(angle) : Math.sin(angle));
  });
}

/** 0, 1, ... size - 1 in random order (Fisher and Yates, from the end). */
export function permutation(purpose: number, seed: number, index: number, size: number): number[] {
  const order = Array.from({ length: size }, (_, i) => i);
  const drawn = uniforms(purpose, seed, index, 0, Math.max(size - 1, 1));
  for (let last = size - 1; last > 0; last--) {
    const other = Math.floor(drawn[size - 1 - last]! * (last + 1));
    [order[last], order[other]] = [order[other]!, order[last]!];
  }
  return order;
}
