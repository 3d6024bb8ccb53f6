/** An adaptive staircase, as Python computes it: the place of the next level, 0 the easiest. */

export interface Staircase {
  readonly start: number;
  readonly nLevels: number;
  /** Right answers in a row after which it becomes harder. */
  readonly down: number;
}

export function nextLevel(correct: readonly boolean[], { start, nLevels, down }: Staircase): number {
  let level = start;
  let inARow = 0;
  for (const right of correct) {
    inARow = right ? inARow + 1 : 0;
    if (!right) level = Math.max(level - 1, 0);
    else if (inARow === down) {
      level = Math.min(level + 1, nLevels - 1);
      inARow = 0;
    }
  }
  return level;
}
