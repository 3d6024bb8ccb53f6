/**
 * Random numbers that are the same in Python and in the browser: streams of sfc32.
 *
 * Each stream has a key of four 32-bit words: its purpose, the seed, the number of the dot, and the
 * number of the dot's life. `docs/stimulus-format.md` specifies the streams bit by bit.
 */

/** Words that are discarded at the start of a stream. */
const WARM_UP = 20;

/** The purpose of a stream, so that two transforms with one seed draw different numbers. */
export const Purpose = {
  test: 1,
  scramble: 2,
  phaseScramble: 3,
  limbDots: 4,
  mask: 5,
} as const;

/** Purpose, seed, number of the dot, number of its life. */
type Key = readonly [purpose: number, seed: number, index: number, life: number];

/** The first 32-bit words of a stream of sfc32 (Doty-Humphrey, PractRand). */
export function randomWords([purpose, seed, index, life]: Key, count: number): Uint32Array {
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

/** Uniform numbers from 0 to below 1, of 53 bits, each from two words of a stream. */
export function uniforms(key: Key, count: number): Float64Array {
  const words = randomWords(key, 2 * count);
  return Float64Array.from(
    { length: count },
    (_, i) => ((words[2 * i]! >>> 5) * 2 ** 26 + (words[2 * i + 1]! >>> 6)) / 2 ** 53,
  );
}

/** 0, 1, ... size - 1 in random order (Fisher-Yates, from the end). */
export function permutation(purpose: number, seed: number, index: number, size: number): number[] {
  const order = Array.from({ length: size }, (_, i) => i);
  const u = uniforms([purpose, seed, index, 0], Math.max(size - 1, 1));
  for (let last = size - 1; last > 0; last--) {
    const other = Math.floor(u[size - 1 - last]! * (last + 1));
    [order[last], order[other]] = [order[other]!, order[last]!];
  }
  return order;
}
