// Each room of the frontend imports only from the rooms below it, and no imports form a circle.

import { readdirSync, readFileSync } from "node:fs";
import { join, normalize } from "node:path";
import { expect, it } from "vitest";

const SOURCE = new URL("../src/", import.meta.url).pathname;
/** From the top; rooms on a line do not import one another. */
const LAYERS = [["experiment", "explorer", "player", "widget"], ["viewer"], ["mannequin"], ["model", "canvas", "page"], ["core"]];

const modules = readdirSync(SOURCE, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".ts"));
const importsOf = (name: string): string[] =>
  [...readFileSync(join(SOURCE, name), "utf8").matchAll(/ from "(\.[^"]+)"/g)]
    .map(([, path]) => `${normalize(join(name, "..", path!))}.ts`)
    .filter((target) => modules.includes(target));
const layerOf = (name: string): number => LAYERS.findIndex((rooms) => rooms.includes(name.split("/")[0]!));

it.each(modules)("%s imports only from below", (name) => {
  expect(layerOf(name)).toBeGreaterThanOrEqual(0);
  const others = importsOf(name).filter((target) => target.split("/")[0] !== name.split("/")[0]);
  expect(others.filter((target) => layerOf(target) <= layerOf(name))).toEqual([]);
});

it("there are no circles", () => {
  const done = new Set<string>();
  const visit = (name: string, path: readonly string[]): void => {
    expect(path).not.toContain(name);
    if (done.has(name)) return;
    for (const target of importsOf(name)) visit(target, [...path, name]);
    done.add(name);
  };
  for (const name of modules) visit(name, []);
});
