/** Several walkers at once: means of two classes and both tripled, four at one tempo, a crowd. */

import { capitalised, endLabels } from "../model/axisLabels";
import { MAX_IN_CROWD, type SceneName } from "../model/state";
import { make } from "../page/elements";
import { choice, pick, type Option } from "./choice";
import { note } from "./section";
import type { Part, Store } from "./store";

export function sceneSelect(store: Store): Part {
  const { model } = store;
  const trait = model.traits.find(({ means }) => means !== null);
  const several = model.walkers.length > 1;
  const crowd = Math.min(model.walkers.length, MAX_IN_CROWD);
  const options: Option<SceneName>[] = [
    { value: "one", label: "One" },
    ...(trait ? [{ value: "four" as const, label: "Means" }] : []),
    ...(several ? [{ value: "side" as const, label: "Side by side" }, { value: "crowd" as const, label: "All" }] : []),
  ];
  const scene = choice("Scene", options, (value) => store.change({ scene: value }), { named: false });
  const about = note("");
  const texts: Record<SceneName, string> = {
    one: "One walker, changed by all the sliders.",
    four: trait ? `Mean ${endLabels(trait).join(" and mean ")}; then both with what sets them apart tripled. Sliders of traits change one walker: to move one leaves this.` : "",
    side: "Walkers of the population, brought to one tempo.",
    crowd: `${crowd} walkers of the population. Choose one to see it alone.`,
  };
  const names = model.walkers.map(({ name }, value) => ({ value, label: name }));
  const places = store.state.walkers.map((_, place) =>
    pick(`Place ${place + 1}`, names, (walker) => store.change({ walkers: store.state.walkers.with(place, walker) })),
  );
  const row = make("div", { class: "places" }, ...places.map(({ element }) => element));
  return {
    element: make("div", {}, scene.element, about, row),
    show({ state }) {
      scene.show(state.scene);
      about.textContent = capitalised(texts[state.scene]);
      row.hidden = state.scene !== "side";
      places.forEach((place, i) => place.show(state.walkers[i] ?? 0));
    },
  };
}
