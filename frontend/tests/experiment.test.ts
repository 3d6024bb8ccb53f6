// @vitest-environment jsdom
// What the page of an experiment does with answers: which trials are done, what is sent, what is set aside.

import { afterEach, expect, it, vi } from "vitest";

import { checksum, itemOf, randomName } from "../src/experiment/answers";
import { Outbox } from "../src/experiment/outbox";
import { TrialProgress } from "../src/experiment/progressOfTrials";
import { Sender } from "../src/experiment/sender";
import type { Block, Reported, Trial } from "../src/experiment/session";
import { nextLevel } from "../src/experiment/staircase";

const trial = (number: number, spare = false): Trial => ({
  trial: number,
  block: 1,
  task: "similar_pair",
  stimuli: [],
  walkers: [],
  practice: false,
  spare,
});
const block: Block = { task: "similar_pair", break_after: false };
const session = { trials: [trial(1), trial(2), trial(3, true), trial(4, true)], blocks: [block] };
const reported = (kind: string, number: number, attempt: number, outcome: string | null = null): Reported => ({
  kind,
  trial: number,
  attempt,
  outcome,
});

it("goes on at the first trial without an answer, and shows an interrupted one anew", () => {
  const progress = new TrialProgress(session, [
    reported("begun", 1, 1),
    reported("answer", 1, 1, "answered"),
    reported("begun", 2, 1),
    reported("begun", 2, 2),
  ]);
  expect(progress.next()?.trial).toBe(2);
  expect(progress.state(2).attempts).toBe(2);
});

it("replaces each timeout by a spare trial, once", () => {
  const timeout = reported("answer", 1, 1, "timeout");
  const progress = new TrialProgress(session, [timeout, timeout, reported("answer", 2, 1, "answered")]);
  expect(progress.todo().map((each) => each.trial)).toEqual([3]);
  progress.note(reported("answer", 3, 1, "answered"));
  expect(progress.next()).toBeNull();
});

it("computes the checksum that Python computes", () => {
  expect(checksum("a")).toBe("af63dc4c8601ec8c");
  expect(randomName()).toMatch(/^[A-Za-z0-9_-]{22}$/);
});

const answers = (...statuses: readonly (readonly [number, (names: string[]) => unknown])[]): string[][] => {
  const sent: string[][] = [];
  const waiting = [...statuses];
  vi.stubGlobal("fetch", (_: string, { body }: { body: string }) => {
    const names = (JSON.parse(body) as { items: { answer: string }[] }).items.map((item) => item.answer);
    sent.push(names);
    const [status, content] = waiting.shift() ?? [200, (all) => ({ confirmed: all, refused: [] })];
    return Promise.resolve(new Response(JSON.stringify(content(names)), { status }));
  });
  return sent;
};
afterEach(() => vi.unstubAllGlobals());

it("sets aside what is refused for good, and sends what is behind it", async () => {
  const outbox = await Outbox.open(); // in memory: there is no IndexedDB here
  expect(outbox.durable).toBe(false);
  const items = [1, 2, 3].map((number) => itemOf("answer", {}, number, 1));
  for (const item of items) await outbox.put(item, "key", 1);
  const bad = items[1]!.answer;
  const refuse = (names: string[]): unknown => ({ detail: names });
  const sent = answers(
    [422, refuse],
    [422, refuse],
    [200, (names) => ({ confirmed: names, refused: [] })],
    [422, refuse],
  );
  const sender = new Sender(outbox, "key", 1, () => {});
  await sender.drain();
  expect(sent.slice(0, 5).map((names) => names.length)).toEqual([3, 2, 1, 1, 1]);
  const left = outbox.items("key", 1);
  expect(left.map(({ item, refused }) => [item.answer, refused?.slice(0, 3)])).toEqual([[bad, "422"]]);
});

it("keeps an answer until that very answer is confirmed", async () => {
  const outbox = await Outbox.open();
  const [first, second] = [itemOf("answer", {}, 1, 1), itemOf("answer", {}, 2, 1)];
  await outbox.put(first, "key", 1);
  await outbox.put(second, "key", 1);
  answers([409, ([name]) => ({ confirmed: [], refused: [{ answer: name, outcome: "other content" }] })]);
  const sender = new Sender(outbox, "key", 1, () => {});
  await sender.drain();
  const left = outbox.items("key", 1);
  expect(left.map(({ item, refused }) => [item.answer, refused])).toEqual([[first.answer, "other content"]]);
});

it("takes the level of a staircase that Python takes", () => {
  const rule = { start: 1, nLevels: 5, down: 2 };
  expect(nextLevel([true, true, true, false], rule)).toBe(1);
  expect(nextLevel(Array<boolean>(40).fill(true), rule)).toBe(4);
  expect(nextLevel([false, false, false], rule)).toBe(0);
});
